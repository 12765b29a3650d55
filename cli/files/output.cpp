#include "files/output.h"

#include "files/input.h"
#include "files/written_by_bendy.h"
#include "terminal/console.h"
#include "terminal/problem.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>

#include <CLI/Error.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <iostream>
#include <span>
#include <system_error>

namespace bendy::cli {
namespace {

namespace fs = std::filesystem;

/// Where a file is or will be, links followed, also one that leads to what is not there yet.
fs::path resolved(fs::path file) {
    constexpr int kMostLinks = 40;
    std::error_code error;
    for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(file, error)); ++i) {
        const fs::path target = fs::read_symlink(file, error);
        if (error) break;
        file = file.parent_path() / target;
    }
    fs::path canonical = fs::weakly_canonical(fs::absolute(file), error);
    return error ? fs::absolute(file).lexically_normal() : canonical;
}

bool is_there(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored);
}

/// A device or a pipe takes what is written; nothing is lost there.
bool holds_bytes(const fs::path& file) {
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    return fs::exists(status) && (fs::is_regular_file(status) || fs::is_directory(status));
}

constexpr const char* kForeign = "is there, and bendy did not write it: --force replaces it, -o writes elsewhere";

/// A suffix with a meaning, and who writes it.
struct Meaning {
    std::string_view suffix;
    std::string_view format;
    std::string_view command;  ///< empty: bendy does not write it
};

constexpr std::array kMeanings{
    Meaning{".bendy", "a bendy file", "convert"},
    Meaning{".glb", "binary glTF", "export"},
    Meaning{".gltf", "glTF", "export"},
    Meaning{".x", "an X-file", "export"},
    Meaning{".obj", "Wavefront OBJ", "pose"},
    Meaning{".ply", "PLY", "pose"},
    Meaning{".json", "JSON", "dump"},
    Meaning{".html", "HTML", "inspect"},
    Meaning{".htm", "HTML", "inspect"},
    Meaning{".png", "PNG", "render"},
    Meaning{".gif", "GIF", "render"},
    Meaning{".webp", "WebP", "render"},
    // What people want from a character and we do not write: as models, by way of glTF; as pictures, by PNG.
    Meaning{".vrm", "VRM", {}},
    Meaning{".md2", "a Quake II model", {}},
    Meaning{".md3", "a Quake III model", {}},
    Meaning{".md5mesh", "a Doom 3 model", {}},
    Meaning{".iqm", "IQM", {}},
    Meaning{".fbx", "FBX", {}},
    Meaning{".dae", "COLLADA", {}},
    Meaning{".blend", "a Blender file", {}},
    Meaning{".usd", "USD", {}},
    Meaning{".usda", "USD", {}},
    Meaning{".usdc", "USD", {}},
    Meaning{".usdz", "USD", {}},
    Meaning{".abc", "Alembic", {}},
    Meaning{".bvh", "BVH", {}},
    Meaning{".3ds", "3DS", {}},
    Meaning{".stl", "STL", {}},
    Meaning{".max", "a 3ds Max file", {}},
    Meaning{".ma", "a Maya file", {}},
    Meaning{".mb", "a Maya file", {}},
    Meaning{".jpg", "JPEG", {}},
    Meaning{".jpeg", "JPEG", {}},
    Meaning{".bmp", "BMP", {}},
    Meaning{".tga", "TGA", {}},
    Meaning{".tif", "TIFF", {}},
    Meaning{".tiff", "TIFF", {}},
    Meaning{".avif", "AVIF", {}},
    Meaning{".apng", "animated PNG", {}},
    Meaning{".mp4", "MP4", {}},
    Meaning{".webm", "WebM", {}},
    Meaning{".mov", "QuickTime", {}},
    Meaning{".avi", "AVI", {}},
    Meaning{".zip", "a ZIP archive", {}},
};

bool is_picture(std::string_view suffix) {
    constexpr std::array<std::string_view, 12> kPictures{".jpg",  ".jpeg", ".bmp", ".tga",  ".tif", ".tiff",
                                                         ".avif", ".apng", ".mp4", ".webm", ".mov", ".avi"};
    return std::find(kPictures.begin(), kPictures.end(), suffix) != kPictures.end();
}

