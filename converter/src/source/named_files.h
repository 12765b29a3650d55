#pragma once

#include "source/source_file.h"

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

/// The files that a source names, wherever a format does so: the only way from a name to bytes. It opens what
/// ReadableFolders allow, reads each file once however often it is named, and gives the budget what it has read.
class NamedFiles {
public:
    /// `budget` and `report` must outlive this.
    NamedFiles(ReadableFolders folders, Budget& budget, Report& report)
        : folders_(std::move(folders)), budget_(budget), report_(report) {}

    /// The file's first bytes, at most `limit` of them; valid while this lives. Fails at `place` if there is no such
    /// file, or it may not be read.
    std::span<const std::byte> read(const std::string& uri, const std::string& place, std::uint64_t limit = UINT64_MAX);
    /// Whether there is such a file, and it may be read. Notes that it was looked for.
    bool exists(const std::string& uri, const std::string& place);

    /// Gives an image the bytes of the file that its URI names, in place of the URI, and names that file in the report.
    /// If the file cannot be read, the URI stays and a warning says why: a character converts without it.
    void embed(Image& image, const std::string& place);

    /// As embed, of a file that the user names: it may be anywhere. Fails at no place, naming the file, if it cannot be
    /// read.
    void embed_given(Image& image, const std::filesystem::path& file);
    /// Fails as embed_given does.
    void check_given(const std::filesystem::path& file);

    /// The URI of the image that an older model calls `name`: often a path of another computer, or a name from before
    /// the image was converted. Tries the name, its last part alone, and both with the suffixes of image_kinds, and
    /// prefers a file that begins as an image does. If there is no file, it is the URI of the name itself.
    std::string find_texture(const std::string& name);

private:
    struct Contents {
        std::vector<std::byte> bytes;  ///< all, or its first ones
        std::vector<std::byte> whole;  ///< of a file of which more was wanted later
    };

    std::filesystem::path find(const std::string& uri, const std::string& place) const;
    /// Of the bytes of a file that go into the result.
    void note_embedded(const std::filesystem::path& file, std::span<const std::byte> bytes, const std::string& place);
    std::span<const std::byte> read_found(const std::filesystem::path& file, const std::string& place,
                                          std::uint64_t limit);

    ReadableFolders folders_;
    Budget& budget_;
    Report& report_;
    std::map<std::filesystem::path, Contents> known_;  ///< by the path without links
    std::size_t searches_left_ = 100;                  ///< for other names than the source's; it may name millions
};

}  // namespace bendy::converter
