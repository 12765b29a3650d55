#include "meshes.h"

#include "display_colour.h"
#include "failure.h"
#include "mirror.h"
#include "source/influences.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace bendy::converter::x {
namespace {

/// Which position and normal each vertex has, and the vertex of each corner.
struct Vertices {
    std::vector<std::uint32_t> positions;
    std::vector<std::uint32_t> normals;  ///< or none
    std::vector<std::uint32_t> corners;
};

std::vector<std::uint32_t> count_up(std::size_t count) {
    std::vector<std::uint32_t> numbers(count);
    for (std::uint32_t i = 0; i < count; ++i) numbers[i] = i;
    return numbers;
}

/// Positions and normals have numbers of their own in an X-file. Where they agree, which is what most files do,
/// vertices keep their numbers; else each pair that a corner has becomes one.
Vertices find_vertices(const Mesh& mesh) {
    Vertices vertices;
    const bool is_plain =
        mesh.normals.empty() || (mesh.normal_corners == mesh.corners && mesh.normals.size() == mesh.positions.size());
    if (is_plain) {
        vertices.positions = count_up(mesh.positions.size());
        if (!mesh.normals.empty()) vertices.normals = vertices.positions;
        vertices.corners = mesh.corners;
        return vertices;
    }
    std::unordered_map<std::uint64_t, std::uint32_t> known;
    vertices.corners.reserve(mesh.corners.size());
    for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
        const std::uint64_t pair = std::uint64_t{mesh.corners[i]} << 32 | mesh.normal_corners[i];
        const auto [vertex, is_new] = known.try_emplace(pair, static_cast<std::uint32_t>(vertices.positions.size()));
        if (is_new) {
            vertices.positions.push_back(mesh.corners[i]);
            vertices.normals.push_back(mesh.normal_corners[i]);
        }
        vertices.corners.push_back(vertex->second);
    }
    return vertices;
}

template <int N>
Stream stream_of(const std::vector<glm::vec<N, float>>& source, const Vertices& vertices) {
    Stream stream;
    stream.components = N;
    for (const std::uint32_t position : vertices.positions) {
        for (int i = 0; i < N; ++i) stream.values.push_back(source[position][i]);
    }
    return stream;
}

class MeshImporter {
public:
    MeshImporter(const XFile& file, const FrameIndex& frames, Budget& budget, Scene& scene, Report& report)
        : frames_(frames), budget_(budget), scene_(scene), report_(report) {
        for (std::uint32_t i = 0; i < file.materials.size(); ++i)
            material_of_.try_emplace(file.materials[i].identifier, i);
    }

    void import(const Mesh& source) {
        converter::Mesh mesh;
        mesh.name = source.name;
        mesh.joint = source.frame;
        const Vertices vertices = find_vertices(source);
        mesh.parts = make_parts(source, vertices);
        if (mesh.parts.empty()) {
            report_.warn("a mesh that draws nothing is left out", source.place);
            return;
        }
        for (const std::uint32_t position : vertices.positions)
            mesh.positions.push_back(mirrored(source.positions[position]));
        for (const std::uint32_t normal : vertices.normals) mesh.normals.push_back(mirrored(source.normals[normal]));
        if (!source.coords.empty()) mesh.texture_coords.push_back(stream_of(source.coords, vertices));
        if (!source.colours.empty()) {
            std::vector<glm::vec4> colours(source.colours);
            for (glm::vec4& colour : colours) colour = to_light(colour);
            mesh.colours.push_back(stream_of(colours, vertices));
        }
        add_influences(source, vertices, mesh);
        if (mesh.joint == kNone && mesh.influences == 0) mesh.joint = add_joint(source);
        scene_.meshes.push_back(std::move(mesh));
    }

private:
    [[nodiscard]] std::uint32_t material_of(const MaterialSlot& slot) const {
        if (slot.material != kNone) return slot.material;
        const auto found = material_of_.find(slot.identifier);
        if (found != material_of_.end()) return found->second;
        report_.warn("faces are left without a material: " + quote(slot.identifier) + " does not exist", slot.place);
        return kNone;
    }

