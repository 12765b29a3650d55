#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// Why a URI in a file leads to no file that may be read.
enum class LinkProblem : std::uint8_t {
    empty,
    scheme,   ///< data, or another scheme than `file`
    no_name,  ///< holds a NUL, or the system refuses it as too long; on Windows also: is not UTF-8
    outside,  ///< of the folders
};

/// Whether a URI is the data itself, `data:...`; the scheme's letters may be of any case.
bool is_data_uri(std::string_view uri);

/// The file that a URI means: a relative one is relative to `folder`, file URIs and absolute paths are taken as they
/// are. A backslash is read as a slash, as browsers do. Percent-encoding is decoded where it is valid. The file need
/// not exist and may be anywhere.
Result<std::filesystem::path, LinkProblem> linked_file(std::string_view uri, const std::filesystem::path& folder);

/// Decides which files the names in a file may open: those in the file's own folder and the folders below it, and in
/// one more, the root, that the user names. A file counts as where it is, not where a symbolic link to it is. The
/// folder is that of the file's name as given, and that of the file which the name leads to, so that a folder of links
/// into another one, as build tools make, is as good as that one. In the root, links are followed wherever they lead.
class ReadableFolders {
public:
    /// For a file without a folder, such as standard input: only the root counts, and relative names start there. An
    /// empty root: no file may be read.
    explicit ReadableFolders(const std::filesystem::path& root = {});
    /// \param file  whose names are followed, relative to its folder \param root  may be empty
    static ReadableFolders of(const std::filesystem::path& file, const std::filesystem::path& root = {});

    /// The file that a URI in the file means, if it may be read; it need not exist. If there is no file of the decoded
    /// name, but one of the name as it stands, it is that one.
    [[nodiscard]] Result<std::filesystem::path, LinkProblem> find(std::string_view uri) const;
    /// Whether a file may be read. Looks at directories and links on the way, never at the file's content.
    [[nodiscard]] bool hold(const std::filesystem::path& file) const;

    /// What relative names start from; `.` for the working directory, empty if there is nothing.
    [[nodiscard]] const std::filesystem::path& start() const { return start_; }

private:
    std::filesystem::path start_;
    std::vector<std::filesystem::path> folders_;  ///< absolute, links resolved
    std::filesystem::path root_;                  ///< absolute, as given; may be empty
};

}  // namespace bendy
