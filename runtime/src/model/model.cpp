#include <bendy/runtime/model.h>

#include <bendy/format/check_sums.h>
#include <bendy/format/decode_leaves.h>

#include "model_data.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <tuple>
#include <utility>

namespace bendy {
namespace {

Joint make_joint(const JointView& view) {
    const RestRecord& rest = view.rest;
    Joint joint;
    joint.parent = view.parent;
    joint.rest.rotation = glm::quat(rest.rotation[3], rest.rotation[0], rest.rotation[1], rest.rotation[2]);
    joint.rest.translation = {rest.translation[0], rest.translation[1], rest.translation[2]};
    joint.rest.scale = {rest.scale[0], rest.scale[1], rest.scale[2]};
    joint.shear = {rest.shear[0], rest.shear[1], rest.shear[2]};
    joint.name = view.name;
    joint.extras = view.extras;
    return joint;
}

/// The polygon ranges in pool order, neighbours of one material joined: writers order a pool by material first and
/// joint second, so each material comes out as one draw.
std::vector<Draw> make_draws(std::span<const PolygonView> polygons) {
    std::vector<Draw> draws;
    draws.reserve(polygons.size());
    for (const PolygonView& p : polygons) draws.push_back({p.pool, p.material, p.topology, p.first, p.count});
    std::sort(draws.begin(), draws.end(),
              [](const Draw& a, const Draw& b) { return std::tie(a.pool, a.first) < std::tie(b.pool, b.first); });
    std::size_t last = 0;
    for (std::size_t i = 1; i < draws.size(); ++i) {
        Draw& before = draws[last];
        const Draw& draw = draws[i];
        const bool continues = before.pool == draw.pool && before.material == draw.material &&
                               before.topology == draw.topology && before.first + before.count == draw.first;
        if (continues) {
            before.count += draw.count;
        } else {
            draws[++last] = draw;
        }
    }
    if (!draws.empty()) draws.resize(last + 1);
    return draws;
}

Chain make_chain(const ChainView& view, std::uint32_t number, std::span<const std::uint32_t> depths) {
    Chain chain;
    chain.name = view.name;
    chain.number = number;
    chain.record = view.record;
    chain.start = view.record.start;
    chain.effector = view.record.effector;
    chain.links = depths[chain.effector] - depths[chain.start] + 1;
    chain.target = view.record.target;
    chain.pole = view.record.pole;
    chain.solver = static_cast<Solver>(view.record.solver);
    chain.extras = view.extras;
    return chain;
}

void build_rig(ModelData& data) {
    const SkeletonView& skeleton = data.object.skeleton;
    if (!skeleton.limits.empty()) data.obeyed.resize(data.joints.size());
    data.constraints.reserve(skeleton.limits.size());
    for (const LimitView& limit : skeleton.limits) {
        const auto number = static_cast<std::uint32_t>(data.constraints.size());
        data.constraints.push_back(make_constraint(limit));
        Obeyed& obeyed = data.obeyed[limit.joint];
        // What is meant for one purpose goes before what is meant for every one.
        switch (data.constraints.back().scope) {
            case LimitScope::every_pose:
                if (obeyed.in_poses == kNone) obeyed.in_poses = number;
                if (obeyed.in_ik == kNone) obeyed.in_ik = number;
                break;
            case LimitScope::ik_only:
                obeyed.in_ik = number;
                break;
            case LimitScope::all_but_ik:
                obeyed.in_poses = number;
                break;
        }
    }
    if (data.object.chains.empty()) return;
    std::vector<std::uint32_t> depths(data.joints.size());
    for (std::size_t joint = 0; joint < depths.size(); ++joint) {
        const std::uint32_t parent = data.joints[joint].parent;
        depths[joint] = parent == kNone ? 0 : depths[parent] + 1;
    }
    for (const ChainView& view : data.object.chains) {
        data.chains.push_back(make_chain(view, static_cast<std::uint32_t>(data.chains.size()), depths));
        data.longest_chain = std::max(data.longest_chain, data.chains.back().links);
    }
    data.chain_order.resize(data.chains.size());
    std::iota(data.chain_order.begin(), data.chain_order.end(), 0u);
    std::stable_sort(data.chain_order.begin(), data.chain_order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return data.chains[a].record.priority < data.chains[b].record.priority;
    });
    data.weights = skeleton.pulls;
    std::sort(data.weights.begin(), data.weights.end(), [](const PullView& a, const PullView& b) {
        return std::tie(a.chain, a.joint) < std::tie(b.chain, b.joint);
    });
}

std::vector<RigidMovers> find_movers(const ObjectView& object) {
    std::vector<RigidMovers> movers(object.pools.size());
    for (std::size_t pool = 0; pool < movers.size(); ++pool) movers[pool].joint = object.pools[pool].joint;
    for (const PolygonView& range : object.skeleton.polygons) {
        RigidMovers& mover = movers[range.pool];
        const Pool& pool = object.pools[range.pool];
        if (!pool.is_rigid() || range.joint == mover.joint || range.count == 0) continue;
        if (mover.per_vertex.empty()) mover.per_vertex.assign(pool.vertices, mover.joint);
        for (std::uint32_t k = 0; k < range.count; ++k)
            mover.per_vertex[pool.indices->index(range.first + k, 0)] = range.joint;
    }
    return movers;
}

}  // namespace

