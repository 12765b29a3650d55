#pragma once

#include <cstdint>
#include <filesystem>

namespace bendy::converter {

/// What tells without reading a file whether it is still the same.
struct FileStamp {
    bool is_there = false;
    std::uint64_t size = 0;     ///< bytes
    std::int64_t modified = 0;  ///< ticks of the file system's clock, as std::filesystem counts them

    bool operator==(const FileStamp&) const = default;
};

/// Of the file as it is now; of one that cannot be seen: not there.
FileStamp stamp_of(const std::filesystem::path& file);

/// A file that a conversion has read, or has looked for in vain.
struct SourceFile {
    std::filesystem::path file;
    FileStamp stamp;  ///< from before it was read
};

}  // namespace bendy::converter
