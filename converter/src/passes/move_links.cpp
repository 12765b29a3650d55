#include "passes/move_links.h"

#include "failure.h"
#include "source/source_file.h"

#include <bendy/converter/linked_file.h>

#include <exception>
#include <string>
#include <system_error>

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

namespace {

std::filesystem::path folder_of(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    auto canonical = std::filesystem::weakly_canonical(std::filesystem::absolute(folder, error), error);
    return error ? folder.lexically_normal() : canonical;
}

std::string uri_between(const std::filesystem::path& folder, const std::filesystem::path& file) {
    const std::filesystem::path target = folder_of(file) / file.filename();
    const std::filesystem::path relative = target.lexically_relative(folder);
    if (!relative.empty()) return uri_of(relative);
    return "file:///" + target.root_name().generic_string() + uri_of(target.root_directory() / target.relative_path());
}

}  // namespace

void move_links(Scene& scene, const std::filesystem::path& from, const std::filesystem::path& to, Report& report) {
    const std::filesystem::path source = folder_of(from);
    const std::filesystem::path folder = folder_of(to);
    for (std::size_t i = 0; i < scene.images.size(); ++i) {
        Image& image = scene.images[i];
        if (!image.bytes.empty() || image.uri.empty()) continue;
        const std::string place = at("images", i);
        const auto file = linked_file(image.uri, from);
        if (!file) continue;  // http, for one
        std::error_code ignored;
        if (!std::filesystem::exists(*file, ignored))
            report.warn("linked image does not exist: " + quote(image.uri), place);
        const bool is_relative = !image.uri.starts_with('/') && !image.uri.starts_with("file:");
        if (source != folder && is_relative) image.uri = uri_between(folder, *file);
        if (image.uri.starts_with("../")) {
            report.warn("link to an image leads out of the output's folder, where the viewer does not follow it: " +
                            quote(image.uri),
                        place);
        }
    }
}

}  // namespace bendy::converter
