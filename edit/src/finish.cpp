#include "finish.h"

#include <bendy/format/chunk_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace bendy::edit {
namespace {

VersionRecord counted(VersionRecord version, const Document& document) {
    version.objects = static_cast<std::uint32_t>(document.objects.size());
    version.materials = static_cast<std::uint32_t>(document.materials.size());
    version.textures = static_cast<std::uint32_t>(document.textures.size());
    version.joints = version.meshes = version.clips = 0;
    version.vertices = 0;
    for (const ObjectView& object : document.objects) {
        version.joints += static_cast<std::uint32_t>(object.skeleton.joints.size());
        version.meshes += static_cast<std::uint32_t>(object.meshes.size());
        version.clips += static_cast<std::uint32_t>(object.clips.size());
        for (const MeshView& mesh : object.meshes) version.vertices += mesh.vertices;
    }
    return version;
}

Problem broken(const Error& fault, Bytes file) {
    return {"the result would not be valid: " + describe_with_place(fault, file)};
}

}  // namespace

Edited finish(const Rewrite& rewrite) {
    Buffer file = rewrite.write();
    auto tree = read_chunk_tree(file);
    if (!tree) return broken(tree.error(), file);
    decode_leaves(*tree);
    Faults faults;
    const Document document = read_document(*tree, faults);
    if (!faults.empty()) return broken(faults.list().front(), file);
    const VersionRecord version = counted(*document.version, document);
    if (std::memcmp(&version, &*document.version, sizeof version) != 0) {
        const std::uint32_t chunk = tree->find(0, FourCC("VERS"));
        const Bytes before = tree->payload(chunk);
        Buffer payload(before.begin(), before.end());
        std::memcpy(payload.data(), &version, std::min(payload.size(), sizeof version));
        Rewrite renewed(*tree);
        renewed.replace(chunk, payload);
        file = renewed.write();
    }
    if (const Faults found = validate(file); !found.empty()) return broken(found.list().front(), file);
    return file;
}

}  // namespace bendy::edit
