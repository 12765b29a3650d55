#pragma once

#include "reports/suffixes.h"

#include <bendy/format/byte_reader.h>
#include <bendy/format/file.h>

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// All subcommands write through this, so that none of them destroys a file (docs/decisions/0031).
namespace bendy::tools {

/// Identifies a file: two names, hard links or symbolic links of one file have the same identity.
using FileIdentity = std::pair<std::uint64_t, std::uint64_t>;

/// Returns the identity of the file that a name leads to; nothing if there is none.
std::optional<FileIdentity> identity_of(const std::filesystem::path& file);

/// Return the identity of the file that standard input or output is redirected to; nothing for a pipe, a terminal or a
/// device.
std::optional<FileIdentity> identity_of_standard_input();
std::optional<FileIdentity> identity_of_standard_output();

/// Returns why an existing file must not be replaced under a name that the program chose, as words that follow its
/// name; empty if the file says that bendy wrote it, in any version.
std::string why_not_replaced(const std::filesystem::path& file);

/// Who chose an output's name.
enum class NamedBy : std::uint8_t {
    user,     ///< with -o or similar: an existing file is replaced, as compilers do
    program,  ///< for example the input's name with another suffix: replaces only what bendy wrote
};

enum class Content : std::uint8_t { binary, text };

/// The files that one run reads and writes. An output is never an input, and no two outputs are the same file, hard
/// links and symbolic links included. A dash is standard output.
class Outputs {
public:
    /// \param force  a name that the program chose may replace any file
    explicit Outputs(bool force = false) : force_(force) {}

    /// Notes a file that is read; a dash is standard input. A file that does not exist is ignored.
    void reads(const std::filesystem::path& input);

    /// Notes an output. \returns why it must not be written, as words that follow its name; empty if it may.
    [[nodiscard]] std::string claim(const std::filesystem::path& output, NamedBy named);
    /// The same, but prints the reason and throws Failed. Binary data is not written to a terminal.
    void writes(const std::filesystem::path& output, NamedBy named, Content content);
    /// For a file whose name follows from the name of `beside`, such as fox.bin beside fox.gltf: replaces an existing
    /// file only if bendy wrote `beside` and it refers to that file.
    void writes_beside(const std::filesystem::path& output, const std::filesystem::path& beside);

    /// Writes outputs that were noted: all of them, or none. Fails if one of them has since turned out to be an input.
    void write(std::span<const FileContents> files) const;
    /// The same for outputs that are made one after another, none of them standard output: `stage` writes one beside
    /// the old file, `replace_staged` then puts all of them in place. Only one of them at a time is in memory.
    void stage(const std::filesystem::path& output, Bytes bytes);
    void replace_staged();
    void write(const std::filesystem::path& output, Bytes bytes) const;
    /// Escapes control characters in text that goes to a terminal.
    void write(const std::filesystem::path& output, std::string_view text) const;

private:
    [[nodiscard]] const std::filesystem::path* input_at(const std::filesystem::path& output) const;
    void fail_if(const std::string& problem, const std::filesystem::path& output) const;
    void fail_for_inputs() const;

    bool force_;
    std::map<FileIdentity, std::filesystem::path> inputs_;
    std::set<std::filesystem::path> outputs_;   // as given
    std::set<std::filesystem::path> resolved_;  // links followed, whether the file exists or not
    std::set<FileIdentity> replaced_;           // the outputs that exist
    FileSet staged_;
    std::vector<std::filesystem::path> staged_names_;
};

/// Returns "standard output" for a dash, otherwise the path.
std::string output_name(const std::filesystem::path& output);

/// The stream for a summary: standard error if the result goes to standard output.
std::ostream& summary_stream(const std::filesystem::path& output);
/// Prints "fox.bendy: 1,234 bytes" to that stream.
std::ostream& print_size(const std::filesystem::path& output, std::uint64_t bytes);
/// ", 1,234 less", or more; empty if nothing has changed.
std::string change_of_size(std::uint64_t before, std::uint64_t after);

/// Fails, naming the folder, if an output's folder does not exist: before the work rather than after it.
void require_folder_of(const std::filesystem::path& output);

/// The output formats of a subcommand.
struct Writes {
    std::string_view command;                ///< "convert"
    std::string_view option;                 ///< the option that names the output: "--output"
    std::vector<std::string_view> suffixes;  ///< the formats that it writes, in lower case
    bool others_too = true;                  ///< an unknown suffix, or none, means the same format

    [[nodiscard]] bool has(std::string_view suffix) const;
};

/// Throws CLI::ValidationError if the output's suffix means a format that the subcommand does not write, and says which
/// commands convert `input` to it; also, unless `others_too`, if the suffix is not one of the suffixes. Standard output
/// is always accepted.
/// \param format  from --format, a suffix without its dot; empty: not given. It overrides a suffix without a meaning,
/// and must agree with one that has a meaning
void check_suffix(const Writes& writes, const std::filesystem::path& input, const std::filesystem::path& output,
                  const std::string& format = {});

/// Returns the format of an output: from --format, otherwise from its name. \param usual  for standard output, and for
/// a name without a suffix
std::string format_of(const std::string& format, const std::filesystem::path& output, const char* usual);

}  // namespace bendy::tools
