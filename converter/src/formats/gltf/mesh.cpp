#include "accessor.h"
#include "draco.h"
#include "further_members.h"
#include "parts.h"
#include "primitive.h"
#include "scene/failure.h"
#include "scene/source/normalise.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace bendy::converter::gltf {
namespace {

// ---------------------------------------------------------------------------------------------- layout

/// Two primitives with equal layouts can be parts of one mesh.
struct MeshLayout {
    bool normals = false;
    bool tangents = false;
    std::vector<std::tuple<std::string, std::uint32_t, std::uint32_t>> streams;  ///< name, set, components; all kinds
    std::uint32_t influences = 0;
    std::size_t targets = 0;

    explicit MeshLayout(const Mesh& mesh)
        : normals(!mesh.normals.empty()),
          tangents(!mesh.tangents.empty()),
          influences(mesh.influences),
          targets(mesh.targets.size()) {
        const auto add = [&](const std::vector<Stream>& kind, const char* prefix) {
            for (const Stream& stream : kind) streams.emplace_back(prefix + stream.name, stream.set, stream.components);
        };
        add(mesh.texture_coords, "t");
        add(mesh.colours, "c");
        add(mesh.attributes, "a");
    }

    friend bool operator<(const MeshLayout& a, const MeshLayout& b) {
        return std::tie(a.normals, a.tangents, a.influences, a.targets, a.streams) <
               std::tie(b.normals, b.tangents, b.influences, b.targets, b.streams);
    }
};

template <class T>
void append(std::vector<T>& to, std::vector<T>&& from) {
    if (to.empty()) {
        to = std::move(from);
    } else {
        to.insert(to.end(), from.begin(), from.end());
    }
}

/// Like append, but an empty side stands for zeros.
void append_displacements(std::vector<glm::vec3>& to, std::vector<glm::vec3>&& from, std::size_t before,
                          std::size_t added, const Document& document, const std::string& place) {
    if (to.empty() && from.empty()) return;
    if (to.empty() || from.empty()) {
        document.budget.take(to.empty() ? before : added, sizeof(glm::vec3), place);
        to.resize(before, glm::vec3(0.0f));
        from.resize(added, glm::vec3(0.0f));
    }
    append(to, std::move(from));
}

/// Appends the vertices of a primitive to a mesh with the same layout.
void append_vertices(Mesh& to, Mesh&& from, const Document& document, const std::string& place) {
    const std::size_t before = to.positions.size();
    const std::size_t added = from.positions.size();
    if (added >= kNone - before) fail(place, "the mesh has more vertices than 32-bit indices can name");
    append(to.positions, std::move(from.positions));
    append(to.normals, std::move(from.normals));
    append(to.tangents, std::move(from.tangents));
    const auto append_streams = [](std::vector<Stream>& streams, std::vector<Stream>&& more) {
        for (std::size_t i = 0; i < streams.size(); ++i) append(streams[i].values, std::move(more[i].values));
    };
    append_streams(to.texture_coords, std::move(from.texture_coords));
    append_streams(to.colours, std::move(from.colours));
    append_streams(to.attributes, std::move(from.attributes));
    append(to.bones, std::move(from.bones));
    append(to.weights, std::move(from.weights));
    for (std::size_t t = 0; t < to.targets.size(); ++t) {
        MorphTarget& target = to.targets[t];
        MorphTarget& more = from.targets[t];
        append_displacements(target.positions, std::move(more.positions), before, added, document, place);
        append_displacements(target.normals, std::move(more.normals), before, added, document, place);
        append_displacements(target.tangents, std::move(more.tangents), before, added, document, place);
    }
}

// ---------------------------------------------------------------------------------------------- one glTF mesh

/// A mesh before a node assigns its skin and rest weights.
struct Template {
    struct Check {
        LargestBone largest;
        std::string place;  ///< of JOINTS_0
    };
    Mesh mesh;
    std::vector<Check> checks;  ///< one per primitive with influences
};

class TemplateBuilder {
public:
    TemplateBuilder(const Document& document, std::size_t mesh, bool skinned)
        : document_(document),
          source_(document.model.meshes[mesh]),
          json_(document.json["meshes"][mesh]),
          place_(at("meshes", mesh)),
          skinned_(skinned) {}

