#include "conventions.h"
#include "parts.h"
#include "scene/failure.h"
#include "scene/source/image_bytes.h"
#include "scene/source/named_files.h"
#include "scene/source/normalise.h"
#include "scene/source/source_file.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace bendy::converter::x {
namespace {

constexpr float kMostPower = 1e6f;

class MaterialImporter {
public:
    MaterialImporter(NamedFiles& files, bool embed_images, Scene& scene, Report& report)
        : files_(files), embed_images_(embed_images), scene_(scene), report_(report) {}

    void import(const Material& source) {
        converter::Material material;
        material.name = source.name;
        material.base_colour = to_light(source.colour);
        material.metallic = 0.0f;
        material.roughness = roughness_of(source.power);
        material.emissive = to_light(source.emissive);
        for (const glm::vec3& light : {glm::vec3(material.base_colour), material.emissive}) {
            if (std::max({light.x, light.y, light.z}) == std::numeric_limits<float>::max())
                report_.warn("a colour of a material is too large, the largest number is taken", source.place);
        }
        if (source.colour.w < 1.0f) material.alpha_mode = AlphaMode::blend;
        if (source.specular != glm::vec3(0.0f) && source.specular != glm::vec3(to_display(kDielectric)))
            report_.warn("specular colour of a material left out, its power is kept as roughness", source.place);
        if (!source.texture.empty()) material.base_colour_texture.texture = texture_of(source);
        // Direct3D multiplies all light with the texture, including the emitted light.
        if (source.emissive != glm::vec3(0.0f))
            material.emissive_texture.texture = material.base_colour_texture.texture;
        scene_.materials.push_back(std::move(material));
    }

private:
    std::uint32_t texture_of(const Material& source) {
        const auto number = static_cast<std::uint32_t>(scene_.textures.size());
        const auto [known, is_new] = texture_of_.try_emplace(source.texture, number);
        if (!is_new) return known->second;
        Image image;
        image.uri = files_.find_texture(source.texture);
        if (embed_images_) files_.embed(image, source.place);
        image.media_type = media_type_of(image.bytes);
        Texture texture;
        texture.images.push_back(static_cast<std::uint32_t>(scene_.images.size()));
        scene_.images.push_back(std::move(image));
        scene_.textures.push_back(std::move(texture));
        return number;
    }

    NamedFiles& files_;
    bool embed_images_;
    Scene& scene_;
    Report& report_;
    std::unordered_map<std::string, std::uint32_t> texture_of_;  ///< by file name
};

}  // namespace

float roughness_of(float power) {
    return std::sqrt(std::sqrt(2.0f / (std::clamp(power, 0.0f, kMostPower) + 2.0f)));
}

float power_of(float roughness) {
    const float square = roughness * roughness;
    const float power = 2.0f / std::max(square * square, 1e-9f) - 2.0f;
    return std::clamp(power, 0.0f, kMostPower);
}

void import_materials(const XFile& source, NamedFiles& files, bool embed_images, Scene& scene, Report& report) {
    MaterialImporter importer(files, embed_images, scene, report);
    for (const Material& material : source.materials) importer.import(material);
}

namespace {

/// The position and normal of each vertex, and the vertex of each corner.
struct Vertices {
    std::vector<std::uint32_t> positions;
    std::vector<std::uint32_t> normals;  ///< or empty
    std::vector<std::uint32_t> corners;
};

std::vector<std::uint32_t> count_up(std::size_t count) {
    std::vector<std::uint32_t> numbers(count);
    for (std::uint32_t i = 0; i < count; ++i) numbers[i] = i;
    return numbers;
}

/// X-files index positions and normals separately. If both use the same indices, as in most files, vertices keep their
/// numbers; otherwise each combination at a corner becomes a vertex.
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
        mesh.submeshes = make_parts(source, vertices);
        if (mesh.submeshes.empty()) {
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

    /// Triangles by material. A face's first corner stays first; the others are reversed, because mirroring flips the
    /// orientation.
    [[nodiscard]] std::vector<Submesh> make_parts(const Mesh& source, const Vertices& vertices) const {
        std::vector<Submesh> submeshes(std::max<std::size_t>(source.slots.size(), 1));
        for (std::size_t slot = 0; slot < source.slots.size(); ++slot)
            submeshes[slot].material = material_of(source.slots[slot]);
        std::size_t first = 0;
        std::uint64_t thin = 0;
        for (std::size_t face = 0; face < source.face_sizes.size(); ++face) {
            const std::uint32_t size = source.face_sizes[face];
            Submesh& submesh = submeshes[source.face_slots.empty() ? 0 : source.face_slots[face]];
            const std::uint32_t* const corners = vertices.corners.data() + first;
            for (std::uint32_t corner = 1; corner + 1 < size; ++corner)
                submesh.indices.insert(submesh.indices.end(), {corners[0], corners[corner + 1], corners[corner]});
            thin += size < 3 ? 1 : 0;
            first += size;
        }
        if (thin != 0) report_.warn("face of fewer than three corners left out", source.place, thin);
        std::erase_if(submeshes, [](const Submesh& submesh) { return submesh.indices.empty(); });
        return submeshes;
    }

    /// The skins whose frames exist.
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
        std::vector<std::uint32_t> used(source.positions.size());  // number of weights per position
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

/// A material that stands in a mesh belongs to the joint that moves this mesh, if it moves all meshes that use it.
void give_joints_their_materials(const XFile& file, Scene& scene) {
    std::vector<std::optional<std::uint32_t>> users(
        scene.materials.size());  // kNone: several joints, or a skinned mesh
    for (const converter::Mesh& mesh : scene.meshes) {
        const std::uint32_t joint = mesh.influences == 0 ? mesh.joint : kNone;
        for (const Submesh& submesh : mesh.submeshes) {
            if (submesh.material == kNone) continue;
            std::optional<std::uint32_t>& user = users[submesh.material];
            user = user.value_or(joint) == joint ? joint : kNone;
        }
    }
    for (std::size_t i = 0; i < users.size(); ++i) {
        if (file.materials[i].is_own) scene.materials[i].joint = users[i].value_or(kNone);
    }
}

/// Puts the file's materials first, then each joint's own: the order of a bendy file.
void sort_materials(Scene& scene) {
    std::vector<std::uint32_t> order = count_up(scene.materials.size());
    // kNone + 1 is 0.
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return scene.materials[a].joint + 1 < scene.materials[b].joint + 1;
    });
    std::vector<std::uint32_t> number(order.size());
    std::vector<converter::Material> sorted;
    for (const std::uint32_t material : order) {
        number[material] = static_cast<std::uint32_t>(sorted.size());
        sorted.push_back(std::move(scene.materials[material]));
    }
    scene.materials = std::move(sorted);
    for (converter::Mesh& mesh : scene.meshes) {
        for (Submesh& submesh : mesh.submeshes) {
            if (submesh.material != kNone) submesh.material = number[submesh.material];
        }
    }
}

}  // namespace

void import_meshes(const XFile& file, const FrameIndex& frames, Budget& budget, Scene& scene, Report& report) {
    MeshImporter importer(file, frames, budget, scene, report);
    for (const Mesh& mesh : file.meshes) importer.import(mesh);
    give_joints_their_materials(file, scene);
    sort_materials(scene);
}

}  // namespace bendy::converter::x