    /// Triangles by material. A face's first corner stays the first; the others go the other way round, as the mirror
    /// turns outside in.
    [[nodiscard]] std::vector<Part> make_parts(const Mesh& source, const Vertices& vertices) const {
        std::vector<Part> parts(std::max<std::size_t>(source.slots.size(), 1));
        for (std::size_t slot = 0; slot < source.slots.size(); ++slot)
            parts[slot].material = material_of(source.slots[slot]);
        std::size_t first = 0;
        std::uint64_t thin = 0;
        for (std::size_t face = 0; face < source.face_sizes.size(); ++face) {
            const std::uint32_t size = source.face_sizes[face];
            Part& part = parts[source.face_slots.empty() ? 0 : source.face_slots[face]];
            const std::uint32_t* const corners = vertices.corners.data() + first;
            for (std::uint32_t corner = 1; corner + 1 < size; ++corner)
                part.indices.insert(part.indices.end(), {corners[0], corners[corner + 1], corners[corner]});
            thin += size < 3 ? 1 : 0;
            first += size;
        }
        if (thin != 0) report_.warn("face of fewer than three corners left out", source.place, thin);
        std::erase_if(parts, [](const Part& part) { return part.indices.empty(); });
        return parts;
    }

    /// Those of frames that exist.
    [[nodiscard]] std::vector<const Skin*> find_skins(const Mesh& source) const {
        std::vector<const Skin*> skins;
        for (const Skin& skin : source.skins) {
            if (frames_.find(skin.frame) != kNone) {
                skins.push_back(&skin);
            } else {
                report_.warn("SkinWeights left out: their frame " + quote(skin.frame) + " does not exist", skin.place);
            }
        }
        return skins;
    }

    void add_influences(const Mesh& source, const Vertices& vertices, converter::Mesh& mesh) {
        std::vector<std::uint32_t> used(source.positions.size());  // weights of each position
        const std::vector<const Skin*> skins = find_skins(source);
        if (skins.empty()) return;
        for (const Skin* skin : skins) {
            for (const std::uint32_t position : skin->vertices) ++used[position];
        }
        const std::size_t most = std::max<std::size_t>(1, *std::max_element(used.begin(), used.end()));
        if (most > kMaxInfluences)
            fail(source.place, "a vertex has more than " + std::to_string(kMaxInfluences) + " weights");
        budget_.take((source.positions.size() + 2 * vertices.positions.size()) * most, 8, source.place);

        Influences all{most, {}, {}};
        all.bones.resize(source.positions.size() * most);
        all.weights.resize(all.bones.size());
        std::fill(used.begin(), used.end(), 0);
        for (std::uint32_t bone = 0; bone < skins.size(); ++bone) {
            const Skin& skin = *skins[bone];
            mesh.palette.joints.push_back(frames_.find(skin.frame));
            mesh.palette.inverse_bind.push_back(to_floats(mirrored(skin.offset), skin.place));
            for (std::size_t i = 0; i < skin.vertices.size(); ++i) {
                const std::size_t place = skin.vertices[i] * most + used[skin.vertices[i]]++;
                all.bones[place] = bone;
                all.weights[place] = skin.weights[i];
            }
        }
        normalise_influences(all, source.place, report_);
        mesh.influences = static_cast<std::uint32_t>(most);
        for (const std::uint32_t position : vertices.positions) {
            const auto first = static_cast<std::ptrdiff_t>(position * most);
            const auto last = first + static_cast<std::ptrdiff_t>(most);
            mesh.bones.insert(mesh.bones.end(), all.bones.begin() + first, all.bones.begin() + last);
            mesh.weights.insert(mesh.weights.end(), all.weights.begin() + first, all.weights.begin() + last);
        }
        trim_influences(mesh);
    }

    std::uint32_t add_joint(const Mesh& source) {
        if (scene_.joints.size() == kMaxJoints) {
            fail(source.place,
                 "there are more than " + std::to_string(kMaxJoints) + " frames and meshes outside of them");
        }
        Joint joint;
        joint.name = source.name;
        scene_.joints.push_back(std::move(joint));
        return static_cast<std::uint32_t>(scene_.joints.size() - 1);
    }

    const FrameIndex& frames_;
    Budget& budget_;
    Scene& scene_;
    Report& report_;
    std::unordered_map<std::string_view, std::uint32_t> material_of_;
};

}  // namespace

void import_meshes(const XFile& file, const FrameIndex& frames, Budget& budget, Scene& scene, Report& report) {
    MeshImporter importer(file, frames, budget, scene, report);
    for (const Mesh& mesh : file.meshes) importer.import(mesh);
}

}  // namespace bendy::converter::x
