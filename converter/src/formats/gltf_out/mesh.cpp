#include "formats/gltf_out/parts.h"
#include "scene/failure.h"
#include "scene/frame_shapes.h"
#include "scene/source/normalise.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_set>
#include <utility>
#include <vector>

namespace bendy::converter::gltf_out {
namespace {

constexpr double kTolerance = 0.00674;  // the Khronos validator's

bool make_unit(glm::vec3& vector) {
    const glm::dvec3 exact(vector);
    const double length = glm::length(exact);
    if (std::abs(length - 1.0) <= kTolerance) return false;
    vector = length > 0.0 && std::isfinite(length) ? glm::vec3(exact / length) : glm::vec3(0.0f, 0.0f, 1.0f);
    return true;
}

/// glTF requires unit vectors: those outside the Khronos validator's tolerance are normalised, and those without a
/// direction point along +Z. The others keep their bits.
/// \return how many were changed
std::uint64_t make_unit(std::vector<glm::vec3>& normals) {
    std::uint64_t changed = 0;
    for (glm::vec3& normal : normals) changed += make_unit(normal) ? 1 : 0;
    return changed;
}

/// As above, for xyz; w, the handedness, becomes 1 or -1.
std::uint64_t make_unit(std::vector<glm::vec4>& tangents) {
    std::uint64_t changed = 0;
    for (glm::vec4& tangent : tangents) {
        glm::vec3 direction(tangent);
        const float hand = tangent.w < 0.0f ? -1.0f : 1.0f;
        const bool is_changed = make_unit(direction) || tangent.w != hand;
        if (!is_changed) continue;
        tangent = glm::vec4(direction, hand);
        ++changed;
    }
    return changed;
}

constexpr std::size_t kSetSize = 4;           // influences per glTF attribute
constexpr std::uint32_t kMostMissing = 8;     // missing sets of texture coordinates or colours
constexpr std::size_t kMostJoints = 0x10000;  // addressable by a 16-bit index

/// Whether the sum of a vertex's weights is 1 to the Khronos validator: it adds floats, the first weight of each set,
/// then the second ones, and allows kWeightRounding for each weight that is not zero.
bool sums_to_one(std::span<const float> weights) {
    float sum = 0.0f;
    double tolerance = 0.0;
    for (std::size_t first = 0; first < std::min(kSetSize, weights.size()); ++first) {
        for (std::size_t i = first; i < weights.size(); i += kSetSize) {
            sum += weights[i];
            tolerance += weights[i] != 0.0f ? kWeightRounding : 0.0;
        }
    }
    return std::abs(double{sum} - 1.0) <= tolerance;
}

/// Makes the sums of all vertices, of `n` weights each, 1 to the validator. Changes the largest weight of those that
/// are not; the others keep their bits. \return of how many vertices
std::uint64_t make_sums_one(std::vector<float>& weights, std::size_t n) {
    std::uint64_t changed = 0;
    for (std::size_t at = 0; at < weights.size(); at += n) {
        const std::span<float> own(weights.data() + at, n);
        if (sums_to_one(own)) continue;
        double others = 0.0;
        float& largest = *std::max_element(own.begin(), own.end());
        for (const float& weight : own) others += &weight == &largest ? 0.0 : double{weight};
        largest = static_cast<float>(std::max(0.0, 1.0 - others));
        ++changed;
    }
    return changed;
}

template <class Vector>
std::span<const float> floats_of(const std::vector<Vector>& vectors) {
    if (vectors.empty()) return {};
    return {glm::value_ptr(vectors.front()), vectors.size() * static_cast<std::size_t>(Vector::length())};
}

int mode_of(Topology topology) {
    return topology == Topology::points ? 0 : topology == Topology::lines ? 1 : 4;
}

bool has_primitives(const Mesh& mesh) {
    return !mesh.positions.empty() && std::any_of(mesh.submeshes.begin(), mesh.submeshes.end(),
                                                  [](const Submesh& submesh) { return !submesh.indices.empty(); });
}

/// The identity of a glTF skin: the palette, and the text of the node's members for the skin (empty: none).
struct SkinKey {
    const Palette* palette;
    std::string members;
};

/// Orders skins by content.
struct SkinLess {
    bool operator()(const SkinKey& a, const SkinKey& b) const {
        if (a.palette->joints != b.palette->joints) return a.palette->joints < b.palette->joints;
        const std::size_t size = a.palette->inverse_bind.size() * sizeof(glm::mat4);
        const int order =
            size == 0 ? 0 : std::memcmp(a.palette->inverse_bind.data(), b.palette->inverse_bind.data(), size);
        return order != 0 ? order < 0 : a.members < b.members;
    }
};

/// The key of meshes that one node can draw together: a node has one mesh, with one set of targets, and one skin.
struct Slot {
    std::uint32_t joint = kNone;
    std::uint32_t skin = kNone;  ///< kNone: rigid
    std::string name;
    std::string extras;
    std::string more;
    std::vector<std::pair<std::string, float>> targets;  ///< name, rest weight
    std::string_view motion;                             ///< of the weights, see append_motion

