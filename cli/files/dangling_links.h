#pragma once

#include <bendy/format/byte_reader.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace bendy::cli {

/// A LINK to an image file that does not exist.
struct DanglingLink {
    std::uint64_t offset = 0;  ///< of the chunk
    std::string uri;
};

/// Of a file's bytes, which links are relative to its folder. Data URIs and other schemes are not looked at; of bytes
/// that cannot be read, nothing.
std::vector<DanglingLink> find_dangling_links(const std::filesystem::path& file, Bytes bytes);

}  // namespace bendy::cli