    std::vector<Template> build() {
        for (const tinygltf::Primitive& primitive : source_.primitives) {
            target_count_ = std::max(target_count_, primitive.targets.size());
        }
        name_targets();
        for (std::size_t p = 0; p < source_.primitives.size(); ++p) add_primitive(p);
        for (Template& entry : templates_) finish(entry.mesh);
        return std::move(templates_);
    }

private:
    using Accessors = std::map<std::string, int>;
    /// The source of a primitive's vertices: attributes, morph targets, Draco's extension object.
    using Source = std::tuple<Accessors, std::vector<Accessors>, std::string>;
    struct Placed {
        std::size_t entry = 0;  ///< index into templates_
        std::size_t first_vertex = 0;
        std::size_t count = 0;
        std::vector<std::uint32_t> draco_indices;
    };

    /// The specification suggests names in the mesh's extras; UniVRM and UnityGLTF write them into the extras of one or
    /// all of its primitives.
    void name_targets() {
        document_.budget.take(target_count_, sizeof(std::string), place_);
        names_ = target_names(json_, target_count_);
        for (std::size_t p = 0; p < source_.primitives.size(); ++p) {
            const std::vector<std::string> said =
                target_names(json_["primitives"][p], source_.primitives[p].targets.size());
            std::uint64_t other = 0;
            for (std::size_t t = 0; t < said.size(); ++t) {
                if (names_[t].empty()) names_[t] = said[t];
                if (!said[t].empty() && said[t] != names_[t]) ++other;
            }
            if (other > 0) {
                document_.report.warn(
                    "name of a morph target left out: the mesh or an earlier primitive gives another one",
                    place_ + '.' + at("primitives", p) + ".extras.targetNames", other);
            }
        }
        const bool has_all = std::none_of(names_.begin(), names_.end(), [](const auto& name) { return name.empty(); });
        const Json* extras = find(json_, "extras");
        extras_ = extras == nullptr || target_count_ == 0 || !has_all
                      ? extras_text(json_)
                      : extras_text(without_target_names({{"extras", *extras}}, target_count_));
    }

    void add_primitive(std::size_t p) {
        const tinygltf::Primitive& primitive = source_.primitives[p];
        const Json& json = json_["primitives"][p];
        const std::string place = place_ + '.' + at("primitives", p);
        if (!has_positions(primitive, json)) {
            document_.report.warn("primitive without POSITION left out", place);
            return;
        }
        const Placed& placed = place_vertices(primitive, json, place);
        Submesh submesh = read_submesh(document_, primitive, json, placed.count, placed.draco_indices, place);
        for (std::uint32_t& index : submesh.indices) index += static_cast<std::uint32_t>(placed.first_vertex);
        templates_[placed.entry].mesh.submeshes.push_back(std::move(submesh));
    }

    /// The vertices of a primitive; decoded unless an earlier primitive used the same accessors.
    const Placed& place_vertices(const tinygltf::Primitive& primitive, const Json& json, const std::string& place) {
        const Json* draco = find_draco(json);
        Source source{primitive.attributes, primitive.targets, draco == nullptr ? std::string() : draco->dump()};
        if (const auto known = placed_.find(source); known != placed_.end()) return known->second;
        Placed own;
        Vertices vertices = read_vertices(document_, primitive, json, skinned_, place);
        report_skinning(primitive, vertices.mesh, place);
        own.count = vertices.mesh.positions.size();
        own.draco_indices = std::move(vertices.draco_indices);
        const auto [group, is_new] = groups_.emplace(MeshLayout(vertices.mesh), templates_.size());
        own.entry = group->second;
        if (is_new) templates_.emplace_back();
        Template& entry = templates_[own.entry];
        if (vertices.mesh.influences > 0) {
            entry.checks.push_back({vertices.largest_bone, place + ".attributes.JOINTS_0"});
        }
        own.first_vertex = entry.mesh.positions.size();
        if (is_new) {
            entry.mesh = std::move(vertices.mesh);
        } else {
            append_vertices(entry.mesh, std::move(vertices.mesh), document_, place);
        }
        return placed_.emplace(std::move(source), std::move(own)).first->second;
    }

    void report_skinning(const tinygltf::Primitive& primitive, const Mesh& mesh, const std::string& place) const {
        if (skinned_ && mesh.influences == 0) {
            document_.report.warn("primitive without JOINTS_0 and WEIGHTS_0 in a skinned mesh, moved by its node",
                                  place);
        }
        if (!skinned_ && primitive.attributes.count("JOINTS_0") > 0) {
            document_.report.warn("joints and weights of a primitive left out: no node with a skin uses it", place);
        }
    }

