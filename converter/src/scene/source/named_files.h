#pragma once

#include "scene/source/source_file.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/readable_folders.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace bendy::converter {

/// The files that a source names, in any format: the only way from a name to bytes. Opens only files that
/// ReadableFolders allow, reads each file once however often it is named, and adds its size to the budget.
class NamedFiles {
public:
    /// `budget` and `report` must outlive this.
    NamedFiles(ReadableFolders folders, Budget& budget, Report& report)
        : folders_(std::move(folders)), budget_(budget), report_(report) {}

    /// The file's first bytes, at most `limit` of them; valid while this lives. Fails at `place` if the file does not
    /// exist or may not be read.
    std::span<const std::byte> read(const std::string& uri, const std::string& place, std::uint64_t limit = UINT64_MAX);
    /// Whether the file exists and may be read. Notes that it was looked for.
    bool exists(const std::string& uri, const std::string& place);

    /// Replaces an image's URI with the bytes of that file, and names the file in the report. If it cannot be read, the
    /// URI stays, with a warning: a character is converted without it.
    void embed(Image& image, const std::string& place);

    /// Like embed, for a file that the user names, which may be anywhere. Fails with an empty place, naming the file,
    /// if it cannot be read.
    void embed_given(Image& image, const std::filesystem::path& file);
    /// Fails as embed_given does.
    void check_given(const std::filesystem::path& file);

    /// The URI of the image that an older model calls `name`: often a path on another computer, or a name from before
    /// the image was converted. Tries the name, its last component, and both with the suffixes of image_kinds,
    /// preferring a file that begins like an image. If no file exists, returns the URI of the name itself.
    std::string find_texture(const std::string& name);

private:
    struct Contents {
        std::vector<std::byte> bytes;  ///< all, or only the first ones
        std::vector<std::byte> whole;  ///< of a file that was read partially before
    };

    std::filesystem::path find(const std::string& uri, const std::string& place) const;
    /// Notes that a file's bytes go into the result.
    void note_embedded(const std::filesystem::path& file, std::span<const std::byte> bytes, const std::string& place);
    std::span<const std::byte> read_found(const std::filesystem::path& file, const std::string& place,
                                          std::uint64_t limit);

    ReadableFolders folders_;
    Budget& budget_;
    Report& report_;
    std::map<std::filesystem::path, Contents> known_;  ///< by the path without links
    std::size_t searches_left_ = 100;                  ///< for names other than the source's, which may be millions
};

}  // namespace bendy::converter
