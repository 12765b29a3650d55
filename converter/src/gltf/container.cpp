#include "container.h"

#include "failure.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <system_error>

namespace bendy::converter::gltf {
namespace {

constexpr std::size_t kHeaderSize = 12;
constexpr std::size_t kChunkHeaderSize = 8;
constexpr std::uint32_t kMagic = 0x46546c67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004e4942;   // "BIN\0"

std::uint32_t read_u32(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes[offset + i]) << (8 * i);
    return value;
}

std::string_view as_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void split_glb(Container& container) {
    const std::span<const std::byte> file = container.bytes;
    if (file.size() < kHeaderSize) {
        fail({}, "GLB header truncated: 12 bytes are due, the file has " + std::to_string(file.size()));
    }
    const std::uint32_t version = read_u32(file, 4);
    if (version != 2) {
        fail({}, "GLB container version " + std::to_string(version) + " is not supported, only version 2 (glTF 2.0)");
    }
    const std::size_t length = read_u32(file, 8);
    if (length > file.size()) {
        fail({}, "GLB truncated: its header says " + std::to_string(length) + " bytes, the file has " +
                     std::to_string(file.size()));
    }
    bool has_json = false;
    std::size_t offset = kHeaderSize;
    for (std::size_t chunk = 0; offset < length; ++chunk) {
        const std::string name = "GLB chunk " + std::to_string(chunk) + " at byte " + std::to_string(offset);
        if (length - offset < kChunkHeaderSize) fail({}, name + ": its header is truncated");
        const std::size_t size = read_u32(file, offset);
        const std::uint32_t type = read_u32(file, offset + 4);
        offset += kChunkHeaderSize;
        if (size > length - offset) {
            fail({}, name + ": it says " + std::to_string(size) + " bytes, only " + std::to_string(length - offset) +
                         " remain");
        }
        const auto data = file.subspan(offset, size);
        if (chunk == 0) {
            if (type != kJsonChunk) fail({}, name + ": the first chunk is not JSON");
            container.json = as_text(data);
            has_json = true;
        } else if (type == kBinChunk && !container.has_bin) {
            container.bin = data;
            container.has_bin = true;
        }
        offset += size;
    }
    if (!has_json) fail({}, "GLB without a JSON chunk");
    // The specification pads with spaces; some writers pad with zeros.
    while (!container.json.empty() && container.json.back() == '\0') container.json.remove_suffix(1);
}

}  // namespace

Container open_container(std::vector<std::byte> bytes) {
    Container container;
    container.bytes = std::move(bytes);
    if (container.bytes.empty()) fail({}, "the file is empty");
    container.is_glb = container.bytes.size() >= 4 && read_u32(container.bytes, 0) == kMagic;
    if (container.is_glb) {
        split_glb(container);
    } else {
        container.json = as_text(container.bytes);
    }
    return container;
}

}  // namespace bendy::converter::gltf
