#pragma once

#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>
#include <bendy/runtime.h>

#include "format/edit_file.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// Small models for tests, built as files and opened as every other.
namespace bendy::test {

/// A model with the bytes that it lies in.
class Owned {
public:
    explicit Owned(Buffer bytes, const OpenOptions& options = {})
        : bytes_(std::move(bytes)), model_(open(bytes_, options)) {}
    Owned(const Owned&) = delete;
    Owned& operator=(const Owned&) = delete;

    const Model& operator*() const { return model_; }
    const Model* operator->() const { return &model_; }

private:
    static Model open(Bytes bytes, const OpenOptions& options) {
        Result<Model> model = Model::from_memory(bytes, options);
        if (!model) throw std::runtime_error(describe_with_place(model.error(), bytes));
        return *std::move(model);
    }

    Buffer bytes_;
    Model model_;
};

struct JointSpec {
    std::uint32_t parent = kNone;
    RestRecord rest;
    std::vector<SubmeshRecord> submeshes;
    std::string name;
    std::vector<ConstraintRecord> constraints{};
    std::vector<ChainWeightRecord> chain_weights{};
};

struct MeshSpec {
    std::uint32_t joint = kNone;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> tangents;
    std::vector<std::uint32_t> indices;
    std::vector<Node> more;  ///< BONE, WGHT, PALT, TARG; POSI instead of `positions`
};

struct ModelSpec {
    std::vector<JointSpec> joints;  ///< pre-order
    std::vector<MeshSpec> meshes;
    std::vector<ChainRecord> chains{};  ///< named by their numbers
    std::vector<Node> more{};           ///< LODD, CYCL
};

template <class Vector>
Node vector_stream(FourCC id, const std::vector<Vector>& vectors) {
    std::vector<float> numbers;
    for (const Vector& vector : vectors) {
        for (int c = 0; c < Vector::length(); ++c) numbers.push_back(vector[c]);
    }
    return make_leaf(id, stream_payload<float>(static_cast<std::uint16_t>(Vector::length()), numbers));
}

/// A palette with these inverse bind matrices.
inline Node palette_leaf(const std::vector<std::uint32_t>& joints, const std::vector<glm::mat4>& inverse_bind) {
    Buffer payload = palette_payload(joints);
    std::memcpy(payload.data() + payload.size() - inverse_bind.size() * sizeof(glm::mat4), inverse_bind.data(),
                inverse_bind.size() * sizeof(glm::mat4));
    return make_leaf(FourCC("PALT"), payload);
}

inline SubmeshRecord submesh(std::uint32_t mesh, std::uint32_t first, std::uint32_t count,
                             std::uint32_t material = kNone, Topology topology = Topology::triangles) {
    SubmeshRecord record;
    record.mesh = mesh;
    record.material = material;
    record.topology = static_cast<std::uint8_t>(topology);
    record.first = first;
    record.count = count;
    return record;
}

inline Node mesh_node(const MeshSpec& mesh) {
    Node node = make_container(FourCC("VECT"));
    const MeshRecord info{static_cast<std::uint32_t>(mesh.positions.size()), mesh.joint};
    node.children.push_back(make_leaf(FourCC("VINF"), bytes_of(info)));
    const bool has_own =
        std::any_of(mesh.more.begin(), mesh.more.end(), [](const Node& more) { return more.id == FourCC("POSI"); });
    if (!mesh.positions.empty() && !has_own) node.children.push_back(vector_stream(FourCC("POSI"), mesh.positions));
    if (!mesh.normals.empty()) node.children.push_back(vector_stream(FourCC("NORM"), mesh.normals));
    if (!mesh.tangents.empty()) node.children.push_back(vector_stream(FourCC("TANG"), mesh.tangents));
    if (!mesh.indices.empty())
        node.children.push_back(make_leaf(FourCC("INDX"), stream_payload<std::uint32_t>(1, mesh.indices)));
    node.children.insert(node.children.end(), mesh.more.begin(), mesh.more.end());
    return node;
}

inline Buffer build_file(const ModelSpec& spec) {
    ChunkWriter writer;
    writer.begin(FourCC("HEAD"));
    VersionRecord version;
    version.objects = 1;
    version.joints = static_cast<std::uint32_t>(spec.joints.size());
    version.meshes = static_cast<std::uint32_t>(spec.meshes.size());
    for (const MeshSpec& mesh : spec.meshes) version.vertices += mesh.positions.size();
    for (const Node& node : spec.more) version.clips += node.id == FourCC("CYCL") ? 1 : 0;
    writer.leaf(FourCC("VERS"), bytes_of(version));
    writer.begin(FourCC("OBJE"));
    std::vector<std::uint32_t> open;
    for (std::uint32_t number = 0; number < spec.joints.size(); ++number) {
        const JointSpec& joint = spec.joints[number];
        for (; !open.empty() && open.back() != joint.parent; open.pop_back()) writer.end();
        writer.begin(FourCC("SKIN"));
        open.push_back(number);
        if (!joint.name.empty()) writer.text_leaf(FourCC("NAME"), joint.name);
        writer.begin(FourCC("PIVO"));
        writer.leaf(FourCC("REST"), bytes_of(joint.rest));
        for (const ConstraintRecord& constraint : joint.constraints) writer.leaf(FourCC("LIMT"), bytes_of(constraint));
        for (const ChainWeightRecord& chain_weight : joint.chain_weights)
            writer.leaf(FourCC("PULL"), bytes_of(chain_weight));
        writer.end();
        for (const SubmeshRecord& range : joint.submeshes) writer.leaf(FourCC("POLY"), bytes_of(range));
    }
    for (; !open.empty(); open.pop_back()) writer.end();
    for (std::size_t chain = 0; chain < spec.chains.size(); ++chain) {
        writer.begin(FourCC("IKCH"));
        writer.text_leaf(FourCC("NAME"), std::to_string(chain));
        writer.leaf(FourCC("KINF"), bytes_of(spec.chains[chain]));
        writer.end();
    }
    for (const MeshSpec& mesh : spec.meshes) put(writer, mesh_node(mesh));
    for (const Node& node : spec.more) put(writer, node);
    writer.end();
    writer.end();
    return std::move(writer).finish();
}

inline RestRecord moved(float x, float y, float z) {
    RestRecord rest;
    rest.translation = {x, y, z};
    return rest;
}
inline RestRecord scaled(float x, float y, float z) {
    RestRecord rest;
    rest.scale = {x, y, z};
    return rest;
}
/// A turn of `degrees` round a coordinate axis, 0 to 2.
inline RestRecord turned(double degrees, std::size_t axis) {
    const double half = degrees * M_PI / 360.0;
    RestRecord rest;
    rest.rotation = {0.0f, 0.0f, 0.0f, static_cast<float>(std::cos(half))};
    rest.rotation.at(axis) = static_cast<float>(std::sin(half));
    return rest;
}

}  // namespace bendy::test
