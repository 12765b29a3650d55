#include <bendy/format/readable_folders.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>

namespace bendy {
namespace {

namespace fs = std::filesystem;

/// Decodes "a%20b" to "a b"; nothing if a percent sign has no two digits.
std::optional<std::string> percent_decoded(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] != '%') {
            decoded += text[at];
            continue;
        }
        unsigned byte = 0;
        const char* const digits = text.data() + at + 1;
        if (text.size() - at <= 2 || std::from_chars(digits, digits + 2, byte, 16).ptr != digits + 2)
            return std::nullopt;
        decoded += static_cast<char>(byte);
        at += 2;
    }
    return decoded;
}

/// Exporters on Windows write backslashes, and browsers read them as slashes.
std::string with_slashes(std::string_view uri) {
    std::string text(uri);
    std::replace(text.begin(), text.end(), '\\', '/');
    return text;
}

/// `scheme` in small letters; a URI's may be in any case.
bool has_scheme(std::string_view uri, std::string_view scheme) {
    const auto is_same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; };
    return uri.size() >= scheme.size() &&
           std::equal(scheme.begin(), scheme.end(), uri.begin(), [&](char b, char a) { return is_same(a, b); });
}

/// Returns a URI without its scheme, to be decoded: the file name in it.
Result<std::string_view, LinkProblem> name_in(std::string_view uri) {
    constexpr std::string_view kFile = "file://";
    if (uri.empty()) return LinkProblem::empty;
    if (has_scheme(uri, kFile)) {
        uri.remove_prefix(kFile.size());
        const bool has_drive = uri.size() > 2 && uri[0] == '/' && uri[2] == ':';
        if (has_drive) uri.remove_prefix(1);
        return uri;
    }
    const std::size_t colon = uri.find(':');
    if (colon != std::string_view::npos && uri.find('/') > colon) return LinkProblem::scheme;
    return uri;
}

Result<fs::path, LinkProblem> path_of(std::string_view name, const fs::path& folder) {
    constexpr bool kNamesAreUnicode = std::is_same_v<fs::path::value_type, wchar_t>;  // on Windows
    if (name.find('\0') != std::string_view::npos || (kNamesAreUnicode && !is_utf8(name))) return LinkProblem::no_name;
    const fs::path path(std::u8string(name.begin(), name.end()));
    if (path.has_root_path() || folder.empty() || folder == ".") return path;
    return folder / path;
}

/// Empty if it cannot be determined.
fs::path whole_name(const fs::path& path) {
    std::error_code error;
    fs::path whole = fs::absolute(path, error).lexically_normal();
    if (error) return {};
    return whole.has_filename() ? whole : whole.parent_path();
}

/// Resolves all links, and appends the part that does not exist; empty if it cannot be determined.
fs::path real_path(const fs::path& path) {
    std::error_code error;
    const fs::path whole = fs::absolute(path, error);
    if (error) return {};
    // Twice, because the nonexistent part is only normalised, which may leave the name of a link, as for
    // "none/../link".
    fs::path real = fs::weakly_canonical(whole, error);
    if (!error) real = fs::weakly_canonical(real, error);
    if (error) return {};
    return real.has_filename() ? real : real.parent_path();
}

bool is_below(const fs::path& path, const fs::path& folder) {
    if (folder.empty()) return false;
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

/// Returns the folder in a file's name; `.` if it has none.
fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

bool is_data_uri(std::string_view uri) {
    return has_scheme(uri, "data:");
}

Result<fs::path, LinkProblem> linked_file(std::string_view uri, const fs::path& folder) {
    if (is_data_uri(uri)) return LinkProblem::scheme;
    if (find_control(uri) != std::string_view::npos) return LinkProblem::control;
    const std::string text = with_slashes(uri);
    const auto name = name_in(text);
    if (!name) return name.error();
    return path_of(percent_decoded(*name).value_or(std::string(*name)), folder);
}

ReadableFolders::ReadableFolders(const fs::path& root) : start_(root) {
    if (root.empty()) return;
    root_ = whole_name(root);
    folders_.push_back(real_path(root));
}

ReadableFolders ReadableFolders::of(const fs::path& file, const fs::path& root) {
    ReadableFolders folders(root);
    folders.start_ = folder_of(file);
    folders.folders_.push_back(real_path(folders.start_));
    folders.folders_.push_back(real_path(file).parent_path());
    return folders;
}

Result<fs::path, LinkProblem> ReadableFolders::find(std::string_view uri) const {
    const auto decoded = linked_file(uri, start_);
    if (!decoded) return decoded.error();
    const auto name = name_in(uri);  // some files have a literal %20 or backslash in their names
    const auto literal = name ? path_of(*name, start_) : Result<fs::path, LinkProblem>(name.error());
    std::error_code ignored;
    if (literal && *literal != *decoded && hold(*literal) && fs::exists(*literal, ignored) &&
        !(hold(*decoded) && fs::exists(*decoded, ignored))) {
        return *literal;
    }
    if (hold(*decoded)) return *decoded;
    return real_path(*decoded).empty() ? LinkProblem::no_name : LinkProblem::outside;
}

bool ReadableFolders::hold(const fs::path& file) const {
    const fs::path name = whole_name(file);
    const auto shares_root = [&](const fs::path& folder) { return folder.root_name() == name.root_name(); };
    // Never looks at another drive: on Windows, a server's name would make the system send the user's credentials to
    // it.
    if (std::none_of(folders_.begin(), folders_.end(), shares_root) && !shares_root(root_)) return false;
    const fs::path real = real_path(file);
    if (std::any_of(folders_.begin(), folders_.end(), [&](const fs::path& folder) { return is_below(real, folder); }))
        return true;
    // A `..` after a link does not lead to the parent that the name shows.
    return is_below(name, root_) && real_path(name) == real;
}

}  // namespace bendy
