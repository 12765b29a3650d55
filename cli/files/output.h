#pragma once

#include "files/suffixes.h"

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

// Where all subcommands write through, so that none of them loses a file (docs/decisions/0031).
namespace bendy::cli {

/// What tells whether two names, hard links and symbolic links included, are one file.
using FileIdentity = std::pair<std::uint64_t, std::uint64_t>;

/// Of the file that a name leads to; nothing where there is none.
std::optional<FileIdentity> identity_of(const std::filesystem::path& file);

/// Of the file that standard input is read from, or standard output goes to; nothing for a pipe, a terminal or a
/// device.
std::optional<FileIdentity> identity_of_standard_input();
std::optional<FileIdentity> identity_of_standard_output();

/// Why a file that is there must not be replaced by a name that the program chose, in words that follow its name; empty
/// if it says of itself that bendy wrote it, in any version.
std::string why_not_replaced(const std::filesystem::path& file);

/// Who chose an output's name.
enum class NamedBy : std::uint8_t {
    user,     ///< with -o and the like: what is there is replaced, as compilers do
    program,  ///< the input's name with another suffix, for one: replaces only what bendy wrote
};

enum class Content : std::uint8_t { binary, text };

/// The files that one run reads and writes. No output is an input, and no two are the same file, hard links and
/// symbolic links included. A dash is standard output.
class Outputs {
public:
    /// \param force  a name that the program chose may lead to any file
    explicit Outputs(bool force = false) : force_(force) {}

    /// Notes a file that is read, a dash being standard input; one that is not there is none.
    void reads(const std::filesystem::path& input);

    /// Notes an output. \returns why it must not be written, in words that follow its name; empty if it may.
    [[nodiscard]] std::string claim(const std::filesystem::path& output, NamedBy named);
    /// The same; prints why not and throws Failed. A terminal takes no binary.
    void writes(const std::filesystem::path& output, NamedBy named, Content content);
    /// For a file whose name follows from that of `beside`, such as fox.bin beside fox.gltf: replaces an existing file
    /// only if bendy wrote `beside` and it refers to that file.
    void writes_beside(const std::filesystem::path& output, const std::filesystem::path& beside);

    /// Writes outputs that were noted: together, or none of them. Fails where any of them has turned out to be an input
    /// since.
    void write(std::span<const FileContents> files) const;
    void write(const std::filesystem::path& output, Bytes bytes) const;
    /// Escapes control characters in text that goes to a terminal.
    void write(const std::filesystem::path& output, std::string_view text) const;

private:
    [[nodiscard]] const std::filesystem::path* input_at(const std::filesystem::path& output) const;
    void fail_if(const std::string& problem, const std::filesystem::path& output) const;

    bool force_;
    std::map<FileIdentity, std::filesystem::path> inputs_;
    std::set<std::filesystem::path> outputs_;   // as they were given
    std::set<std::filesystem::path> resolved_;  // links followed, whether there is a file or not
    std::set<FileIdentity> replaced_;           // of those that are there
};

/// The name by which messages call an output.
std::string output_name(const std::filesystem::path& output);

/// Where a summary goes: to standard error if the result takes standard output.
std::ostream& summary_stream(const std::filesystem::path& output);
/// "fox.bendy: 1,234 bytes", to that stream.
std::ostream& print_size(const std::filesystem::path& output, std::uint64_t bytes);

/// Fails, naming the folder, where the one that an output goes to is not there: before the work, not after it.
void require_folder_of(const std::filesystem::path& output);

/// What a subcommand writes.
struct Writes {
    std::string_view command;                ///< "convert"
    std::string_view option;                 ///< whose value the output is: "--output"
    std::vector<std::string_view> suffixes;  ///< what it writes, in small letters
    bool others_too = true;                  ///< suffixes without a meaning, and none, name the same format

    [[nodiscard]] bool has(std::string_view suffix) const;
};

/// Throws CLI::ValidationError where the output's suffix means a format that the subcommand does not write, saying by
/// which commands `input` becomes it; or, unless `others_too`, where it is none of the suffixes. Standard output is
/// always right.
/// \param format  what --format says, a suffix without its dot; empty: not given. It goes before a suffix without a
///                meaning, and must agree with one that has it
void check_suffix(const Writes& writes, const std::filesystem::path& input, const std::filesystem::path& output,
                  const std::string& format = {});

/// The format of an output: what --format says, or else its name. \param usual  of standard output, and of a name
/// without a suffix
std::string format_of(const std::string& format, const std::filesystem::path& output, const char* usual);

}  // namespace bendy::cli
