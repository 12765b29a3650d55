#include "files/output.h"

#include "files/input.h"
#include "reports/console.h"
#include "reports/json.h"
#include "reports/messages.h"

#include <bendy/converter/source_format.h>
#include <bendy/format/chunk.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>
#include <bendy/format/read_record.h>
#include <bendy/format/readable_folders.h>
#include <bendy/format/records.h>

#include <CLI/Error.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <iostream>
#include <system_error>

namespace bendy::tools {
namespace {

namespace fs = std::filesystem;

/// Returns the path of a file with links followed, even if it does not exist yet.
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

/// Writing to a device or a pipe loses nothing.
bool holds_bytes(const fs::path& file) {
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    return fs::exists(status) && (fs::is_regular_file(status) || fs::is_directory(status));
}

/// Matches "bendy 0.8.0", with or without more text.
bool is_ours(std::string_view generator) {
    constexpr std::string_view kName = "bendy ";
    return generator.starts_with(kName) && generator.size() > kName.size() && generator[kName.size()] >= '0' &&
           generator[kName.size()] <= '9';
}

/// Collects from a glTF file's JSON who wrote it and which files belong to it. Builds no values, however deep they
/// nest.
class AssetReader : public nlohmann::json_sax<nlohmann::json> {
public:
    std::string generator;
    std::vector<std::string> buffers;  ///< URIs

