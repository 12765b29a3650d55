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
#include <mutex>
#include <span>
#include <string_view>
#include <vector>

namespace bendy {

class Sampling;  // not exported
class Skinning;

}  // namespace bendy

namespace BENDY_PUBLIC bendy {

// The format's views are the runtime's data: they lie in the mapped file.
using Cycle = CycleView;
using Pool = PoolView;
using Material = MaterialView;
using Texture = TextureView;

class Pose;
struct PosePlan;
struct SkinPlan;

struct Joint {
    std::uint32_t parent = kNone;  ///< smaller than the joint's own number; kNone: a root
    JointTransform rest;           ///< relative to the parent
    glm::vec3 shear{0.0f};         ///< part of the local matrix that no cycle changes: see transform.h
    std::string_view name;         ///< UTF-8; may be empty, may be doubled
    std::string_view extras;       ///< JSON of the author's, or empty
};

/// A range of a pool's index list with one material: what one draw call draws.
struct Draw {
    std::uint32_t pool = 0;
    std::uint32_t material = kNone;  ///< into Model::materials(), or kNone
    Topology topology = Topology::triangles;
    std::uint32_t first = 0;  ///< in Pool::indices
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

/// A character: the mapped file and a linear array of its joints, parents before children.
class Model {
public:
    /// Maps and checks a file. The first fault, with its offset in the file, if it is not a good one.
    static Result<Model> open(const std::filesystem::path& path, const OpenOptions& options = {});
    /// The same for bytes in memory, which must start on a 16-byte boundary and outlive the model.
    static Result<Model> from_memory(Bytes bytes, const OpenOptions& options = {});

    /// Holds the bytes against their sums, for Sums::later: the first chunk that differs, with its offset. From any
    /// thread, while others use the model; takes about as long as reading the file once.
    [[nodiscard]] Result<void> check_sums() const;

    [[nodiscard]] std::string_view name() const { return data_->object.name; }
    [[nodiscard]] std::span<const Joint> joints() const { return data_->joints; }
    /// The joints' parents alone: less memory to walk through.
    [[nodiscard]] std::span<const std::uint32_t> parents() const { return data_->parents; }
    /// Whether some joint has shear.
    [[nodiscard]] bool is_sheared() const { return data_->is_sheared; }
    [[nodiscard]] std::span<const Pool> pools() const { return data_->object.pools; }
    [[nodiscard]] std::span<const Cycle> cycles() const { return data_->object.cycles; }
    [[nodiscard]] std::span<const Material> materials() const { return data_->document.materials; }
    [[nodiscard]] std::span<const Texture> textures() const { return data_->document.textures; }
    [[nodiscard]] std::span<const Draw> draws() const { return data_->draws; }
    /// The sequence in which vertices are collapsed; null if the file has none. Lod plays it.
    [[nodiscard]] const CollapseView* collapse() const {
        return data_->object.collapse ? &*data_->object.collapse : nullptr;
    }
    /// Each joint's own polygons: for hits, severed limbs, culling.
    [[nodiscard]] std::span<const PolygonView> polygons() const { return data_->object.skeleton.polygons; }

    /// The joints' constraints, ordered by joint.
    [[nodiscard]] std::span<const Constraint> constraints() const { return data_->constraints; }
    [[nodiscard]] std::span<const Chain> chains() const { return data_->chains; }
    /// Weights of joints in chains, ordered by chain, then joint; a joint without one has weight 1.
    [[nodiscard]] std::span<const PullView> chain_weights(const Chain& chain) const;

    /// The first cycle, chain or joint of that name; null or kNone if there is none.
    [[nodiscard]] const Cycle* cycle(std::string_view name) const;
    [[nodiscard]] const Chain* chain(std::string_view name) const;
    [[nodiscard]] std::uint32_t joint(std::string_view name) const;
    /// What a joint must obey in a pose, and what in an IK solver; null if nothing.
    [[nodiscard]] const Constraint* constraint(std::uint32_t joint) const;
    [[nodiscard]] const Constraint* ik_constraint(std::uint32_t joint) const;
    /// The chains' numbers in the order in which several are solved: by ascending priority, then as in the file.
    [[nodiscard]] std::span<const std::uint32_t> chain_order() const { return data_->chain_order; }
    /// Links of the longest chain.
    [[nodiscard]] std::uint32_t longest_chain() const { return data_->longest_chain; }

