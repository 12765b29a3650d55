#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// Why a URI in a file does not lead to a readable file.
enum class LinkProblem : std::uint8_t {
    empty,
    control,  ///< holds a control character, which other programs leave out before they look where the URI leads
    scheme,   ///< data, or another scheme than `file`
    no_name,  ///< holds an encoded NUL, or the system refuses it as too long; on Windows also: is not UTF-8
    outside,  ///< outside the folders
};

/// Returns true if a URI contains the data itself, `data:...`; the scheme is not case-sensitive.
bool is_data_uri(std::string_view uri);

/// Returns the file that a URI refers to: a relative one is relative to `folder`, file URIs and absolute paths are used
/// unchanged. A backslash counts as a slash, as in browsers. Percent-encoding is decoded where it is valid. The file
/// need not exist and may be anywhere.
Result<std::filesystem::path, LinkProblem> linked_file(std::string_view uri, const std::filesystem::path& folder);

/// Decides which files the names in a file may open: those in the file's own folder and its subfolders, and in one
/// more, the root, that the user names. A file's actual location counts, not that of a symbolic link to it. The folder
/// is the one in the file's name as given, and the one of the file that the name leads to: build tools make folders of
/// links into other folders, and these must work. In the root, links are followed wherever they lead.
class ReadableFolders {
public:
    /// For a file without a folder, such as standard input: only the root counts, and relative names start there. If
    /// the root is empty, no file may be read.
    explicit ReadableFolders(const std::filesystem::path& root = {});
    /// \param file  the file whose names are resolved, relative to its folder \param root  may be empty
    static ReadableFolders of(const std::filesystem::path& file, const std::filesystem::path& root = {});

    /// Returns the file that a URI in the file refers to, if it may be read; it need not exist. If only a file with the
    /// undecoded name exists, returns that file.
    [[nodiscard]] Result<std::filesystem::path, LinkProblem> find(std::string_view uri) const;
    /// Returns true if a file may be read. Examines directories and links on the way, never the file's content.
    [[nodiscard]] bool hold(const std::filesystem::path& file) const;

    /// The base of relative names; `.` for the working directory, empty if there is none.
    [[nodiscard]] const std::filesystem::path& start() const { return start_; }

private:
    std::filesystem::path start_;
    std::vector<std::filesystem::path> folders_;  ///< absolute, links resolved
    std::filesystem::path root_;                  ///< absolute, as given; may be empty
};

}  // namespace bendy