    friend bool operator<(const Slot& a, const Slot& b) {
        return std::tie(a.joint, a.skin, a.name, a.extras, a.more, a.targets, a.motion) <
               std::tie(b.joint, b.skin, b.name, b.extras, b.more, b.targets, b.motion);
    }
};

/// A glTF mesh under construction.
struct Drawn {
    std::uint32_t node = kNone;
    std::uint32_t skin = kNone;
    std::vector<std::uint32_t> meshes;  ///< of the scene
};

class MeshExporter {
public:
    MeshExporter(const Scene& scene, std::span<const Json> node_members, Json& nodes, Json& roots, Buffer& buffer,
                 Report& report)
        : scene_(scene),
          node_members_(node_members),
          nodes_(nodes),
          roots_(roots),
          buffer_(buffer),
          report_(report),
          is_taken_(scene.joints.size()) {}

    ExportedMeshes run() {
        out_.node_of_mesh.assign(scene_.meshes.size(), kNone);
        find_motions();
        for (std::uint32_t i = 0; i < scene_.meshes.size(); ++i) {
            if (has_primitives(scene_.meshes[i])) {
                place(i);
            } else {
                report_.warn("a mesh that draws nothing is left out", at("meshes", i));
            }
        }
        for (const Drawn& drawn : drawn_) write(drawn);
        return std::move(out_);
    }

private:
    void find_motions() {
        motions_.resize(scene_.meshes.size());
        for (std::size_t clip = 0; clip < scene_.clips.size(); ++clip) {
            for (const Track& track : scene_.clips[clip].tracks) {
                if (track.path == TrackPath::weights) append_motion(track, clip, motions_[track.target]);
            }
            for (const Play& play : scene_.clips[clip].plays) append_motion(play, clip, motions_[play.mesh]);
        }
    }

    void place(std::uint32_t number) {
        const Mesh& mesh = scene_.meshes[number];
        Slot slot{mesh.joint,      mesh.influences == 0 ? kNone : skin_of(mesh, number),
                  mesh.name,       mesh.extras,
                  mesh.more,       {},
                  motions_[number]};
        for (const MorphTarget& target : mesh.targets) slot.targets.emplace_back(target.name, target.rest_weight);
        const std::uint32_t skin = slot.skin;
        const auto [known, is_new] = slots_.try_emplace(std::move(slot), drawn_.size());
        if (is_new) drawn_.push_back({node_for(mesh, number), skin, {}});
        Drawn& drawn = drawn_[known->second];
        drawn.meshes.push_back(number);
        out_.node_of_mesh[number] = drawn.node;
    }

    /// The joint's own node if it draws nothing yet, else a new child node.
    std::uint32_t node_for(const Mesh& mesh, std::uint32_t number) {
        if (mesh.joint != kNone && !is_taken_[mesh.joint]) {
            is_taken_[mesh.joint] = true;
            return mesh.joint;
        }
        report_.warn("a mesh that cannot share its joint's node gets one of its own", at("meshes", number));
        const auto node = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back(mesh.name.empty() ? Json::object() : Json{{"name", mesh.name}});
        (mesh.joint == kNone ? roots_ : nodes_[mesh.joint]["children"]).push_back(node);
        return node;
    }