/// A name as a shell reads it; for people, so control characters are escaped.
std::string quoted(const std::filesystem::path& file) {
    const std::string name = printable(file.string());
    constexpr std::string_view kPlain = "._-/+=:,@%";
    const bool is_plain = std::all_of(name.begin(), name.end(), [&](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               static_cast<unsigned char>(c) >= 0x80 || kPlain.find(c) != std::string_view::npos;
    });
    return is_plain ? name : '"' + name + '"';
}

/// "bendy export fox.bendy -o fox.glb", where need be with the command that makes the bendy file first.
std::string commands_for(const Writes& writes, const Meaning& wanted, const std::filesystem::path& input,
                         const std::filesystem::path& output) {
    std::filesystem::path bendy_file = input;
    std::string text;
    const bool makes_bendy_files =
        std::find(writes.suffixes.begin(), writes.suffixes.end(), ".bendy") != writes.suffixes.end();
    if (makes_bendy_files && wanted.suffix != ".bendy") {
        bendy_file = std::filesystem::path(output).replace_extension(".bendy");
        text = "bendy " + std::string(writes.command) + ' ' + quoted(input) + (writes.command == "edit" ? " ..." : "") +
               " -o " + quoted(bendy_file) + " && ";
    }
    text += "bendy " + std::string(wanted.command) + ' ' + quoted(bendy_file);
    return text + (wanted.command == "inspect" ? " --html " : " -o ") + quoted(output);
}

const Meaning* find_meaning(std::string_view suffix) {
    const auto* const found = std::find_if(kMeanings.begin(), kMeanings.end(),
                                           [&](const Meaning& meaning) { return meaning.suffix == suffix; });
    return found == kMeanings.end() ? nullptr : found;
}

std::string list(const std::vector<std::string_view>& suffixes) {
    std::string text;
    for (std::size_t i = 0; i < suffixes.size(); ++i) {
        if (i != 0) text += i + 1 == suffixes.size() ? " or " : ", ";
        text += suffixes[i];
    }
    return text;
}

}  // namespace

void Outputs::reads(const fs::path& input) {
    const auto identity = is_dash(input) ? identity_of_standard_input() : identity_of(input);
    if (identity) inputs_.try_emplace(*identity, input);
}

const fs::path* Outputs::input_at(const fs::path& output) const {
    const auto identity = is_dash(output) ? identity_of_standard_output() : identity_of(output);
    if (!identity) return nullptr;
    const auto found = inputs_.find(*identity);
    return found == inputs_.end() ? nullptr : &found->second;
}

std::string Outputs::claim(const fs::path& output, NamedBy named) {
    if (const fs::path* input = input_at(output)) {
        return "is an input as well as an output" +
               (*input == output ? std::string() : ", it is " + shown_name(*input)) + ": give another name";
    }
    if (is_dash(output))
        return outputs_.insert(output).second ? "" : "cannot take two outputs: write one of them to a file";
    if (holds_bytes(output) || !is_there(output)) {
        bool is_new = resolved_.insert(resolved(output)).second;
        if (const auto identity = identity_of(output)) is_new = replaced_.insert(*identity).second && is_new;
        if (!is_new) return "would be written twice: give each output a name of its own";
    }
    if (named == NamedBy::program && !force_ && is_there(output) && !was_written_by_bendy(output)) return kForeign;
    outputs_.insert(output);
    return {};
}

void Outputs::fail_if(const std::string& problem, const fs::path& output) const {
    if (!problem.empty()) fail(output_name(output), problem);
}

void Outputs::writes(const fs::path& output, NamedBy named, Content content) {
    fail_if(claim(output, named), output);
    if (is_dash(output) && content == Content::binary && is_terminal(Stream::output))
        fail(output_name(output), "is a terminal, and the result is binary: give -o FILE, or a pipe");
}

