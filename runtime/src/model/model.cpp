#include <bendy/runtime/model.h>

#include <bendy/format/chunk_reader.h>

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

/// Returns the submeshes in mesh order, with neighbours of the same material joined: writers order a mesh by material
/// first and joint second, so each material becomes one draw call.
std::vector<Submesh> make_submeshes(std::span<const SubmeshView> of_joints) {
    std::vector<Submesh> submeshes;
    submeshes.reserve(of_joints.size());
    for (const SubmeshView& p : of_joints) submeshes.push_back({p.mesh, p.material, p.topology, p.first, p.count});
    std::sort(submeshes.begin(), submeshes.end(),
              [](const Submesh& a, const Submesh& b) { return std::tie(a.mesh, a.first) < std::tie(b.mesh, b.first); });
    std::size_t last = 0;
    for (std::size_t i = 1; i < submeshes.size(); ++i) {
        Submesh& before = submeshes[last];
        const Submesh& submesh = submeshes[i];
        const bool continues = before.mesh == submesh.mesh && before.material == submesh.material &&
                               before.topology == submesh.topology && before.first + before.count == submesh.first;
        if (continues) {
            before.count += submesh.count;
        } else {
            submeshes[++last] = submesh;
        }
    }
    if (!submeshes.empty()) submeshes.resize(last + 1);
    return submeshes;
}

void build_rig(ModelData& data) {
    SkeletonView& skeleton = data.object.skeleton;
    if (!skeleton.constraints.empty()) data.joint_constraints.resize(data.joints.size());
    data.constraints.reserve(skeleton.constraints.size());
    for (const ConstraintView& constraint : skeleton.constraints) {
        const auto number = static_cast<std::uint32_t>(data.constraints.size());
        const Constraint& made = data.constraints.emplace_back(make_constraint(constraint));
        const glm::quat& rest = data.joints[made.joint].rest.rotation;
        data.rest_frames.push_back(glm::normalize(glm::dquat(rest)) * made.frame);
        JointConstraints& joint_constraints = data.joint_constraints[constraint.joint];
        // A constraint for a specific scope takes precedence over one for all scopes.
        switch (made.scope()) {
            case ConstraintScope::every_pose:
                if (joint_constraints.in_poses == kNone) joint_constraints.in_poses = number;
                if (joint_constraints.in_ik == kNone) joint_constraints.in_ik = number;
                break;
            case ConstraintScope::ik_only:
                joint_constraints.in_ik = number;
                break;
            case ConstraintScope::all_but_ik:
                joint_constraints.in_poses = number;
                break;
        }
    }
    const std::vector<Chain>& chains = data.object.chains;
    for (const Chain& chain : chains) data.longest_chain = std::max(data.longest_chain, chain.links);
    data.chain_order.resize(chains.size());
    std::iota(data.chain_order.begin(), data.chain_order.end(), 0u);
    std::stable_sort(data.chain_order.begin(), data.chain_order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return chains[a].record.priority < chains[b].record.priority;
    });
    std::sort(skeleton.chain_weights.begin(), skeleton.chain_weights.end(),
              [](const ChainWeightView& a, const ChainWeightView& b) {
                  return std::tie(a.chain, a.joint) < std::tie(b.chain, b.joint);
              });
}

std::vector<RigidMovers> find_movers(const ObjectView& object) {
    std::vector<RigidMovers> movers(object.meshes.size());
    for (std::size_t mesh = 0; mesh < movers.size(); ++mesh) movers[mesh].joint = object.meshes[mesh].joint;
    for (const SubmeshView& range : object.skeleton.submeshes) {
        RigidMovers& mover = movers[range.mesh];
        const Mesh& mesh = object.meshes[range.mesh];
        if (!mesh.is_rigid() || range.joint == mover.joint || range.count == 0) continue;
        if (mover.per_vertex.empty()) mover.per_vertex.assign(mesh.vertices, mover.joint);
        for (std::uint32_t k = 0; k < range.count; ++k)
            mover.per_vertex[mesh.indices->index(range.first + k, 0)] = range.joint;
    }
    return movers;
}

/// Returns the index of a part in the list; the list's size if the part is elsewhere, which includes null.
template <class Part>
std::size_t number_in(const std::vector<Part>& list, const Part* part) {
    const std::less<> is_before;
    if (is_before(part, list.data()) || !is_before(part, list.data() + list.size())) return list.size();
    return static_cast<std::size_t>(part - list.data());
}

template <class Part>
Result<void, CallError> check_in(const std::vector<Part>& list, const Part* part) {
    if (number_in(list, part) < list.size()) return {};
    return part == nullptr ? CallError::missing : CallError::other_model;
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
    data->submeshes = make_submeshes(object.skeleton.submeshes);
    data->movers = find_movers(object);
    data->first_vertex.push_back(0);
    data->first_morph_target.push_back(0);
    for (const Mesh& mesh : object.meshes) {
        data->first_vertex.push_back(data->first_vertex.back() + mesh.vertices);
        data->first_morph_target.push_back(data->first_morph_target.back() +
                                           static_cast<std::uint32_t>(mesh.targets.size()));
        data->most_targets = std::max(data->most_targets, mesh.targets.size());
        data->largest_palette = std::max(data->largest_palette, static_cast<std::uint32_t>(mesh.palette.joints.size()));
    }
    return Model(std::move(data));
}