    void write(const Drawn& drawn) {
        const Mesh& first = scene_.meshes[drawn.meshes.front()];
        Json mesh = Json::object();
        if (!first.name.empty()) mesh["name"] = first.name;
        const std::string place = at("meshes", drawn.meshes.front());
        add_extras(mesh, first.extras, place, report_);
        add_members(mesh, read_members(first.more, place, report_), gltf::Element::mesh, place, report_);
        name_targets(mesh, first, place);
        const auto is_set = [](const MorphTarget& target) { return target.rest_weight != 0.0f; };
        if (std::any_of(first.targets.begin(), first.targets.end(), is_set)) {
            for (const MorphTarget& target : first.targets) mesh["weights"].push_back(json_number(target.rest_weight));
        }
        for (const std::uint32_t number : drawn.meshes) write_primitives(scene_.meshes[number], number, mesh);
        nodes_[drawn.node]["mesh"] = out_.meshes.size();
        if (drawn.skin != kNone) nodes_[drawn.node]["skin"] = drawn.skin;
        out_.meshes.push_back(std::move(mesh));
    }

    /// Viewers look for target names in extras.targetNames. Blender fails to import an empty name, and three.js ignores
    /// a list that is too short.
    void name_targets(Json& mesh, const Mesh& source, const std::string& place) {
        const auto& targets = source.targets;
        const auto is_unnamed = [](const MorphTarget& target) { return target.name.empty(); };
        if (std::all_of(targets.begin(), targets.end(), is_unnamed)) return drop_empty_names(mesh);
        Json& extras = mesh["extras"];
        if (extras.is_null()) extras = Json::object();
        if (!extras.is_object()) {
            report_.warn("names of targets left out: the mesh's extras are not an object", place);
            return;
        }
        Json& written = extras["targetNames"];
        // The source's list may contain more: entries that are not strings, or more entries than targets.
        const auto is_said = [](const MorphTarget& target, const Json& said) {
            return target.name.empty() ? !said.is_string() : said.is_string() && said == Json(target.name);
        };
        const bool says_it = written.is_array() && written.size() >= targets.size() &&
                             std::equal(targets.begin(), targets.end(), written.begin(), is_said);
        if (!says_it) written = full_names(targets, place);
    }

    /// Removes the names in the source's extras if all targets are unnamed.
    static void drop_empty_names(Json& mesh) {
        const auto extras = mesh.find("extras");
        if (extras == mesh.end() || !extras->is_object()) return;
        const auto names = extras->find("targetNames");
        if (names == extras->end() || !names->is_array() || std::find(names->begin(), names->end(), "") == names->end())
            return;
        extras->erase(names);
        if (extras->empty()) mesh.erase(extras);
    }

    /// The targets' names; unnamed ones are called target_NUMBER, or the next free name.
    Json full_names(const std::vector<MorphTarget>& targets, const std::string& place) {
        std::unordered_set<std::string> taken;
        for (const MorphTarget& target : targets) taken.insert(target.name);
        Json names = Json::array();
        std::uint64_t made = 0;
        for (std::size_t number = 0; number < targets.size(); ++number) {
            std::string name = targets[number].name;
            if (name.empty()) {
                name = "target_" + std::to_string(number);
                while (!taken.insert(name).second) name += '_';
                ++made;
            }
            names.push_back(std::move(name));
        }
        if (made != 0) {
            report_.warn("a morph target without a name, in a mesh with named ones, is called target_NUMBER", place,
                         made);
        }
        return names;
    }

