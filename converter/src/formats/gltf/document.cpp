#include "document.h"

#include "meshopt.h"
#include "scene/failure.h"

#include <string>
#include <utility>

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
        fail({}, "the GLB header is truncated: expected 12 bytes, found " + std::to_string(file.size()));
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
    // The specification pads with spaces; some writers use NULs.
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

namespace {

std::uint64_t unsigned_of(const Json& object, const char* key, std::uint64_t fallback = 0) {
    const Json* value = find(object, key);
    return value == nullptr ? fallback : value->get<std::uint64_t>();
}

/// The extension object that compresses a view, or null; appends its name to `place`.
const Json* find_compression(const Json& view, std::string& place) {
    const Json* extensions = find(view, "extensions");
    if (extensions == nullptr || !extensions->is_object()) return nullptr;
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        if (const Json* compression = find(*extensions, name); compression != nullptr) {
            place += std::string(".extensions.") + name;
            return compression;
        }
    }
    return nullptr;
}

bool is_fallback(const Json& buffer) {
    const Json* extensions = find(buffer, "extensions");
    if (extensions == nullptr || !extensions->is_object()) return false;
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        const Json* extension = find(*extensions, name);
        if (extension == nullptr || !extension->is_object()) continue;
        const Json* fallback = find(*extension, "fallback");
        if (fallback != nullptr && *fallback == true) return true;
    }
    return false;
}

}  // namespace

Buffers::Buffers(const Json& root, const Container& container, NamedFiles& files) {
    const Json& buffers = array_of(root, "buffers");
    buffers_.resize(buffers.size());
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const std::string place = at("buffers", i);
        const auto length = buffers[i]["byteLength"].get<std::uint64_t>();
        Buffer& buffer = buffers_[i];
        if (const Json* uri = find(buffers[i], "uri"); uri != nullptr) {
            const auto& text = uri->text();
            if (is_data_uri(text)) {
                buffer.owned = decode_data_uri(text, place + ".uri").bytes;
                buffer.bytes = buffer.owned;
            } else {
                if (is_fallback(buffers[i]) && !files.exists(text, place + ".uri")) continue;
                buffer.bytes = files.read(text, place + ".uri", length);
            }
        } else if (const Json* chunk = find(buffers[i], "chunk"); chunk != nullptr && *chunk != 1) {
            fail(place + ".chunk", "the buffer is in chunk " + chunk->dump() +
                                       " of a file of glTF 2.1; only chunk 1, the first after the JSON, is read");
        } else if (i == 0 && container.has_bin) {
            buffer.bytes = container.bin;
        } else {
            continue;
        }
        if (length > buffer.bytes.size()) {
            fail(place + ".byteLength",
                 "expected " + std::to_string(length) + " bytes, found only " + std::to_string(buffer.bytes.size()));
        }
        buffer.bytes = buffer.bytes.first(static_cast<std::size_t>(length));
        buffer.has_data = true;
    }

    const Json& views = array_of(root, "bufferViews");
    views_.resize(views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
        View& view = views_[i];
        view.buffer = views[i]["buffer"].get<std::size_t>();
        view.offset = unsigned_of(views[i], "byteOffset");
        view.length = unsigned_of(views[i], "byteLength");
        if (const Json* stride = find(views[i], "byteStride"); stride != nullptr)
            view.stride = stride->get<std::size_t>();
        const auto available = buffers[view.buffer]["byteLength"].get<std::uint64_t>();
        if (view.offset > available || view.length > available - view.offset) {
            fail(at("bufferViews", i), "bytes " + std::to_string(view.offset) + " to " +
                                           std::to_string(view.offset + view.length) + " exceed buffer " +
                                           std::to_string(view.buffer) + " of " + std::to_string(available));
        }
        std::string place = at("bufferViews", i);
        if (const Json* json = find_compression(views[i], place); json != nullptr) {
            CompressedView& compressed = view.compressed.emplace();
            compressed.buffer = (*json)["buffer"].get<std::size_t>();
            compressed.offset = unsigned_of(*json, "byteOffset");
            compressed.length = unsigned_of(*json, "byteLength");
            compressed.stride = (*json)["byteStride"].get<std::size_t>();
            compressed.count = (*json)["count"].get<std::size_t>();
            compressed.mode = (*json)["mode"].get<std::string>();
            const Json* filter = find(*json, "filter");
            compressed.filter = filter == nullptr ? "NONE" : filter->get<std::string>();
            compressed.place = std::move(place);
            if (!view.stride) view.stride = compressed.stride;
        }
    }
}

std::span<const std::byte> Buffers::slice(std::size_t buffer, std::uint64_t offset, std::uint64_t length,
                                          const std::string& place) const {
    const Buffer& source = buffers_[buffer];
    if (!source.has_data) fail(at("buffers", buffer), "it has no data (read by " + place + ")");
    if (offset > source.bytes.size() || length > source.bytes.size() - offset) {
        fail(place,
             "it exceeds buffer " + std::to_string(buffer) + " of " + std::to_string(source.bytes.size()) + " bytes");
    }
    return source.bytes.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

std::span<const std::byte> Buffers::view(std::size_t index, Budget& budget) {
    View& view = views_[index];
    if (!view.compressed) return slice(view.buffer, view.offset, view.length, at("bufferViews", index));
    if (!view.is_decoded) {
        const CompressedView& compressed = *view.compressed;
        // The extension requires count * byteStride bytes; some writers round the view up to 4.
        const std::uint64_t decoded = std::uint64_t{compressed.count} * compressed.stride;
        if (decoded > view.length || view.length - decoded > 3) {
            fail(compressed.place, "count * byteStride is " + std::to_string(decoded) +
                                       " bytes, the view's byteLength " + std::to_string(view.length));
        }
        const auto source = slice(compressed.buffer, compressed.offset, compressed.length, compressed.place);
        view.decoded = decode_meshopt(compressed, source, budget);
        view.is_decoded = true;
    }
    return view.decoded;
}

std::optional<std::size_t> Buffers::stride(std::size_t index) const {
    return views_[index].stride;
}

}  // namespace bendy::converter::gltf