    bool key(string_t& name) override {
        if (depth_ == 1) member_ = name;
        field_ = name;
        return true;
    }
    bool string(string_t& text) override {
        if (depth_ == 2 && member_ == "asset" && field_ == "generator") generator = text;
        if (depth_ == 3 && member_ == "buffers" && field_ == "uri" && !is_data_uri(text)) buffers.push_back(text);
        return true;
    }
    bool start_object(std::size_t /*size*/) override { return ++depth_ != 0; }
    bool start_array(std::size_t /*size*/) override { return ++depth_ != 0; }
    bool end_object() override { return depth_-- != 0; }
    bool end_array() override { return depth_-- != 0; }
    bool null() override { return true; }
    bool boolean(bool /*value*/) override { return true; }
    bool number_integer(number_integer_t /*value*/) override { return true; }
    bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
    bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return true; }
    bool binary(binary_t& /*bytes*/) override { return true; }
    bool parse_error(std::size_t /*at*/, const std::string& /*token*/, const nlohmann::detail::exception&) override {
        return false;
    }

private:
    std::size_t depth_ = 0;
    std::string member_, field_;
};

bool is_bendy(Bytes bytes) {
    return as_text(bytes).starts_with("HEAD");
}

/// VERS is the first chunk in HEAD.
std::string_view generator_of_bendy_file(Bytes bytes) {
    constexpr std::size_t kVersion = 2 * kChunkHeaderSize;  // behind the headers of HEAD and VERS
    constexpr std::size_t kGenerator = 48;                  // in the record, see spec/chunks/VERS.md
    constexpr std::size_t kLength = sizeof(VersionRecord::generator);
    if (bytes.size() < kVersion + kGenerator + kLength || as_text(bytes.subspan(kChunkHeaderSize, 4)) != "VERS")
        return {};
    const std::string_view text = as_text(bytes.subspan(kVersion + kGenerator, kLength));
    return text.substr(0, text.find('\0'));
}

/// The JSON of a glTF file in either container.
std::string_view json_of(Bytes bytes) {
    constexpr std::size_t kJson = 20;  // behind the headers of the file and of its first chunk
    const std::string_view text = as_text(bytes);
    if (!text.starts_with("glTF")) return text;
    std::uint32_t size = 0;
    if (bytes.size() < kJson) return {};
    copy_at(bytes, 12, size);
    return text.substr(kJson, size);
}

AssetReader read_asset(Bytes bytes) {
    AssetReader reader;
    const std::string_view json = json_of(bytes);
    if (!nlohmann::json::sax_parse(json.begin(), json.end(), &reader, nlohmann::json::input_format_t::json, false))
        reader = AssetReader();
    return reader;
}

constexpr std::string_view kXFile = "xof ";

/// The comment in the second line.
std::string_view generator_of_x_file(std::string_view text) {
    constexpr std::string_view kComment = "// ";
    const std::string_view rest = text.substr(std::min(text.find('\n'), text.size() - 1) + 1);
    return rest.starts_with(kComment) ? rest.substr(kComment.size()) : std::string_view();
}

std::string utf8(const fs::path& path) {
    const std::u8string text = path.u8string();
    return {text.begin(), text.end()};
}

/// Returns true if a glTF file has `other`, in the same folder, as a buffer; or if an X-file names it.
bool refers_to(const fs::path& file, const fs::path& other) {
    const Result<MappedFile> mapped = MappedFile::open(file);
    if (!mapped) return false;
    const std::string name = utf8(other.filename());
    const std::string_view text = as_text(mapped->bytes());
    if (text.starts_with(kXFile)) return text.find('"' + name + '"') != std::string_view::npos;
    const auto buffers = read_asset(mapped->bytes()).buffers;
    const auto is_other = [&](const std::string& uri) {
        const auto meant = linked_file(uri, {});
        return meant && *meant == other.filename();
    };
    return std::any_of(buffers.begin(), buffers.end(), is_other);
}

bool is_picture(std::string_view suffix) {
    constexpr std::array<std::string_view, 12> kPictures{".jpg",  ".jpeg", ".bmp", ".tga",  ".tif", ".tiff",
                                                         ".avif", ".apng", ".mp4", ".webm", ".mov", ".avi"};
    return std::find(kPictures.begin(), kPictures.end(), suffix) != kPictures.end();
}

std::string quoted(const fs::path& file) {
    return converter::quoted_for_shell(escaped(file.string()));
}

/// Returns "bendy export fox.bendy -o fox.glb", if necessary after the command that makes the bendy file.
std::string commands_for(const Writes& writes, const Meaning& wanted, const fs::path& input, const fs::path& output) {
    fs::path bendy_file = input;
    std::string text;
    if (writes.has(".bendy") && wanted.suffix != ".bendy") {
        bendy_file = fs::path(output).replace_extension(".bendy");
        text = "bendy " + std::string(writes.command) + ' ' + quoted(input) + (writes.command == "edit" ? " ..." : "") +
               " -o " + quoted(bendy_file) + " && ";
    }
    text += "bendy " + std::string(wanted.command) + ' ' + quoted(bendy_file);
    return text + (wanted.command == "inspect" ? " --html " : " -o ") + quoted(output);
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

namespace {

constexpr const char* kForeign = "is there, and bendy did not write it: --force replaces it, -o writes elsewhere";

/// Returns true if the file says that this program wrote it, in any version: a bendy file in VERS, glTF in
/// asset.generator, an X-file in its second line.
Result<bool> was_written_by_bendy(const fs::path& file) {
    const Result<MappedFile> mapped = MappedFile::open(file);
    if (!mapped) return mapped.error();
    const Bytes bytes = mapped->bytes();
    if (is_bendy(bytes)) return is_ours(generator_of_bendy_file(bytes));
    if (as_text(bytes).starts_with(kXFile)) return is_ours(generator_of_x_file(as_text(bytes)));
    return is_ours(read_asset(bytes).generator);
}

}  // namespace

std::string why_not_replaced(const fs::path& file) {
    const auto is_ours = was_written_by_bendy(file);
    if (is_ours && *is_ours) return {};
    if (is_ours) return kForeign;
    return "is there, and cannot be read to see who wrote it: " + describe(is_ours.error());
}

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
    if (named == NamedBy::program && !force_ && is_there(output)) {
        if (std::string problem = why_not_replaced(output); !problem.empty()) return problem;
    }
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
    if (force_ || !is_there(output)) return;
    // It carries no mark of its own.
    if (!why_not_replaced(beside).empty() || !refers_to(beside, output)) fail(output_name(output), kForeign);
}

void Outputs::fail_for_inputs() const {
    for (const fs::path& claimed : outputs_) {
        if (const fs::path* input = input_at(claimed))
            fail(output_name(claimed), "is an input as well as an output: " + shown_name(*input) + " was read");
    }
}

void Outputs::stage(const fs::path& output, Bytes bytes) {
    assert(outputs_.contains(output) && !is_dash(output));
    staged_names_.push_back(output);
    if (const auto staged = staged_.write({output, bytes}); !staged) fail(output, describe(staged.error()));
}

void Outputs::replace_staged() {
    fail_for_inputs();
    if (const auto replaced = staged_.replace(); !replaced)
        fail(staged_names_[replaced.error().file], describe(replaced.error().error));
    staged_names_.clear();
}

void Outputs::write(std::span<const FileContents> files) const {
    fail_for_inputs();
    std::vector<FileContents> named;
    for (const FileContents& file : files) {
        assert(outputs_.contains(file.path));
        if (!is_dash(file.path)) named.push_back(file);
    }
    if (const auto written = write_files(named); !written)
        fail(named[written.error().file].path, describe(written.error().error));
    for (const FileContents& file : files) {
        const auto text = as_text(file.bytes);
        if (is_dash(file.path)) std::cout.write(text.data(), static_cast<std::streamsize>(text.size()));
    }
}

void Outputs::write(const fs::path& output, Bytes bytes) const {
    const FileContents file{output, bytes};
    write({&file, 1});
}

void Outputs::write(const fs::path& output, std::string_view text) const {
    if (is_dash(output) && is_terminal(Stream::output)) {
        const std::string shown = without_controls(std::string(text));
        return write(output, as_byte_span(shown));
    }
    write(output, as_byte_span(text));
}

std::string output_name(const fs::path& output) {
    return is_dash(output) ? "standard output" : output.string();
}

std::ostream& summary_stream(const fs::path& output) {
    return is_dash(output) ? std::cerr : std::cout;
}

std::ostream& print_size(const fs::path& output, std::uint64_t bytes) {
    return summary_stream(output) << escaped(output_name(output)) << ": " << grouped(bytes) << " bytes";
}

std::string change_of_size(std::uint64_t before, std::uint64_t after) {
    if (after == before) return {};
    return ", " + grouped(after < before ? before - after : after - before) + (after < before ? " less" : " more");
}

void require_folder_of(const fs::path& output) {
    const fs::path folder = output.parent_path();
    if (folder.empty()) return;
    std::error_code unknown;
    const fs::file_status status = fs::status(folder, unknown);
    if (status.type() == fs::file_type::not_found) {
        fail(output, "there is no folder " + escaped(folder.string()) + ": make it first");
    } else if (fs::exists(status) && !fs::is_directory(status)) {
        fail(output, escaped(folder.string()) + " is a file, not a folder");
    }
}

bool Writes::has(std::string_view suffix) const {
    return std::find(suffixes.begin(), suffixes.end(), suffix) != suffixes.end();
}

std::string format_of(const std::string& format, const fs::path& output, const char* usual) {
    if (!format.empty()) return format;
    const std::string suffix = suffix_of(output);
    return is_dash(output) || suffix.empty() ? usual : suffix.substr(1);
}

void check_suffix(const Writes& writes, const fs::path& input, const fs::path& output, const std::string& format) {
    const std::string suffix = suffix_of(output);
    if (is_dash(output)) return;
    if (writes.has(suffix)) {
        if (format.empty() || suffix == '.' + format) return;
        throw CLI::ValidationError("--format", format + " is not what " + escaped(output.string()) + " would be");
    }
    const Meaning* meaning = find_meaning(suffix);
    const std::string option(writes.option);
    if (meaning == nullptr) {
        if (writes.others_too || !format.empty()) return;
        throw CLI::ValidationError(option, escaped(output.string()) + " must end in " + list(writes.suffixes));
    }
    std::string what = escaped(output.string()) + " would be " + std::string(meaning->format) + ", which ";
    if (!meaning->command.empty()) {
        what += "`bendy " + std::string(writes.command) + "` does not write: ";
        throw CLI::ValidationError(option, what + commands_for(writes, *meaning, input, output));
    }
    const bool shown = is_picture(suffix);
    const Meaning& nearest = *find_meaning(shown ? ".png" : ".glb");
    what += std::string("bendy does not write; ") + (shown ? "a picture" : "glTF, which most programs read") + ": ";
    const auto other = fs::path(output).replace_extension(nearest.suffix);
    throw CLI::ValidationError(
        option, what + (writes.has(nearest.suffix)
                            ? "bendy " + std::string(writes.command) + ' ' + quoted(input) + " -o " + quoted(other)
                            : commands_for(writes, nearest, input, other)));
}

}  // namespace bendy::tools