    void write_primitives(const Mesh& mesh, std::uint32_t number, Json& out) {
        Json attributes = write_attributes(mesh, number);
        const Json targets = write_targets(mesh);
        for (const Submesh& submesh : mesh.submeshes) {
            if (submesh.indices.empty()) continue;
            Json primitive{{"attributes", attributes}, {"mode", mode_of(submesh.topology)}};
            primitive["indices"] = buffer_.add_integers(submesh.indices, 1, Buffer::Use::indices);
            if (submesh.material != kNone) primitive["material"] = submesh.material;
            if (!targets.empty()) primitive["targets"] = targets;
            out["primitives"].push_back(std::move(primitive));
        }
    }

    Json write_attributes(const Mesh& mesh, std::uint32_t number) {
        constexpr auto kVertices = Buffer::Use::vertices;
        Json attributes;
        attributes["POSITION"] = buffer_.add_floats(floats_of(mesh.positions), 3, kVertices, true);
        if (!mesh.normals.empty()) attributes["NORMAL"] = write_unit(mesh.normals, at("meshes", number));
        if (!mesh.tangents.empty()) attributes["TANGENT"] = write_unit(mesh.tangents, at("meshes", number));
        write_sets(mesh.texture_coords, "TEXCOORD_", at("meshes", number), attributes);
        write_sets(mesh.colours, "COLOR_", at("meshes", number), attributes);
        for (const Stream& stream : mesh.attributes) {
            const std::uint32_t n = stream.components;
            if (n > 4 && n != 9 && n != 16) {
                report_.warn("attribute of " + std::to_string(n) + " components left out: glTF has no such type",
                             at("meshes", number) + '.' + key(stream.name));
                continue;
            }
            const bool is_the_authors = stream.name.starts_with('_');
            if (!is_the_authors) {
                report_.warn("attribute gets an underscore before its name: glTF has no such attribute",
                             at("meshes", number) + '.' + key(stream.name));
            }
            attributes[is_the_authors ? stream.name : '_' + stream.name] =
                buffer_.add_floats(stream.values, n, kVertices, false);
        }
        if (mesh.influences != 0) write_influences(mesh, at("meshes", number), attributes);
        return attributes;
    }

    template <class Vector>
    std::uint32_t write_unit(std::vector<Vector> vectors, const std::string& place) {
        if (const std::uint64_t changed = make_unit(vectors); changed != 0)
            report_.warn("normal or tangent that is not a unit vector, normalised", place, changed);
        return buffer_.add_floats(floats_of(vectors), Vector::length(), Buffer::Use::vertices, false);
    }

    /// glTF numbers sets from 0 without gaps: missing ones are filled with zeros.
    void write_sets(const std::vector<Stream>& streams, const std::string& prefix, const std::string& place,
                    Json& attributes) {
        std::uint32_t next = 0;
        for (const Stream& stream : streams) {
            if (stream.set - next > kMostMissing) {
                report_.warn(prefix + std::to_string(stream.set) + " left out: too many sets before it are missing",
                             place);
                continue;
            }
            for (; next < stream.set; ++next) {
                report_.warn("missing set " + prefix + std::to_string(next) + " is written as zeros", place);
                attributes[prefix + std::to_string(next)] =
                    buffer_.add_fractions(std::vector<float>(stream.values.size()), stream.components);
            }
            attributes[prefix + std::to_string(next++)] = buffer_.add_fractions(stream.values, stream.components);
        }
    }

    /// Writes four influences per attribute; the last is padded with zero weights.
    void write_influences(const Mesh& mesh, const std::string& place, Json& attributes) {
        const std::size_t n = mesh.influences;
        const std::size_t vertices = mesh.positions.size();
        std::vector<float> sums_made(mesh.weights);
        if (const std::uint64_t changed = make_sums_one(sums_made, n); changed != 0) {
            report_.warn(
                "the weights of a vertex, added as 32-bit floats, are not 1 as glTF demands: its largest weight is "
                "changed by the difference",
                place, changed);
        }
        std::vector<std::uint32_t> bones;
        std::vector<float> weights;
        for (std::size_t set = 0; set * kSetSize < n; ++set) {
            bones.assign(vertices * kSetSize, 0);
            weights.assign(vertices * kSetSize, 0.0f);
            const std::size_t first = set * kSetSize;
            const std::size_t count = std::min<std::size_t>(kSetSize, n - first);
            for (std::size_t v = 0; v < vertices; ++v) {
                for (std::size_t i = 0; i < count; ++i) {
                    bones[v * kSetSize + i] = mesh.bones[v * n + first + i];
                    weights[v * kSetSize + i] = sums_made[v * n + first + i];
                }
            }
            const std::string suffix = '_' + std::to_string(set);
            attributes["JOINTS" + suffix] = buffer_.add_integers(bones, kSetSize, Buffer::Use::vertices);
            attributes["WEIGHTS" + suffix] = buffer_.add_fractions(weights, kSetSize);
        }
    }