// Not std::call_once: implementations based on pthread_once, as on Windows, wait forever if an earlier call threw.
void ModelData::make_plans() const {
    const std::scoped_lock lock(making_plans);
    if (pose_plan) return;
    std::vector<SkinPlan> plans;
    plans.reserve(object.meshes.size());
    for (const Mesh& mesh : object.meshes) plans.push_back(make_skin_plan(mesh));
    pose_plan = std::make_unique<const PosePlan>(make_pose_plan(object, joints));
    skin_plans = std::move(plans);
}

std::size_t ModelData::number_of(const Clip* clip) const {
    return number_in(object.clips, clip);
}

Result<void, CallError> ModelData::check(const Clip* clip) const {
    return check_in(object.clips, clip);
}

Result<void, CallError> ModelData::check(const Chain* chain) const {
    return check_in(object.chains, chain);
}

Result<Model> Model::open(const std::filesystem::path& path, const OpenOptions& options) {
    Result<MappedFile> file = options.storage == Storage::copied ? MappedFile::read(path) : MappedFile::open(path);
    if (!file) return file.error();
    const Bytes bytes = file->bytes();
    return ModelData::read(std::move(*file), bytes, options);
}

Result<Model> Model::from_memory(Bytes bytes, const OpenOptions& options) {
    return ModelData::read({}, bytes, options);
}

Result<void> Model::check_sums() const {
    // The tree is quick to build again; keeping it would take memory that is rarely needed.
    const Result<ChunkTree> tree = read_chunk_tree(data_->bytes);
    if (!tree) return tree.error();  // the file was modified after it was opened
    Faults faults;
    bendy::check_sums(*tree, faults);
    if (!faults.empty()) return faults.list().front();
    return {};
}

const Clip* Model::clip(std::string_view name) const {
    const auto& clips = data_->object.clips;
    const auto found = std::find_if(clips.begin(), clips.end(), [&](const Clip& clip) { return clip.name == name; });
    return found == clips.end() ? nullptr : &*found;
}

const Chain* Model::chain(std::string_view name) const {
    const auto& chains = data_->object.chains;
    const auto found =
        std::find_if(chains.begin(), chains.end(), [&](const Chain& chain) { return chain.name == name; });
    return found == chains.end() ? nullptr : &*found;
}

std::span<const ChainWeightView> Model::chain_weights(const Chain& chain) const {
    const std::size_t number = number_in(data_->object.chains, &chain);
    const auto less = [](const ChainWeightView& chain_weight, std::size_t other) { return chain_weight.chain < other; };
    const auto& weights = data_->object.skeleton.chain_weights;
    const auto first = std::lower_bound(weights.begin(), weights.end(), number, less);
    const auto last = std::lower_bound(first, weights.end(), number + 1, less);
    return std::span(weights).subspan(static_cast<std::size_t>(first - weights.begin()),
                                      static_cast<std::size_t>(last - first));
}

const Constraint* Model::constraint(std::uint32_t joint) const {
    if (joint >= data_->joint_constraints.size() || data_->joint_constraints[joint].in_poses == kNone) return nullptr;
    return &data_->constraints[data_->joint_constraints[joint].in_poses];
}

const Constraint* Model::ik_constraint(std::uint32_t joint) const {
    const std::uint32_t number = joint < data_->joints.size() ? data_->ik_constraint(joint) : kNone;
    return number == kNone ? nullptr : &data_->constraints[number];
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

std::string_view Model::extras() const {
    return data_->object.extras;
}

std::string_view Model::file_extras() const {
    return data_->document.extras;
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

std::span<const Mesh> Model::meshes() const {
    return data_->object.meshes;
}

std::span<const Clip> Model::clips() const {
    return data_->object.clips;
}

std::span<const Material> Model::materials() const {
    return data_->document.materials;
}

std::span<const Texture> Model::textures() const {
    return data_->document.textures;
}

std::span<const Submesh> Model::submeshes() const {
    return data_->submeshes;
}

const CollapseView* Model::collapse() const {
    return data_->object.collapse ? &*data_->object.collapse : nullptr;
}

std::span<const SubmeshView> Model::joint_submeshes() const {
    return data_->object.skeleton.submeshes;
}

std::span<const Constraint> Model::constraints() const {
    return data_->constraints;
}

std::span<const JointRole> Model::roles() const {
    return data_->object.roles;
}

const StandingPose* Model::standing_pose() const {
    return data_->object.standing_pose ? &*data_->object.standing_pose : nullptr;
}

std::span<const Chain> Model::chains() const {
    return data_->object.chains;
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

std::uint64_t Model::first_vertex(std::uint32_t mesh) const {
    return data_->first_vertex[std::min<std::size_t>(mesh, data_->movers.size())];
}

std::uint32_t Model::morph_target_count() const {
    return data_->first_morph_target.back();
}

std::uint32_t Model::first_morph_target(std::uint32_t mesh) const {
    return data_->first_morph_target[std::min<std::size_t>(mesh, data_->movers.size())];
}

std::uint32_t Model::largest_palette() const {
    return data_->largest_palette;
}

std::uint32_t Model::rigid_mover(std::uint32_t mesh, std::uint32_t vertex) const {
    if (mesh >= data_->movers.size() || vertex >= data_->object.meshes[mesh].vertices) return kNone;
    return data_->rigid_mover(mesh, vertex);
}

bool Model::has_one_mover(std::uint32_t mesh) const {
    return mesh >= data_->movers.size() || data_->movers[mesh].per_vertex.empty();
}

}  // namespace bendy