    void finish(Mesh& mesh) const {
        mesh.name = source_.name;
        mesh.extras = extras_;
        if (const Json more = further_members(json_, Element::mesh); !more.empty()) mesh.more = more.dump();
        trim_influences(mesh);
        document_.budget.take(target_count_, sizeof(MorphTarget), place_);
        mesh.targets.resize(target_count_);
        for (std::size_t t = 0; t < target_count_; ++t) mesh.targets[t].name = names_[t];
    }

    const Document& document_;
    const tinygltf::Mesh& source_;
    const Json& json_;
    std::string place_;
    bool skinned_;
    std::size_t target_count_ = 0;
    std::vector<std::string> names_;  ///< of the targets
    std::string extras_;              ///< without the names, if an export writes them again from the targets
    std::map<MeshLayout, std::size_t> groups_;
    std::map<Source, Placed> placed_;
    std::vector<Template> templates_;
};

std::uint64_t byte_size(const Mesh& mesh) {
    const auto bytes = [](const auto& values) { return std::uint64_t{values.size()} * sizeof(values[0]); };
    std::uint64_t size = sizeof(Mesh) + mesh.name.size() + mesh.extras.size() + mesh.more.size() +
                         bytes(mesh.positions) + bytes(mesh.normals) + bytes(mesh.tangents) + bytes(mesh.bones) +
                         bytes(mesh.weights);
    for (const auto* kind : {&mesh.texture_coords, &mesh.colours, &mesh.attributes}) {
        for (const Stream& stream : *kind) size += sizeof(Stream) + bytes(stream.values);
    }
    for (const MorphTarget& target : mesh.targets) {
        size += sizeof(MorphTarget) + bytes(target.positions) + bytes(target.normals) + bytes(target.tangents);
    }
    for (const Submesh& submesh : mesh.submeshes) size += sizeof(Submesh) + bytes(submesh.indices);
    return size;
}

// ---------------------------------------------------------------------------------------------- all nodes

class MeshImporter {
public:
    MeshImporter(const Document& document, const Skeleton& skeleton, Scene& scene)
        : document_(document), skeleton_(skeleton), scene_(scene) {}

    MeshesOfNode import() {
        std::map<Key, std::size_t> uses;
        for_each_mesh_node([&](std::uint32_t node, std::uint32_t) { ++uses[key_of(node)]; });
        MeshesOfNode meshes_of_node(document_.model.nodes.size());
        for_each_mesh_node([&](std::uint32_t node, std::uint32_t joint) {
            const Key key = key_of(node);
            const auto found = templates_.find(key);
            auto& templates =
                found != templates_.end()
                    ? found->second
                    : templates_.emplace(key, TemplateBuilder(document_, key.first, key.second).build()).first->second;
            const bool is_last = --uses[key] == 0;
            for (Template& entry : templates) {
                meshes_of_node[node].push_back(static_cast<std::uint32_t>(scene_.meshes.size()));
                scene_.meshes.push_back(instantiate(entry, node, joint, is_last));
            }
            if (is_last) templates_.erase(key);
        });
        return meshes_of_node;
    }

private:
    using Key = std::pair<std::size_t, bool>;  ///< mesh, whether with a skin

    template <class Visit>
    void for_each_mesh_node(const Visit& visit) const {
        for (std::uint32_t joint = 0; joint < skeleton_.node_of_joint.size(); ++joint) {
            const std::uint32_t node = skeleton_.node_of_joint[joint];
            // Its instances draw it instead of the node.
            const bool is_drawn_by_others =
                skeleton_.has_instances[node] && skeleton_.instance_of_joint[joint] == kNone;
            if (skeleton_.is_drawn[joint] && document_.model.nodes[node].mesh >= 0 && !is_drawn_by_others)
                visit(node, joint);
        }
    }

    [[nodiscard]] Key key_of(std::uint32_t node) const {
        const tinygltf::Node& source = document_.model.nodes[node];
        return {static_cast<std::size_t>(source.mesh), source.skin >= 0};
    }