    Json write_targets(const Mesh& mesh) {
        Json targets = Json::array();
        const std::vector<glm::vec3> zeros(mesh.targets.empty() ? 0 : mesh.positions.size());
        for (const MorphTarget& target : mesh.targets) {
            Json written = Json::object();
            // A target must displace something; all zeros take no bytes.
            const bool is_empty = target.positions.empty() && target.normals.empty() && target.tangents.empty();
            if (is_empty) written["POSITION"] = buffer_.add_displacements(floats_of(zeros));
            const std::vector<glm::vec3> positions = shifts_of(target, target.positions, mesh.positions);
            const std::vector<glm::vec3> normals = shifts_of(target, target.normals, mesh.normals);
            if (!positions.empty()) written["POSITION"] = buffer_.add_displacements(floats_of(positions));
            if (!normals.empty()) written["NORMAL"] = buffer_.add_displacements(floats_of(normals));
            if (!target.tangents.empty()) written["TANGENT"] = buffer_.add_displacements(floats_of(target.tangents));
            targets.push_back(std::move(written));
        }
        return targets;
    }

    /// The members that the mesh's node gives its skin, or null.
    [[nodiscard]] const Json* members_of_skin(const Mesh& mesh) const {
        if (mesh.joint == kNone) return nullptr;
        const auto skin = node_members_[mesh.joint].find("skin");
        return skin != node_members_[mesh.joint].end() && skin->is_object() ? &*skin : nullptr;
    }

    std::uint32_t skin_of(const Mesh& source, std::uint32_t mesh) {
        const Palette& palette = source.palette;
        const Json* members = members_of_skin(source);
        const auto number = static_cast<std::uint32_t>(out_.skins.size());
        const auto [known, is_new] =
            skins_.try_emplace({&palette, members == nullptr ? std::string() : members->dump()}, number);
        if (!is_new) return known->second;
        if (palette.joints.size() > kMostJoints)
            fail(at("meshes", mesh), "glTF cannot bind vertices to more than 65,536 joints");
        Json skin{{"joints", palette.joints}};
        skin["inverseBindMatrices"] =
            buffer_.add_floats({glm::value_ptr(palette.inverse_bind.front()), palette.inverse_bind.size() * 16}, 16,
                               Buffer::Use::data, false);
        if (members != nullptr)
            add_members(skin, *members, gltf::Element::skin, at("joints", source.joint) + ".skin", report_);
        out_.skins.push_back(std::move(skin));
        return number;
    }

    const Scene& scene_;
    std::span<const Json> node_members_;  ///< by joint
    Json& nodes_;
    Json& roots_;
    Buffer& buffer_;
    Report& report_;
    ExportedMeshes out_;
    std::vector<std::string> motions_;   ///< by mesh: the motion of its weights
    std::map<Slot, std::size_t> slots_;  ///< into drawn_
    std::vector<Drawn> drawn_;
    std::vector<bool> is_taken_;  ///< by joint: its node already draws something
    std::map<SkinKey, std::uint32_t, SkinLess> skins_;
};

}  // namespace

ExportedMeshes export_meshes(const Scene& scene, std::span<const Json> node_members, Json& nodes, Json& roots,
                             Buffer& buffer, Report& report) {
    return MeshExporter(scene, node_members, nodes, roots, buffer, report).run();
}

}  // namespace bendy::converter::gltf_out
