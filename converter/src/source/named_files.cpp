#include "source/named_files.h"

#include "failure.h"
#include "source/image_bytes.h"

#include <system_error>

namespace bendy::converter {

std::filesystem::path NamedFiles::find(const std::string& uri, const std::string& place) const {
    const auto file = folders_.find(uri);
    if (file) return *file;
    switch (file.error()) {
        case LinkProblem::empty:
            fail(place, "the URI is empty");
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
        } catch (...) {
            known_.erase(known);
            throw;
        }
        budget_.add_source(contents.bytes.size());
    }
    if (limit <= contents.bytes.size()) return std::span(contents.bytes).first(static_cast<std::size_t>(limit));
    if (std::filesystem::file_size(file, error) == contents.bytes.size() || error) return contents.bytes;
    // A second buffer wants more of the file than the first did: all is read, so that no third time is needed.
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
        const std::string kind = media_type_of(bytes);
        if (!is_image(bytes))
            report_.warn("embedded file is not an image of a known kind: " + quote(file.filename().string()), place);
        report_.add_embedded({file, bytes.size(), kind});
    } catch (const Failure& failure) {
        report_.warn("image could not be read (" + failure.error.message + ')', place);
    }
}

}  // namespace bendy::converter
