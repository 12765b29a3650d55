#include "commands/commands.h"
#include "commands/model_options.h"
#include "files/input.h"
#include "reports/json.h"
#include "reports/messages.h"

#include <bendy/converter/source_format.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>

#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace bendy::tools {
namespace {

struct ValidateArguments {
    std::vector<std::filesystem::path> files;
    std::filesystem::path root;
    bool json = false;
};

/// Returns why a file is not a bendy file at all: it cannot be opened, or it is known to be something else. Empty
/// otherwise; the file's faults then say the rest.
std::string why_no_file(const std::filesystem::path& file, const Result<InputBytes>& mapped) {
    return mapped ? why_not_bendy(file, mapped->bytes()) : why_not_opened(file, mapped.error());
}

/// A LINK to an image file that does not exist.
struct DanglingLink {
    std::uint64_t offset = 0;  ///< of the chunk
    std::string uri;
};

using Links = std::vector<DanglingLink>;

/// Finds a file's dangling links, which are relative to its folder. Data URIs and other schemes are ignored. Empty if
/// the bytes cannot be read.
Links find_dangling_links(const std::filesystem::path& file, Bytes bytes) {
    Result<ChunkTree> tree = read_chunk_tree(bytes);
    if (!tree) return {};
    decode_leaves(*tree);
    Faults ignored;
    const Document document = read_document(*tree, ignored);
    const ReadableFolders folders = folders_of(file, {});
    Links dangling;
    for (const TextureView& texture : document.textures) {
        for (const ImageView& image : texture.images) {
            if (image.uri.empty()) continue;
            const auto linked = folders.find(image.uri);  // whether a file outside the folders exists is not revealed
            std::error_code problem;
            if (linked && !std::filesystem::exists(*linked, problem))
                dangling.push_back({(*tree)[image.chunk].offset, std::string(image.uri)});
        }
    }
    return dangling;
}

std::string text_of(const DanglingLink& link) {
    return "linked image does not exist: " + link.uri;
}

/// The result for one file.
struct Verdict {
    bool is_valid = false;
    Json json;
};

Verdict validate_bendy(const std::filesystem::path& file, const Result<InputBytes>& mapped, bool is_json) {
    Faults faults;
    Bytes bytes;
    Links links;
    if (mapped) {
        bytes = mapped->bytes();
        faults = validate(bytes);
        if (faults.empty()) links = find_dangling_links(file, bytes);
    } else {
        faults.add(mapped.error());
    }
    const std::string why = why_no_file(file, mapped);
    Verdict verdict{faults.empty(), {{"file", file.string()}, {"valid", faults.empty()}}};
    if (!is_json && !why.empty()) {
        std::cerr << error_label() << shown_name(file) << ": " << printable(why) << '\n';
    } else if (!is_json) {
        print_fault_lines(std::cout, file, faults, bytes);
        for (const DanglingLink& link : links)
            warn(file, printable(chunk_path(bytes, link.offset) + ": " + text_of(link)));
    }
    if (!is_json) return verdict;
    Json list = Json::array();
    for (const Error& fault : faults.list()) {
        list.push_back({{"code", code_name(fault.code)},
                        {"class", class_name(error_class(fault.code))},
                        {"path", whole_chunk_path(bytes, fault.offset)},
                        {"offset", fault.offset},
                        {"message", why.empty() ? describe(fault) : why}});
    }
    Json warnings = Json::array();
    for (const DanglingLink& link : links) {
        warnings.push_back(
            {{"path", whole_chunk_path(bytes, link.offset)}, {"offset", link.offset}, {"message", text_of(link)}});
    }
    verdict.json["faults"] = std::move(list);
    verdict.json["faultsLeftOut"] = faults.left_out();
    verdict.json["warnings"] = std::move(warnings);
    return verdict;
}

/// Validates a file that `convert` reads: reports what its importer finds, with the place in the source.
Verdict validate_source(const std::filesystem::path& file, InputBytes mapped, const std::filesystem::path& root,
                        bool is_json) {
    converter::Report report;
    const auto character = read_character(file, std::move(mapped), root, report);
    const bool is_valid = character.has_value();
    Verdict verdict{is_valid, {{"file", file.string()}, {"valid", is_valid}}};
    if (!is_json) {
        print_warnings(file, report);
        if (!is_valid)
            std::cout << shown_name(file_of(character.error(), file)) << ": " << describe(character.error()) << '\n';
        return verdict;
    }
    Json faults = Json::array();
    if (!is_valid) {
        const converter::ImportError& error = character.error();
        faults.push_back({{"code", "CONVERSION"}, {"path", error.place}, {"message", error.message}});
        if (!error.file.empty()) faults.back()["file"] = error.file.string();
    }
    Json warnings = Json::array();
    for (const converter::Warning& warning : report.warnings())
        warnings.push_back({{"path", warning.first_place}, {"message", warning.message}, {"count", warning.count}});
    verdict.json["faults"] = std::move(faults);
    verdict.json["faultsLeftOut"] = 0;
    verdict.json["warnings"] = std::move(warnings);
    return verdict;
}

void run(const ValidateArguments& arguments) {
    bool all_good = true;
    Json reports = Json::array();
    for (const std::filesystem::path& file : arguments.files) {
        Result<InputBytes> mapped = InputBytes::open(file);
        // A file named .bendy is validated as a bendy file, whatever it contains.
        const bool is_source = mapped && file.extension() != ".bendy" &&
                               converter::is_converted(mapped->bytes(), file) &&
                               (mapped->bytes().empty() ||  // which the conversion says
                                converter::why_not_convertible(mapped->bytes(), file).empty());
        const Verdict verdict = is_source ? validate_source(file, std::move(*mapped), arguments.root, arguments.json)
                                          : validate_bendy(file, mapped, arguments.json);
        all_good = all_good && verdict.is_valid;
        if (arguments.json) reports.push_back(verdict.json);
    }
    if (arguments.json) print_report(reports, 2);
    if (!all_good) throw Failed{};
}

}  // namespace

void add_validate(CLI::App& program) {
    const auto arguments = std::make_shared<ValidateArguments>();
    CLI::App* command = program.add_subcommand("validate", "Report every error in files, with its place");
    command->add_option("FILE", arguments->files, "bendy files, or files that `bendy convert` reads")->required();
    add_root(*command, arguments->root);
    command->add_flag("--json", arguments->json, "print a JSON report");
    command->footer(
        "Prints nothing and exits with 0 if the files are valid; otherwise prints one line per error and exits with 1. "
        "A link to an image that does not exist is only a warning, on standard error or in the report's "
        "\"warnings\". Of a file that `bendy convert` reads, it prints what the conversion finds, with the place in "
        "the "
        "source: an error as such a line, warnings as warnings.\nExample: bendy validate fox.bendy");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::tools
