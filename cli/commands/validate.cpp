#include "commands/commands.h"
#include "files/input.h"
#include "terminal/json.h"
#include "terminal/messages.h"

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

namespace bendy::cli {
namespace {

struct ValidateArguments {
    std::vector<std::filesystem::path> files;
    bool json = false;
};

/// What is wrong with a file that is no bendy file at all: it cannot be opened, or is known to be something else.
/// Empty for all others, whose faults tell.
std::string why_no_file(const std::filesystem::path& file, const Result<InputBytes>& mapped) {
    return mapped ? why_not_bendy(file, mapped->bytes()) : why_not_opened(file, mapped.error());
}

/// A LINK to an image file that does not exist.
struct DanglingLink {
    std::uint64_t offset = 0;  ///< of the chunk
    std::string uri;
};

using Links = std::vector<DanglingLink>;

/// Of a file's bytes, which links are relative to its folder. Data URIs and other schemes are not looked at; of bytes
/// that cannot be read, nothing.
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
            const auto linked = folders.find(image.uri);  // of a file outside, nobody is told whether it exists
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

nlohmann::json to_json(const std::filesystem::path& file, const Faults& faults, const Links& links, Bytes bytes,
                       const std::string& why) {
    nlohmann::json list = nlohmann::json::array();
    for (const Error& fault : faults.list()) {
        list.push_back({{"code", code_name(fault.code)},
                        {"class", class_name(error_class(fault.code))},
                        {"path", whole_chunk_path(bytes, fault.offset)},
                        {"offset", fault.offset},
                        {"message", why.empty() ? describe(fault) : why}});
    }
    nlohmann::json warnings = nlohmann::json::array();
    for (const DanglingLink& link : links) {
        warnings.push_back(
            {{"path", whole_chunk_path(bytes, link.offset)}, {"offset", link.offset}, {"message", text_of(link)}});
    }
    return {{"file", file.string()},
            {"valid", faults.empty()},
            {"faults", list},
            {"faultsLeftOut", faults.left_out()},
            {"warnings", warnings}};
}

void run(const ValidateArguments& arguments) {
    bool all_good = true;
    nlohmann::json report = nlohmann::json::array();
    for (const std::filesystem::path& file : arguments.files) {
        const Result<InputBytes> mapped = InputBytes::open(file);
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
        all_good = all_good && faults.empty();
        const std::string why = why_no_file(file, mapped);
        if (arguments.json) {
            report.push_back(to_json(file, faults, links, bytes, why));
        } else if (!why.empty()) {
            std::cerr << error_label() << shown_name(file) << ": " << printable(why) << '\n';
        } else {
            print_fault_lines(std::cout, file, faults, bytes);
            for (const DanglingLink& link : links)
                warn(file, printable(chunk_path(bytes, link.offset) + ": " + text_of(link)));
        }
    }
    if (arguments.json) print_report(report, 2);
    if (!all_good) throw Failed{};
}

}  // namespace

void add_validate(CLI::App& program) {
    const auto arguments = std::make_shared<ValidateArguments>();
    CLI::App* command = program.add_subcommand("validate", "Report every error in files, with its place");
    command->add_option("FILE", arguments->files, "bendy files")->required();
    command->add_flag("--json", arguments->json, "print a JSON report");
    command->footer(
        "Prints nothing and exits with 0 if the files are valid; otherwise prints one line per error and exits with 1. "
        "A link to an image that does not exist is only a warning, on standard error or in the report's "
        "\"warnings\".\nExample: bendy validate fox.bendy");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::cli
