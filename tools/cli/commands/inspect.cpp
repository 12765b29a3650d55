#include "commands/commands.h"
#include "commands/model_options.h"
#include "files/input.h"
#include "files/output.h"
#include "reports/describe_chunk.h"
#include "reports/inspect_html.h"
#include "reports/json.h"
#include "reports/messages.h"
#include "reports/summary.h"

#include <bendy/format/chunk_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>
#include <bendy/runtime/model.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string_view>

namespace bendy::tools {
namespace {

using Json = OrderedJson;

struct InspectArguments {
    std::filesystem::path file;
    std::filesystem::path root;
    std::string chunk;
    bool json = false;
    bool summary = false;
    bool hex = false;
    bool all = false;
    std::filesystem::path html;
};

/// Chunks whose content is already in their parent's line.
bool is_folded(const ChunkTree& tree, const Chunk& chunk) {
    constexpr std::array kFolded{FourCC("NAME"), FourCC("PIVO"), FourCC("REST"), FourCC("VINF"), FourCC("CINF"),
                                 FourCC("TINF"), FourCC("SURF"), FourCC("SAMP"), FourCC("POLY"), FourCC("KINF")};
    if (chunk.id == FourCC("EXTR") || chunk.id == FourCC("EXTN") || chunk.id == FourCC("MORE"))
        return tree[chunk.parent].id == FourCC("SKIN");
    return std::find(kFolded.begin(), kFolded.end(), chunk.id) != kFolded.end();
}

/// Numbers the chunks that other records refer to, in file order.
class Counters {
public:
    /// Returns " 7"; empty for a chunk that has no number of its kind.
    std::string label(FourCC id) {
        if (id == FourCC("OBJE")) {
            for (Counter& counter : counters_) counter.next = counter.is_of_object ? 0 : counter.next;
        }
        for (Counter& counter : counters_) {
            if (counter.id == id) return ' ' + std::to_string(counter.next++);
        }
        return {};
    }

private:
    struct Counter {
        FourCC id;
        bool is_of_object;  // numbered within it
        std::uint32_t next = 0;
    };
    std::array<Counter, 6> counters_{{{FourCC("SKIN"), true},
                                      {FourCC("IKCH"), true},
                                      {FourCC("VECT"), true},
                                      {FourCC("CYCL"), true},
                                      {FourCC("MATE"), false},
                                      {FourCC("TEXT"), false}}};
};

std::string indentation(std::size_t depth) {
    constexpr std::size_t kMostLevels = 40;
    std::string spaces(2 * std::min(depth, kMostLevels), ' ');
    if (depth > kMostLevels) spaces += '[' + std::to_string(depth) + "] ";
    return spaces;
}

/// Shows folded chunks, too, where there is a fault in them.
void print_tree(const ChunkTree& tree, std::uint32_t root, bool all, const FaultyChunks& faulty) {
    const std::size_t width = columns_of(Stream::output);
    std::cout << in_colour(Colour::bold, "      offset         size  chunk", Stream::output) << '\n';
    std::vector<std::uint32_t> ends;  // of the containers around this chunk
    Counters counters;
    const RigIndex rigs(tree);
    for (std::uint32_t number = 0; number < tree[root].end;) {
        const Chunk& chunk = tree[number];
        const std::string label = counters.label(chunk.id);
        if (number < root) {
            ++number;  // counted only
            continue;
        }
        while (!ends.empty() && number >= ends.back()) ends.pop_back();
        if (!all && number != root && is_folded(tree, chunk) && !faulty.has_fault(tree, number)) {
            number = chunk.end;
            continue;
        }
        std::array<char, 32> columns{};
        std::snprintf(columns.data(), columns.size(), "%12llu %12llu  ", static_cast<unsigned long long>(chunk.offset),
                      static_cast<unsigned long long>(chunk.size));
        const std::string before = columns.data() + indentation(ends.size());
        std::string line = before;
        line += chunk.id.letters().data();
        line += label;
        const std::string fault = faulty.text(number);
        if (!fault.empty()) line += "  FAULT: " + fault;
        const std::string content = describe_chunk(tree, number, rigs);
        if (!content.empty()) line += "  " + content;
        line = cut_to(line, width);
        const std::size_t start = std::min(before.size(), line.size());
        const std::size_t end = std::min(start + chunk.id.letters().size() - 1, line.size());
        std::cout << line.substr(0, start)
                  << in_colour(Colour::bold, std::string_view(line).substr(start, end - start), Stream::output)
                  << (fault.empty() ? line.substr(end) : in_colour(Colour::red, line.substr(end), Stream::output))
                  << '\n';
        if (chunk.is_container()) ends.push_back(chunk.end);
        ++number;
    }
}

void print_hex(Bytes bytes, std::uint64_t offset) {
    constexpr std::size_t kPerLine = 16;
    for (std::size_t at = 0; at < bytes.size(); at += kPerLine) {
        const Bytes line = bytes.subspan(at, std::min(kPerLine, bytes.size() - at));
        const unsigned long long address = offset + at;
        std::array<char, 24> start{};
        std::snprintf(start.data(), start.size(), "%12llx ", address);
        std::cout << start.data();
        std::string text;
        for (std::size_t i = 0; i < kPerLine; ++i) {
            if (i % 4 == 0) std::cout << ' ';
            if (i >= line.size()) {
                std::cout << "  ";
                continue;
            }
            const auto byte = std::to_integer<unsigned>(line[i]);
            std::array<char, 3> digits{};
            std::snprintf(digits.data(), digits.size(), "%02x", byte);
            std::cout << digits.data();
            text += byte >= 0x20 && byte < 0x7f ? static_cast<char>(byte) : '.';
        }
        std::cout << "  " << text << '\n';
    }
}

void print_json(const InspectArguments& arguments, const ChunkTree& tree, std::uint32_t root,
                const std::optional<Summary>& summary, const FaultyChunks& faulty) {
    Json document{{"file", arguments.file.string()}, {"bytes", tree.bytes().size()}};
    if (arguments.chunk.empty()) document["summary"] = summary ? summary_as_json(*summary) : Json(nullptr);
    if (!arguments.summary) document["chunks"] = chunks_as_json(tree, root, faulty);
    print_report(document, 1);
}

std::string short_name(const std::filesystem::path& file) {
    return is_dash(file) ? "standard input" : file.filename().string();
}

void print_text(const InspectArguments& arguments, const ChunkTree& tree, std::uint32_t root,
                const std::optional<Summary>& summary, const FaultyChunks& faulty) {
    const std::string name = short_name(arguments.file);
    if (arguments.chunk.empty() && summary) {
        std::cout << summary_as_text(*summary, name, columns_of(Stream::output));
        if (arguments.summary) return;
        std::cout << '\n';
    } else if (root == 0) {
        std::cout << escaped(name) << ", " << grouped(tree.bytes().size()) << " bytes, "
                  << grouped(tree.chunks().size()) << " chunks\n";
    }
    print_tree(tree, root, arguments.all, faulty);
}

/// \returns its size in bytes
std::size_t write_page(const InspectArguments& arguments, const Outputs& outputs, const InspectedFile& file) {
    const std::string page = inspect_page(file);
    outputs.write(arguments.html, page);
    return page.size();
}

/// Writes the page for a faulty file too. A file whose grammar is broken has no tree, and still counts as bad input.
void run_html(const InspectArguments& arguments) {
    Outputs outputs;
    outputs.reads(arguments.file);
    outputs.writes(arguments.html, NamedBy::user, Content::text);
    check_suffix({"inspect", "--html", {".html", ".htm", ".xhtml"}}, arguments.file, arguments.html);
    const CharacterFile input = open_character(arguments.file, arguments.root, outputs);
    InspectedFile file;
    file.name = short_name(arguments.file);
    file.bytes = input.bytes();
    Result<ChunkTree> tree = read_chunk_tree(file.bytes);
    if (!tree) {
        file.faults.add(tree.error());
        write_page(arguments, outputs, file);
        fail(arguments.file, tree.error(), file.bytes);
    }
    check_sums(*tree, file.faults);
    decode_leaves(*tree);
    file.tree = &*tree;
    file.document = read_document(*tree, file.faults);
    check_values(*tree, file.document, file.faults);
    if (file.faults.empty()) {
        file.pictures = draw_page_pictures(file.bytes, folders_of(arguments.file, arguments.root));
    } else {
        file.pictures.why_none = "the file has faults";
    }
    const std::size_t size = write_page(arguments, outputs, file);
    print_size(arguments.html, size) << ", " << counted(file.faults.count(), "fault") << '\n';
    if (!file.faults.empty()) fail_for_faults(arguments.file, file.faults, file.bytes);
}

void run(const InspectArguments& arguments) {
    require_folder_of(arguments.html);
    if (!arguments.html.empty()) {
        run_html(arguments);
        return;
    }
    Outputs outputs;
    const CharacterFile file = open_character(arguments.file, arguments.root, outputs);
    ChunkTree tree = read_tree(arguments.file, file.bytes());
    decode_leaves(tree);
    const std::uint32_t root = arguments.chunk.empty() ? 0 : find_path(tree, arguments.chunk);
    if (root == kNone) {
        fail(arguments.file,
             "there is no chunk " + printable(arguments.chunk) + "; paths look like HEAD/OBJE/SKIN[1]/NAME");
    }

    Faults faults;
    check_sums(tree, faults);
    const Document document = read_document(tree, faults);
    check_values(tree, document, faults);
    const FaultyChunks faulty(tree, faults);
    if (!faults.empty() && arguments.summary) fail(arguments.file, faults.list().front(), file.bytes());
    std::optional<Summary> summary;  // empty for a file with faults, which still has chunks to show
    if (root == 0 && !arguments.hex && faults.empty()) {
        Result<Summary> found = summarize_file(tree, file.bytes());
        if (!found) fail(arguments.file, found.error(), file.bytes());
        summary = *std::move(found);
    }
    if (arguments.json) {
        print_json(arguments, tree, root, summary, faulty);
    } else if (arguments.hex) {
        const Chunk& chunk = tree[root];
        print_hex(file.bytes().subspan(chunk.offset, kChunkHeaderSize + chunk.size), chunk.offset);
    } else {
        print_text(arguments, tree, root, summary, faulty);
    }
    if (!faults.empty()) fail_for_faults(arguments.file, faults, file.bytes());
}

}  // namespace

void add_inspect(CLI::App& program) {
    const auto arguments = std::make_shared<InspectArguments>();
    CLI::App* command = program.add_subcommand(
        "inspect", "Show what is in a file: a summary, then the chunk tree with ids, offsets, sizes");
    add_character(*command, arguments->file)->required();
    CLI::Option* chunk =
        command->add_option("--chunk", arguments->chunk, "only this chunk and its contents: a path, or @OFFSET");
    CLI::Option* json = command->add_flag("--json", arguments->json,
                                          "print JSON: the summary by name, and every chunk with its record's fields");
    CLI::Option* hex = command->add_flag("--hex", arguments->hex, "print the chunk's bytes")->excludes(json);
    CLI::Option* all =
        command->add_flag("--all", arguments->all, "also show the chunks that are folded into their parent's line");
    CLI::Option* summary = command
                               ->add_flag("--summary", arguments->summary,
                                          "only what the character consists of: joints, rig, meshes, clips, materials, "
                                          "textures, bounds, sizes; without the chunk tree")
                               ->excludes(hex)
                               ->excludes(all)
                               ->excludes(chunk);
    command
        ->add_option("--html", arguments->html,
                     "write OUT.html instead: one page for a browser with the chunks, skeleton, clips, textures, "
                     "materials and faults; it loads nothing, and images of more than 32 MiB in all are left out")
        ->excludes(json)
        ->excludes(hex)
        ->excludes(chunk)
        ->excludes(all)
        ->excludes(summary);
    add_root(*command, arguments->root);
    command->footer(
        "What is in the JSON: docs/inspect.md.\n"
        "Example: bendy inspect fox.bendy --summary\n"
        "         bendy inspect fox.bendy --chunk HEAD/OBJE/CYCL[2]\n"
        "         bendy inspect fox.bendy --html fox.html");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::tools
