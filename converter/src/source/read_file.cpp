#include "read_file.h"

#include "failure.h"

#include <algorithm>
#include <fstream>
#include <system_error>

namespace bendy::converter {

std::vector<std::byte> read_file(const std::filesystem::path& file, const std::string& place, std::uint64_t limit) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) fail(place, "file not found: " + quote(file.filename().string()));
    // A device or a pipe behind a relative URI would have no end.
    if (!std::filesystem::is_regular_file(status))
        fail(place, "not a regular file: " + quote(file.filename().string()));
    const std::uint64_t size = std::filesystem::file_size(file, error);
    std::ifstream stream(file, std::ios::binary);
    if (error || !stream) fail(place, "cannot read file " + quote(file.filename().string()));
    std::vector<std::byte> bytes(static_cast<std::size_t>(std::min(size, limit)));
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (static_cast<std::size_t>(stream.gcount()) != bytes.size()) {
        fail(place, "cannot read file " + quote(file.filename().string()));
    }
    return bytes;
}

}  // namespace bendy::converter