    /// Vertices of all pools together, pool after pool; and where a pool's begin.
    [[nodiscard]] std::uint64_t vertex_count() const { return data_->first_vertex.back(); }
    [[nodiscard]] std::uint64_t first_vertex(std::uint32_t pool) const { return data_->first_vertex[pool]; }
    /// Inbetweening targets of all pools together, pool after pool; and where a pool's begin.
    [[nodiscard]] std::uint32_t target_count() const { return data_->first_target.back(); }
    [[nodiscard]] std::uint32_t first_target(std::uint32_t pool) const { return data_->first_target[pool]; }
    /// Entries of the largest bind palette.
    [[nodiscard]] std::uint32_t largest_palette() const { return data_->largest_palette; }
    /// The joint that moves a vertex of a rigid pool, or kNone.
    [[nodiscard]] std::uint32_t rigid_mover(std::uint32_t pool, std::uint32_t vertex) const;
    /// Whether that is the same for all vertices of the pool.
    [[nodiscard]] bool has_one_mover(std::uint32_t pool) const { return data_->movers[pool].per_vertex.empty(); }

private:
    friend class DualSkinning;
    friend class Pose;
    friend class Sampling;
    friend class Skinning;
    friend void local_to_model(Pose& pose);

    struct RigidMovers {
        std::uint32_t joint = kNone;            // of every vertex, if per_vertex is empty: the pool's own
        std::vector<std::uint32_t> per_vertex;  // only for a pool with polygons of other joints
    };
    struct Obeyed {
        std::uint32_t in_poses = kNone;  // into constraints
        std::uint32_t in_ik = kNone;
    };
    struct Data {
        MappedFile file;
        Bytes bytes;           // the whole file: of `file`, or the caller's
        AlignedBytes decoded;  // what the file has encoded; the document's views lie in either
        Document document;
        ObjectView object;
        std::vector<Joint> joints;
        std::vector<std::uint32_t> parents;  // as joints
        bool is_sheared = false;
        std::vector<Draw> draws;
        std::vector<std::uint64_t> first_vertex;  // one more than pools
        std::vector<std::uint32_t> first_target;  // one more than pools
        std::vector<RigidMovers> movers;          // one per pool
        std::uint32_t largest_palette = 0;
        std::vector<Constraint> constraints;
        std::vector<Obeyed> obeyed;  // one per joint, if there are constraints
        std::vector<Chain> chains;
        std::vector<std::uint32_t> chain_order;
        std::vector<PullView> weights;  // by chain, then joint
        std::uint32_t longest_chain = 0;
        mutable std::mutex making_plans;  // by the first Pose
        mutable std::unique_ptr<const PosePlan> pose_plan;
        mutable std::vector<SkinPlan> plans;  // one per pool
    };

    struct DeleteData {
        void operator()(const Data* data) const;  // where SkinPlan is known
    };
    explicit Model(const Data* data) : data_(data) {}
    static Result<Model> build(MappedFile file, Bytes bytes, const OpenOptions& options);
    static std::vector<RigidMovers> find_movers(const ObjectView& object);
    static void build_rig(Data& data);
    /// What posing and skinning need beside the file's own streams: made once, before it is asked for.
    void make_plans() const;
    /// Of a cycle among cycles(); as many as there are, if it is not one of them.
    [[nodiscard]] std::size_t number_of(const Cycle& cycle) const;
    [[nodiscard]] const PosePlan& pose_plan() const { return *data_->pose_plan; }
    [[nodiscard]] const SkinPlan& plan(std::uint32_t pool) const;

    // Behind a pointer, so that views into it survive a move of the Model.
    std::unique_ptr<const Data, DeleteData> data_;
};

}  // namespace bendy
