#pragma once

#include <bendy/format/document.h>
#include <bendy/format/file.h>
#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/constraint.h>
#include <bendy/runtime/transform.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

namespace bendy {

struct ModelData;  // internal

}  // namespace bendy

namespace BENDY_PUBLIC bendy {

// The format's views are the runtime's data: they refer to the mapped file.
using Chain = ChainView;
using JointRole = RoleRecord;
using StandingPose = StandingPoseView;
using Clip = ClipView;
using Mesh = MeshView;
using Material = MaterialView;
using Texture = TextureView;

struct Joint {
    std::uint32_t parent = kNone;  ///< smaller than the joint's own number; kNone: a root
    JointTransform rest;           ///< relative to the parent
    glm::vec3 shear{0.0f};         ///< part of the local matrix that clips do not animate: see transform.h
    std::string_view name;         ///< UTF-8; may be empty, need not be unique
    std::string_view extras;       ///< application-specific JSON, or empty
};

/// One draw call: a range of a mesh's index list with one material.
struct Submesh {
    std::uint32_t mesh = 0;
    std::uint32_t material = kNone;  ///< into Model::materials(), or kNone
    Topology topology = Topology::triangles;
    std::uint32_t first = 0;  ///< index into the mesh's index list
    std::uint32_t count = 0;
};

/// When a file's bytes are checked against their integrity sums. In either case the structure is checked when the file
/// is opened, and nothing is read or written out of bounds.
enum class Sums : std::uint8_t {
    checked,  ///< on opening, which reads every byte
    /// Only by Model::check_sums. Opening then reads only headers, joints and indices; bulk data is read from disk as
    /// it is used. The drawback: until then, numbers that were corrupted on disk are used unnoticed.
    later,
};

/// Where Model::open has a file's bytes.
enum class Storage : std::uint8_t {
    mapped,  ///< in the file: nothing is copied, and only what is used is read
    /// In memory of its own. For files that another program may make shorter meanwhile: on POSIX systems, reading the
    /// missing part of a mapped file ends the program by SIGBUS (docs/embedding.md).
    copied,
};

struct OpenOptions {
    std::uint32_t object = 0;  ///< index of the object in the file
    Sums sums = Sums::checked;
    Storage storage = Storage::mapped;  ///< not for from_memory
};

/// A character: the file and a linear array of its joints, parents before children. Immutable, so any number of
/// threads may use it.
///
/// A Model is a handle: copies share the character, and so does everything made from one (Pose, Lod, Bounds, ...). A
/// Model may therefore be moved, copied or destroyed at any time; the file is closed with the last handle. Spans, views
/// and pointers that a Model returns are valid until then. A Model that was moved from has no character: it may only be
/// assigned to or destroyed.
class Model {
public:
    /// Maps and checks a file. If it is not valid, returns the first fault, with its offset in the file.
    static Result<Model> open(const std::filesystem::path& path, const OpenOptions& options = {});
    /// As open, for bytes in memory, which must start on a 16-byte boundary and outlive the character.
    static Result<Model> from_memory(Bytes bytes, const OpenOptions& options = {});

    /// True if both are handles to one character. Opening a file twice makes two characters.
    [[nodiscard]] friend bool operator==(const Model& a, const Model& b) { return a.data_ == b.data_; }

    /// Checks the bytes against their sums, for Sums::later. Returns the first chunk that differs, with its offset. May
    /// be called from any thread while others use the model; takes about as long as reading the file once.
    [[nodiscard]] Result<void> check_sums() const;

    [[nodiscard]] std::string_view name() const;
    /// The application-specific JSON of the object, or empty.
    [[nodiscard]] std::string_view extras() const;
    /// The application-specific JSON of the whole file, or empty.
    [[nodiscard]] std::string_view file_extras() const;
    [[nodiscard]] std::span<const Joint> joints() const;
    /// The joints' parents as a compact array.
    [[nodiscard]] std::span<const std::uint32_t> parents() const;
    /// True if some joint has shear.
    [[nodiscard]] bool is_sheared() const;
    [[nodiscard]] std::span<const Mesh> meshes() const;
    [[nodiscard]] std::span<const Clip> clips() const;
    [[nodiscard]] std::span<const Material> materials() const;
    [[nodiscard]] std::span<const Texture> textures() const;
    [[nodiscard]] std::span<const Submesh> submeshes() const;
    /// The sequence in which vertices are collapsed, as applied by Lod; null if the file has none.
    [[nodiscard]] const CollapseView* collapse() const;
    /// The submeshes of each joint: for hit tests, severed limbs, culling.
    [[nodiscard]] std::span<const SubmeshView> joint_submeshes() const;

    /// What joints are in the body (hips, left upper leg, ...), ordered by joint; empty if the file does not say it.
    [[nodiscard]] std::span<const JointRole> roles() const;
    /// The pose in which the body stands, if that is not the rest pose; null if the file does not say it. Retargeting
    /// measures from it.
    [[nodiscard]] const StandingPose* standing_pose() const;

    /// The joints' constraints, ordered by joint.
    [[nodiscard]] std::span<const Constraint> constraints() const;
    [[nodiscard]] std::span<const Chain> chains() const;
    /// Weights of joints in the chain, ordered by joint; a joint without one has weight 1. Empty for a chain of another
    /// model.
    [[nodiscard]] std::span<const ChainWeightView> chain_weights(const Chain& chain) const;

    /// Returns the first clip, chain or joint with that name; null or kNone if there is none.
    [[nodiscard]] const Clip* clip(std::string_view name) const;
    [[nodiscard]] const Chain* chain(std::string_view name) const;
    [[nodiscard]] std::uint32_t joint(std::string_view name) const;
    /// The constraint of a joint in poses, and in IK solvers; null if it has none, or if the joint does not exist.
    [[nodiscard]] const Constraint* constraint(std::uint32_t joint) const;
    [[nodiscard]] const Constraint* ik_constraint(std::uint32_t joint) const;
    /// The chains' numbers in solving order: ascending priority, then file order.
    [[nodiscard]] std::span<const std::uint32_t> chain_order() const;
    /// Number of links of the longest chain.
    [[nodiscard]] std::uint32_t longest_chain() const;

    /// Number of vertices of all meshes together, mesh after mesh; and the index of a mesh's first one, which is that
    /// number if the mesh does not exist.
    [[nodiscard]] std::uint64_t vertex_count() const;
    [[nodiscard]] std::uint64_t first_vertex(std::uint32_t mesh) const;
    /// The same for morph targets.
    [[nodiscard]] std::uint32_t morph_target_count() const;
    [[nodiscard]] std::uint32_t first_morph_target(std::uint32_t mesh) const;
    /// Number of entries of the largest bind palette.
    [[nodiscard]] std::uint32_t largest_palette() const;
    /// Returns the joint that moves a vertex of a rigid mesh; kNone if none does, or if the vertex does not exist.
    [[nodiscard]] std::uint32_t rigid_mover(std::uint32_t mesh, std::uint32_t vertex) const;
    /// True if that is the same for all vertices of the mesh.
    [[nodiscard]] bool has_one_mover(std::uint32_t mesh) const;

private:
    friend struct ModelData;
    explicit Model(std::shared_ptr<const ModelData> data) : data_(std::move(data)) {}

    std::shared_ptr<const ModelData> data_;
};

}  // namespace bendy
