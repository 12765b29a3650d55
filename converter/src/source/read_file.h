#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace bendy::converter {

/// All bytes of a regular file, at most `limit` of them. Fails at `place`.
std::vector<std::byte> read_file(const std::filesystem::path& file, const std::string& place,
                                 std::uint64_t limit = UINT64_MAX);

}  // namespace bendy::converter
