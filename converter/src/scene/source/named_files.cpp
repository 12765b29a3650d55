#include "scene/source/named_files.h"

#include "scene/failure.h"
#include "scene/source/image_bytes.h"

#include <bendy/converter/source_format.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace bendy::converter {
namespace {

constexpr std::uint64_t kBeginning = 64;  ///< bytes that suffice to recognise an image

/// A file name as written on Windows: backslashes, doubled ones, often an absolute path.
std::filesystem::path relative_path_of(const std::string& name) {
    std::string path = to_utf8(name);
    std::replace(path.begin(), path.end(), '\\', '/');
    const bool is_absolute = path.starts_with('/') || path.find(':') != std::string::npos;
    if (is_absolute) path.erase(0, path.find_last_of("/:") + 1);
    return std::filesystem::path(std::u8string(path.begin(), path.end())).lexically_normal();
}

}  // namespace

std::filesystem::path NamedFiles::find(const std::string& uri, const std::string& place) const {
    const auto file = folders_.find(uri);
    if (file) return *file;
    switch (file.error()) {
        case LinkProblem::empty:
            fail(place, "the URI is empty");
        case LinkProblem::control:
            fail(place, "a URI has no control characters; percent-encode those of " + quote(uri));
        case LinkProblem::scheme:
            fail(place, "only files beside the source and data URIs are read, not " + quote(uri));
        case LinkProblem::no_name:
            fail(place, "no file can have the name " + quote(uri));
        case LinkProblem::outside:
            break;
    }
    fail(place, why_outside(folders_, uri));
}

std::span<const std::byte> NamedFiles::read(const std::string& uri, const std::string& place, std::uint64_t limit) {
    return read_found(find(uri, place), place, limit);
}

std::span<const std::byte> NamedFiles::read_found(const std::filesystem::path& file, const std::string& place,
                                                  std::uint64_t limit) {
    report_.add_source(file);
    std::error_code error;
    const std::filesystem::path real = std::filesystem::canonical(file, error);
    const auto [known, is_new] = known_.try_emplace(error ? file : real);
    Contents& contents = known->second;
    if (is_new) {
        try {
            contents.bytes = read_file(file, place, limit);
            if (const auto kind = find_stand_in(contents.bytes)) {
                fail(place, "file " + quote(file.filename().string()) + " is " + std::string(kind->name) + ": " +
                                std::string(kind->way_in));
            }
        } catch (...) {
            known_.erase(known);
            throw;
        }
        budget_.add_source(contents.bytes.size());
    }
    if (limit <= contents.bytes.size()) return std::span(contents.bytes).first(static_cast<std::size_t>(limit));
    if (std::filesystem::file_size(file, error) == contents.bytes.size() || error) return contents.bytes;
    // A second buffer needs more of the file than the first: read it completely, which avoids a third read.
    if (contents.whole.empty()) {
        contents.whole = read_file(file, place);
        budget_.add_source(contents.whole.size() - std::min(contents.whole.size(), contents.bytes.size()));
    }
    return std::span(contents.whole)
        .first(static_cast<std::size_t>(std::min<std::uint64_t>(limit, contents.whole.size())));
}

bool NamedFiles::exists(const std::string& uri, const std::string& place) {
    const std::filesystem::path file = find(uri, place);
    report_.add_source(file);
    std::error_code ignored;
    return std::filesystem::exists(file, ignored);
}

void NamedFiles::embed(Image& image, const std::string& place) {
    try {
        const std::filesystem::path file = find(image.uri, place);
        const std::span<const std::byte> bytes = read_found(file, place, UINT64_MAX);
        budget_.take(bytes.size(), 1, place);
        image.bytes.assign(bytes.begin(), bytes.end());
        image.uri.clear();
        note_embedded(file, bytes, place);
    } catch (const Failure& failure) {
        report_.warn("image could not be read (" + failure.error.message + ')', place);
    }
}

void NamedFiles::embed_given(Image& image, const std::filesystem::path& file) {
    try {
        const std::span<const std::byte> bytes = read_found(file, {}, UINT64_MAX);
        budget_.take(bytes.size(), 1, {});
        image.bytes.assign(bytes.begin(), bytes.end());
        note_embedded(file, image.bytes, {});
    } catch (Failure& failure) {
        failure.error.file = file;
        throw;
    }
}

void NamedFiles::check_given(const std::filesystem::path& file) {
    try {
        read_found(file, {}, kBeginning);
    } catch (Failure& failure) {
        failure.error.file = file;
        throw;
    }
}

void NamedFiles::note_embedded(const std::filesystem::path& file, std::span<const std::byte> bytes,
                               const std::string& place) {
    if (!is_image(bytes))
        report_.warn("embedded file is not an image of a known kind: " + quote(file.filename().string()), place);
    report_.add_embedded({file, bytes.size(), media_type_of(bytes)});
}

std::string NamedFiles::find_texture(const std::string& name) {
    const std::filesystem::path named = relative_path_of(name);
    std::vector<std::filesystem::path> candidates{named};
    if (searches_left_ > 0) {
        --searches_left_;
        if (named.has_parent_path() && named.has_filename()) candidates.push_back(named.filename());
        for (std::size_t i = 0, names = candidates.size(); i < names; ++i) {
            for (const ImageKind& kind : image_kinds())
                candidates.push_back(std::filesystem::path(candidates[i]).replace_extension(kind.suffix));
        }
    }
    std::string other;  // a file that is not an image
    for (const std::filesystem::path& candidate : candidates) {
        std::string uri = uri_of(candidate);
        try {
            if (is_image(read(uri, {}, kBeginning))) return uri;
            if (other.empty()) other = std::move(uri);
        } catch (const Failure&) {
            continue;  // does not exist, or may not be read
        }
    }
    return other.empty() ? uri_of(named) : other;
}

}  // namespace bendy::converter
