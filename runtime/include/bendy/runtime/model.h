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

struct ModelData;  // the library's own

}  // namespace bendy

namespace BENDY_PUBLIC bendy {

// The format's views are the runtime's data: they lie in the mapped file.
using Clip = ClipView;
using Mesh = MeshView;
using Material = MaterialView;
using Texture = TextureView;

struct Joint {
    std::uint32_t parent = kNone;  ///< smaller than the joint's own number; kNone: a root
    JointTransform rest;           ///< relative to the parent
    glm::vec3 shear{0.0f};         ///< part of the local matrix that no clip changes: see transform.h
    std::string_view name;         ///< UTF-8; may be empty, may be doubled
    std::string_view extras;       ///< JSON of the author's, or empty
};

/// A range of a mesh's index list with one material: what one draw call draws.
struct Submesh {
    std::uint32_t mesh = 0;
    std::uint32_t material = kNone;  ///< into Model::materials(), or kNone
    Topology topology = Topology::triangles;
    std::uint32_t first = 0;  ///< in Mesh::indices
    std::uint32_t count = 0;
};

/// An IK chain: the joints on the path from the effector up to the start.
struct Chain {
    std::string_view name;  ///< UTF-8; may be empty, may be doubled
    std::uint32_t number = 0;
    std::uint32_t start = 0;
    std::uint32_t effector = 0;
    std::uint32_t links = 0;       ///< joints from start to effector, both counted
    std::uint32_t target = kNone;  ///< joint to be reached, or kNone
    std::uint32_t pole = kNone;    ///< joint to bend towards, or kNone
    Solver solver = Solver::any;
    ChainRecord record;       ///< the rest, as in the file
    std::string_view extras;  ///< JSON of the author's, or empty
};

/// When a file's bytes are held against their integrity sums. Whatever is chosen, structure is checked when a file is
/// opened, and nothing is read or written out of bounds.
enum class Sums : std::uint8_t {
    checked,  ///< when it is opened: every byte of it is read
    /// When Model::check_sums is called, if ever: opening then reads no more than headers, joints and indices, and bulk
    /// is read from the disk as it is used. Given up: until then numbers that an accident on the disk has changed are
    /// taken for the author's.
    later,
};

struct OpenOptions {
    std::uint32_t object = 0;  ///< which of the file's objects
    Sums sums = Sums::checked;
};

/// A character: the mapped file and a linear array of its joints, parents before children. Nothing about it changes, so
/// any number of threads may use it.
///
/// A Model is a handle: copies share the character, and so does everything that is made from one (Pose, Lod, Bounds,
/// ...). A Model may therefore be moved, copied or destroyed at any time; the file is closed when the last of them is
/// gone. Spans, views and pointers that a Model returns are valid as long. A Model that was moved from has no
/// character: it may be assigned to or destroyed, nothing else.
class Model {
public:
    /// Maps and checks a file. The first fault, with its offset in the file, if it is not a good one.
    static Result<Model> open(const std::filesystem::path& path, const OpenOptions& options = {});
    /// The same for bytes in memory, which must start on a 16-byte boundary and outlive the character.
    static Result<Model> from_memory(Bytes bytes, const OpenOptions& options = {});

    /// Whether both are handles to one character: a file that was opened twice makes two.
    [[nodiscard]] friend bool operator==(const Model& a, const Model& b) { return a.data_ == b.data_; }

    /// Checks the bytes against their sums, for Sums::later: the first chunk that differs, with its offset. From any
    /// thread, while others use the model; takes about as long as reading the file once.
    [[nodiscard]] Result<void> check_sums() const;

    [[nodiscard]] std::string_view name() const;
    [[nodiscard]] std::span<const Joint> joints() const;
    /// The joints' parents alone: less memory to walk through.
    [[nodiscard]] std::span<const std::uint32_t> parents() const;
    /// Whether some joint has shear.
    [[nodiscard]] bool is_sheared() const;
    [[nodiscard]] std::span<const Mesh> meshes() const;
    [[nodiscard]] std::span<const Clip> clips() const;
    [[nodiscard]] std::span<const Material> materials() const;
    [[nodiscard]] std::span<const Texture> textures() const;
    [[nodiscard]] std::span<const Submesh> submeshes() const;
    /// The sequence in which vertices are collapsed; null if the file has none. Lod plays it.
    [[nodiscard]] const CollapseView* collapse() const;
    /// Each joint's own polygons: for hits, severed limbs, culling.
    [[nodiscard]] std::span<const SubmeshView> joint_submeshes() const;

    /// The joints' constraints, ordered by joint.
    [[nodiscard]] std::span<const Constraint> constraints() const;
    [[nodiscard]] std::span<const Chain> chains() const;
    /// Weights of joints in chains, ordered by chain, then joint; a joint without one has weight 1.
    [[nodiscard]] std::span<const ChainWeightView> chain_weights(const Chain& chain) const;

    /// The first clip, chain or joint of that name; null or kNone if there is none.
    [[nodiscard]] const Clip* clip(std::string_view name) const;
    [[nodiscard]] const Chain* chain(std::string_view name) const;
    [[nodiscard]] std::uint32_t joint(std::string_view name) const;
    /// What a joint must obey in a pose, and what in an IK solver; null if nothing.
    [[nodiscard]] const Constraint* constraint(std::uint32_t joint) const;
    [[nodiscard]] const Constraint* ik_constraint(std::uint32_t joint) const;
    /// The chains' numbers in the order in which several are solved: by ascending priority, then as in the file.
    [[nodiscard]] std::span<const std::uint32_t> chain_order() const;
    /// Links of the longest chain.
    [[nodiscard]] std::uint32_t longest_chain() const;

    /// Vertices of all meshes together, mesh after mesh; and where a mesh's begin.
    [[nodiscard]] std::uint64_t vertex_count() const;
    [[nodiscard]] std::uint64_t first_vertex(std::uint32_t mesh) const;
    /// Morph targets of all meshes together, mesh after mesh; and where a mesh's begin.
    [[nodiscard]] std::uint32_t morph_target_count() const;
    [[nodiscard]] std::uint32_t first_morph_target(std::uint32_t mesh) const;
    /// Entries of the largest bind palette.
    [[nodiscard]] std::uint32_t largest_palette() const;
    /// The joint that moves a vertex of a rigid mesh, or kNone.
    [[nodiscard]] std::uint32_t rigid_mover(std::uint32_t mesh, std::uint32_t vertex) const;
    /// Whether that is the same for all vertices of the mesh.
    [[nodiscard]] bool has_one_mover(std::uint32_t mesh) const;

private:
    friend struct ModelData;
    explicit Model(std::shared_ptr<const ModelData> data) : data_(std::move(data)) {}

    std::shared_ptr<const ModelData> data_;
};

}  // namespace bendy
