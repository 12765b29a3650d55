#include <bendy/converter/linked_file.h>

#include "failure.h"
#include "source/uri.h"

#include <exception>
#include <string>

namespace bendy::converter {

std::optional<std::filesystem::path> linked_file(std::string_view uri, const std::filesystem::path& file) {
    constexpr std::string_view kFile = "file://";
    try {
        if (!uri.starts_with(kFile) && !uri.starts_with('/')) return resolve_uri(std::string(uri), file, {});
        std::string_view path = uri;
        if (uri.starts_with(kFile)) path.remove_prefix(kFile.size());
        const bool has_drive = path.size() > 2 && path[0] == '/' && path[2] == ':';
        if (has_drive) path.remove_prefix(1);
        const std::string name = percent_decode(path).value_or(std::string(path));
        return std::filesystem::path(std::u8string(name.begin(), name.end()));
    } catch (const Failure&) {  // of another scheme, or no name of a file
        return std::nullopt;
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

}  // namespace bendy::converter