    Mesh instantiate(Template& entry, std::uint32_t node, std::uint32_t joint, bool is_last) {
        const std::string place = at("nodes", node);
        if (!is_last) document_.budget.take(byte_size(entry.mesh), 1, place);
        Mesh mesh = is_last ? std::move(entry.mesh) : entry.mesh;
        mesh.joint = joint;
        if (mesh.influences > 0) {
            const auto skin = static_cast<std::size_t>(document_.model.nodes[node].skin);
            const Palette& shared = palette(skin);
            document_.budget.take(shared.joints.size(), sizeof(glm::mat4) + sizeof(std::uint32_t), place);
            mesh.palette = shared;
            for (const auto& check : entry.checks) {
                if (check.largest.bone >= mesh.palette.joints.size()) {
                    fail(check.place, "vertex " + std::to_string(check.largest.vertex) + ": joint index " +
                                          std::to_string(check.largest.bone) + " is out of range (" +
                                          at("skins", skin) + " has " + std::to_string(mesh.palette.joints.size()) +
                                          " joints)");
                }
            }
        }
        set_rest_weights(mesh, node);
        return mesh;
    }

    void set_rest_weights(Mesh& mesh, std::uint32_t node) const {
        const Json& node_json = document_.json["nodes"][node];
        const bool own = node_json.contains("weights");
        const auto mesh_index = static_cast<std::size_t>(document_.model.nodes[node].mesh);
        const auto& weights = own ? document_.model.nodes[node].weights : document_.model.meshes[mesh_index].weights;
        for (std::size_t t = 0; t < mesh.targets.size(); ++t) {
            mesh.targets[t].rest_weight = t < weights.size() ? static_cast<float>(weights[t]) : 0.0f;
        }
        if (!weights.empty() && weights.size() != mesh.targets.size()) {
            document_.report.warn("number of morph weights differs from the number of morph targets",
                                  (own ? at("nodes", node) : at("meshes", mesh_index)) + ".weights");
        }
    }

    const Palette& palette(std::size_t skin) {
        if (const auto known = palettes_.find(skin); known != palettes_.end()) return known->second;
        const tinygltf::Skin& source = document_.model.skins[skin];
        Palette palette;
        for (const int node : source.joints) {
            palette.joints.push_back(skeleton_.joint_of_node[static_cast<std::size_t>(node)]);
        }
        palette.inverse_bind.assign(palette.joints.size(), glm::mat4(1.0f));
        if (source.inverseBindMatrices >= 0) read_inverse_bind(skin, palette);
        return palettes_.emplace(skin, std::move(palette)).first->second;
    }

    void read_inverse_bind(std::size_t skin, Palette& palette) const {
        const std::string place = at("skins", skin) + ".inverseBindMatrices";
        const auto index = static_cast<std::size_t>(document_.model.skins[skin].inverseBindMatrices);
        const auto& accessor = document_.model.accessors[index];
        if (accessor.type != TINYGLTF_TYPE_MAT4) fail(place, at("accessors", index) + " must hold MAT4");
        if (accessor.count < palette.joints.size()) {
            fail(place,
                 std::to_string(accessor.count) + " matrices for " + std::to_string(palette.joints.size()) + " joints");
        }
        const std::vector<float> values = read_floats(document_, index, place);
        constexpr float kTolerance = 1e-5f;
        std::uint64_t projective = 0;
        for (std::size_t j = 0; j < palette.joints.size(); ++j) {
            glm::mat4& matrix = palette.inverse_bind[j];
            for (int column = 0; column < 4; ++column) {
                const float* from = values.data() + 16 * j + 4 * static_cast<std::size_t>(column);
                const float last = column == 3 ? 1.0f : 0.0f;
                matrix[column] = {from[0], from[1], from[2], last};
                if (std::abs(from[3] - last) > kTolerance) ++projective;
            }
        }
        if (projective > 0) {
            document_.report.warn("last row of an inverse bind matrix is not 0 0 0 1, taken as such", place,
                                  projective);
        }
    }

    const Document& document_;
    const Skeleton& skeleton_;
    Scene& scene_;
    std::map<Key, std::vector<Template>> templates_;
    std::map<std::size_t, Palette> palettes_;
};

}  // namespace

MeshesOfNode import_meshes(const Document& document, const Skeleton& skeleton, Scene& scene) {
    return MeshImporter(document, skeleton, scene).import();
}

}  // namespace bendy::converter::gltf