Result<Model> ModelData::read(MappedFile file, Bytes bytes, const OpenOptions& options) {
    Result<ChunkTree> tree = read_chunk_tree(bytes);
    if (!tree) return tree.error();
    Faults faults;
    if (options.sums == Sums::checked) bendy::check_sums(*tree, faults);
    std::unique_ptr<ModelData> data = std::make_unique<ModelData>();
    if (faults.empty()) {
        decode_leaves(*tree);
        data->document = read_document(*tree, faults);
    }
    if (!faults.empty()) return faults.list().front();
    if (options.object >= data->document.objects.size()) {
        return Error{ErrorCode::kChunkMissing, 0, FourCC("OBJE").value};
    }
    data->file = std::move(file);
    data->bytes = bytes;
    data->decoded = std::move(*tree).take_decoded();
    data->object = std::move(data->document.objects[options.object]);
    data->document.objects.clear();

    const ObjectView& object = data->object;
    data->joints.reserve(object.skeleton.joints.size());
    data->parents.reserve(object.skeleton.joints.size());
    for (const JointView& view : object.skeleton.joints) {
        const Joint joint = make_joint(view);
        data->joints.push_back(joint);
        data->parents.push_back(joint.parent);
        data->is_sheared = data->is_sheared || joint.shear != glm::vec3(0.0f);
    }
    build_rig(*data);
    data->draws = make_draws(object.skeleton.polygons);
    data->movers = find_movers(object);
    data->first_vertex.push_back(0);
    data->first_target.push_back(0);
    for (const Pool& pool : object.pools) {
        data->first_vertex.push_back(data->first_vertex.back() + pool.vertices);
        data->first_target.push_back(data->first_target.back() + static_cast<std::uint32_t>(pool.targets.size()));
        data->largest_palette = std::max(data->largest_palette, static_cast<std::uint32_t>(pool.palette.joints.size()));
    }
    return Model(std::move(data));
}

// Not std::call_once: where that is pthread_once, as on Windows, it waits for ever for one that ended by an exception.
void ModelData::make_plans() const {
    const std::scoped_lock lock(making_plans);
    if (pose_plan) return;
    std::vector<SkinPlan> plans;
    plans.reserve(object.pools.size());
    for (const Pool& pool : object.pools) plans.push_back(make_skin_plan(pool));
    pose_plan = std::make_unique<const PosePlan>(make_pose_plan(object, joints));
    skin_plans = std::move(plans);
}

std::size_t ModelData::number_of(const Cycle& cycle) const {
    const auto& cycles = object.cycles;
    const std::less<> is_before;
    if (is_before(&cycle, cycles.data()) || !is_before(&cycle, cycles.data() + cycles.size())) return cycles.size();
    return static_cast<std::size_t>(&cycle - cycles.data());
}

Result<Model> Model::open(const std::filesystem::path& path, const OpenOptions& options) {
    Result<MappedFile> file = MappedFile::open(path);
    if (!file) return file.error();
    const Bytes bytes = file->bytes();
    return ModelData::read(std::move(*file), bytes, options);
}

Result<Model> Model::from_memory(Bytes bytes, const OpenOptions& options) {
    return ModelData::read({}, bytes, options);
}

