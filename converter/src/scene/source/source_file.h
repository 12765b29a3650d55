#pragma once

#include "scene/failure.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/readable_folders.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter {

/// Limits the size of the decoded scene. A small hostile file can demand any amount: one accessor used by every
/// primitive, one mesh by every node, compressed or implied zeros. So everything that grows the result is charged here
/// first. The bytes exist in memory two or three times before the result is written: the limits keep the total within
/// 64 MiB plus a hundred times the source.
class Budget {
public:
    static constexpr std::uint64_t kFloor = std::uint64_t{24} << 20;  ///< bytes that any file may decode to
    static constexpr std::uint64_t kPerSourceByte = 32;               ///< above the floor, per byte of the source

    void add_source(std::uint64_t bytes) {
        source_ += std::min(bytes, UINT64_MAX - source_);
        const std::uint64_t room = UINT64_MAX - left_;
        left_ += bytes <= room / kPerSourceByte ? bytes * kPerSourceByte : room;
    }

    [[nodiscard]] std::uint64_t source_bytes() const { return source_; }

    /// Charges `count` elements of `size` bytes, or fails at `place`.
    void take(std::uint64_t count, std::uint64_t size, const std::string& place) {
        if (size != 0 && count > left_ / size) fail(place, "the decoded data would be implausibly large");
        left_ -= count * size;
    }

private:
    std::uint64_t source_ = 0;
    std::uint64_t left_ = kFloor;
};

/// Reads all bytes of a regular file, at most `limit` of them. Fails at `place`.
std::vector<std::byte> read_file(const std::filesystem::path& file, const std::string& place,
                                 std::uint64_t limit = UINT64_MAX);

/// Decodes percent escapes; nothing if a `%` is not followed by two hexadecimal digits.
std::optional<std::string> percent_decode(std::string_view text);

struct DataUri {
    std::string media_type;  ///< without parameters, may be empty
    std::vector<std::byte> bytes;
};

/// Decodes a data URI (RFC 2397), base64 or percent-encoded. `uri` must be one. Fails at `place`.
DataUri decode_data_uri(std::string_view uri, const std::string& place);

/// The readable folders for bytes without a file: with a name that has no folder, only the root.
ReadableFolders folders_of_bytes(const std::filesystem::path& name, const std::filesystem::path& root);

/// The message for a name that `folders` do not allow, with the option that allows it.
std::string why_outside(const ReadableFolders& folders, std::string_view uri);

/// A source's URI with its control characters percent-encoded, which no URI may hold: programs on the web leave some of
/// them out before they look where the URI leads. Warns at `place` if there are any.
std::string without_controls(std::string_view uri, const std::string& place, Report& report);

/// A relative path as a URI, percent-encoded where necessary.
std::string uri_of(const std::filesystem::path& path);

/// The URI by which the file `from` refers to another: relative, or a file URI if no relative path exists (another
/// drive).
std::string uri_between(const std::filesystem::path& from, const std::filesystem::path& file);

/// Converts to UTF-8: text that is not UTF-8 is taken for Latin-1.
std::string to_utf8(std::string_view text);
/// As above, for a name: a warning tells of one that is not UTF-8.
std::string to_utf8(std::string_view text, const std::string& place, Report& report);

/// Rewrites links to images, which are relative to the folder of `from`, to be relative to that of `to`:
/// percent-encoded, with forward slashes; as a file URI if no relative path exists (another drive). Between files of
/// one folder, links without a backslash are unchanged, as are absolute ones and all with a scheme. Warns of links to
/// files that do not exist, and of those that lead out of the folder, which the viewer does not follow; files that
/// `folders`, those of `from`, do not allow are not looked for.
void move_links(Scene& scene, const std::filesystem::path& from, const std::filesystem::path& to,
                const ReadableFolders& folders, Report& report);

}  // namespace bendy::converter