void Outputs::writes_beside(const fs::path& output, const fs::path& beside) {
    fail_if(claim(output, NamedBy::user), output);
    if (!force_ && is_there(output) && !(was_written_by_bendy(beside) && refers_to(beside, output)))
        fail(output_name(output), kForeign);
}

void Outputs::write(const fs::path& output, Bytes bytes) const {
    assert(outputs_.contains(output));
    for (const fs::path& claimed : outputs_) {
        if (const fs::path* input = input_at(claimed))
            fail(output_name(claimed), "is an input as well as an output: " + shown_name(*input) + " was read");
    }
    if (is_dash(output)) {
        const auto text = as_text(bytes);
        std::cout.write(text.data(), static_cast<std::streamsize>(text.size()));
        return;
    }
    if (const auto written = write_file(output, bytes); !written) fail(output, describe(written.error()));
}

void Outputs::write(const fs::path& output, std::string_view text) const {
    write(output, as_byte_span(text));
}

std::string output_name(const fs::path& output) {
    return is_dash(output) ? "standard output" : output.string();
}

std::ostream& summary_stream(const fs::path& output) {
    return is_dash(output) ? std::cerr : std::cout;
}

void require_folder_of(const std::filesystem::path& output) {
    const std::filesystem::path folder = output.parent_path();
    if (folder.empty()) return;
    std::error_code unknown;
    const std::filesystem::file_status status = std::filesystem::status(folder, unknown);
    if (status.type() == std::filesystem::file_type::not_found) {
        fail(output, "there is no folder " + printable(folder.string()) + ": make it first");
    } else if (std::filesystem::exists(status) && !std::filesystem::is_directory(status)) {
        fail(output, printable(folder.string()) + " is a file, not a folder");
    }
}

void check_format(const Writes& writes, const std::string& format, const std::filesystem::path& input,
                  const std::filesystem::path& output) {
    Writes named = writes;
    named.others_too = named.others_too || !format.empty();
    check_suffix(named, input, output);
    const std::string suffix = suffix_of(output);
    const bool is_meant = std::find(writes.suffixes.begin(), writes.suffixes.end(), suffix) != writes.suffixes.end();
    if (!format.empty() && is_meant && suffix != '.' + format)
        throw CLI::ValidationError("--format", format + " is not what " + printable(output.string()) + " would be");
}

std::string suffix_of(const std::filesystem::path& file) {
    std::string suffix = file.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return suffix;
}

std::string_view format_named_by(const std::filesystem::path& file) {
    const Meaning* meaning = find_meaning(suffix_of(file));
    return meaning == nullptr ? std::string_view() : meaning->format;
}

void check_suffix(const Writes& writes, const std::filesystem::path& input, const std::filesystem::path& output) {
    const std::string suffix = suffix_of(output);
    if (is_dash(output) || std::find(writes.suffixes.begin(), writes.suffixes.end(), suffix) != writes.suffixes.end())
        return;
    const Meaning* meaning = find_meaning(suffix);
    const std::string option(writes.option);
    if (meaning == nullptr) {
        if (writes.others_too) return;
        throw CLI::ValidationError(option, printable(output.string()) + " must end in " + list(writes.suffixes));
    }
    std::string what = printable(output.string()) + " would be " + std::string(meaning->format) + ", which ";
    if (!meaning->command.empty()) {
        what += "`bendy " + std::string(writes.command) + "` does not write: ";
        throw CLI::ValidationError(option, what + commands_for(writes, *meaning, input, output));
    }
    const bool shown = is_picture(suffix);
    const Meaning& nearest = *find_meaning(shown ? ".png" : ".glb");
    what += std::string("bendy does not write; ") + (shown ? "a picture" : "glTF, which most programs read") + ": ";
    const auto other = std::filesystem::path(output).replace_extension(nearest.suffix);
    throw CLI::ValidationError(
        option,
        what + (std::find(writes.suffixes.begin(), writes.suffixes.end(), nearest.suffix) != writes.suffixes.end()
                    ? "bendy " + std::string(writes.command) + ' ' + quoted(input) + " -o " + quoted(other)
                    : commands_for(writes, nearest, input, other)));
}

}  // namespace bendy::cli