Result<void> Model::check_sums() const {
    // The tree of a good file is quickly made again; kept, it would take memory that hardly anybody asks for.
    const Result<ChunkTree> tree = read_chunk_tree(data_->bytes);
    if (!tree) return tree.error();  // the file was changed after it was opened
    Faults faults;
    bendy::check_sums(*tree, faults);
    if (!faults.empty()) return faults.list().front();
    return {};
}

const Cycle* Model::cycle(std::string_view name) const {
    const auto& cycles = data_->object.cycles;
    const auto found =
        std::find_if(cycles.begin(), cycles.end(), [&](const Cycle& cycle) { return cycle.name == name; });
    return found == cycles.end() ? nullptr : &*found;
}

const Chain* Model::chain(std::string_view name) const {
    const auto& chains = data_->chains;
    const auto found =
        std::find_if(chains.begin(), chains.end(), [&](const Chain& chain) { return chain.name == name; });
    return found == chains.end() ? nullptr : &*found;
}

std::span<const PullView> Model::chain_weights(const Chain& chain) const {
    const auto less = [](const PullView& pull, std::uint32_t number) { return pull.chain < number; };
    const auto& weights = data_->weights;
    const auto first = std::lower_bound(weights.begin(), weights.end(), chain.number, less);
    const auto last = std::lower_bound(first, weights.end(), chain.number + 1, less);
    return {first, last};
}

const Constraint* Model::constraint(std::uint32_t joint) const {
    if (data_->obeyed.empty() || data_->obeyed[joint].in_poses == kNone) return nullptr;
    return &data_->constraints[data_->obeyed[joint].in_poses];
}

const Constraint* Model::ik_constraint(std::uint32_t joint) const {
    if (data_->obeyed.empty() || data_->obeyed[joint].in_ik == kNone) return nullptr;
    return &data_->constraints[data_->obeyed[joint].in_ik];
}

std::uint32_t Model::joint(std::string_view name) const {
    const auto& joints = data_->joints;
    const auto found =
        std::find_if(joints.begin(), joints.end(), [&](const Joint& joint) { return joint.name == name; });
    return found == joints.end() ? kNone : static_cast<std::uint32_t>(found - joints.begin());
}

std::string_view Model::name() const {
    return data_->object.name;
}

std::span<const Joint> Model::joints() const {
    return data_->joints;
}

std::span<const std::uint32_t> Model::parents() const {
    return data_->parents;
}

bool Model::is_sheared() const {
    return data_->is_sheared;
}

std::span<const Pool> Model::pools() const {
    return data_->object.pools;
}

std::span<const Cycle> Model::cycles() const {
    return data_->object.cycles;
}

std::span<const Material> Model::materials() const {
    return data_->document.materials;
}

std::span<const Texture> Model::textures() const {
    return data_->document.textures;
}

std::span<const Draw> Model::draws() const {
    return data_->draws;
}

const CollapseView* Model::collapse() const {
    return data_->object.collapse ? &*data_->object.collapse : nullptr;
}

std::span<const PolygonView> Model::polygons() const {
    return data_->object.skeleton.polygons;
}

std::span<const Constraint> Model::constraints() const {
    return data_->constraints;
}

std::span<const Chain> Model::chains() const {
    return data_->chains;
}

std::span<const std::uint32_t> Model::chain_order() const {
    return data_->chain_order;
}

std::uint32_t Model::longest_chain() const {
    return data_->longest_chain;
}

std::uint64_t Model::vertex_count() const {
    return data_->first_vertex.back();
}

std::uint64_t Model::first_vertex(std::uint32_t pool) const {
    return data_->first_vertex[pool];
}

std::uint32_t Model::target_count() const {
    return data_->first_target.back();
}

std::uint32_t Model::first_target(std::uint32_t pool) const {
    return data_->first_target[pool];
}

std::uint32_t Model::largest_palette() const {
    return data_->largest_palette;
}

std::uint32_t Model::rigid_mover(std::uint32_t pool, std::uint32_t vertex) const {
    return data_->rigid_mover(pool, vertex);
}

bool Model::has_one_mover(std::uint32_t pool) const {
    return data_->movers[pool].per_vertex.empty();
}

}  // namespace bendy
