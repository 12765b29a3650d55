#include <bendy/runtime/skin.h>

#include <bendy/runtime/kernels.h>

#include "dual_skin.h"
#include "kernels/kernel_table.h"
#include "pose/pose_state.h"
#include "staging.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace bendy {
namespace {

/// Copies vertices that no joint moves.
void copy_block(const SkinBlock& block) {
    const auto copy = [&](const float* from, const SkinOutput& out, std::size_t numbers) {
        if (out.data == nullptr) return;
        for (std::size_t vertex = 0; vertex < block.vertices; ++vertex)
            std::copy_n(from + vertex * numbers, numbers, out.data + vertex * out.stride);
    };
    copy(block.positions, block.out_positions, 3);
    copy(block.normals, block.out_normals, 3);
    copy(block.tangents, block.out_tangents, 4);
}

Result<void, CallError> check_room(const StridedFloats& memory, std::size_t numbers, std::uint64_t vertices) {
    if (memory.floats.empty() || vertices == 0) return {};
    if (memory.stride < numbers) return CallError::stride_too_small;
    if (memory.floats.size() < numbers) return CallError::output_too_short;
    if (vertices - 1 > (memory.floats.size() - numbers) / memory.stride) return CallError::output_too_short;
    return {};
}

Result<void, CallError> check_room(const VertexBuffer& out, std::uint64_t vertices) {
    if (const auto room = check_room(out.positions, 3, vertices); !room) return room;
    if (const auto room = check_room(out.normals, 3, vertices); !room) return room;
    return check_room(out.tangents, 4, vertices);
}

SkinOutput output_at(const StridedFloats& memory, std::uint64_t vertex) {
    if (memory.floats.empty()) return {nullptr, 0};
    return {memory.floats.data() + vertex * memory.stride, memory.stride};
}

/// Skins with the pose's scratch memory.
class Skinning {
public:
    /// The pose must not be stale.
    Skinning(PoseState& state, const SkinRequest& request)
        : state_(state), data_(*state.data), method_(request.method), out_(request.out) {}

    /// Skins the first `vertices` of a mesh; vertex 0 is written to `at` of the output.
    void skin_mesh(std::uint32_t mesh_number, std::uint32_t vertices, std::uint64_t at);

private:
    void run(SkinKernel* kernel, Staging& staging, const SkinBlock& wanted, std::size_t first, std::size_t count) const;
    void run_apart(SkinKernel* kernel, Staging& staging, const SkinBlock& wanted) const;
    void skin_rigid(std::uint32_t mesh, SkinKernel* kernel, Staging& staging, const SkinBlock& wanted);

    PoseState& state_;
    const ModelData& data_;
    SkinningMethod method_;
    const VertexBuffer& out_;
    std::uint32_t motions_of_ = kNone;  // the mesh whose motions are in state_.dual
};

void Skinning::run(SkinKernel* kernel, Staging& staging, const SkinBlock& wanted, std::size_t first,
                   std::size_t count) const {
    SkinBlock block = wanted;
    for (const std::size_t end = first + count; first < end; first += block.vertices) {
        block.vertices = std::min(end - first, staging.capacity());
        staging.fill(first, wanted, block);
        kernel(block);
    }
}

/// Skins one vertex at a time, without the bones whose weight is zero: kernels multiply by these weights, too, but not
/// all of the palette is finite.
void Skinning::run_apart(SkinKernel* kernel, Staging& staging, const SkinBlock& wanted) const {
    static constexpr PaletteMatrix kNothing{};
    std::array<std::uint16_t, kMaxInfluences> bones{};
    std::array<float, kMaxInfluences> weights{};
    for (std::size_t vertex = 0; vertex < wanted.vertices; ++vertex) {
        SkinBlock block = wanted;
        block.vertices = 1;
        staging.fill(vertex, wanted, block);
        std::size_t used = 0;
        for (std::size_t k = 0; k < block.influences; ++k) {
            if (block.weights[k] == 0.0f) continue;
            bones[used] = block.bones8 != nullptr ? block.bones8[k] : block.bones16[k];
            weights[used++] = block.weights[k];
        }
        if (used == 0) block.palette = &kNothing;
        block.bones8 = nullptr;
        block.bones16 = bones.data();
        block.weights = weights.data();
        block.influences = std::max<std::size_t>(used, 1);
        kernel(block);
        bones[0] = 0;
    }
}

void Skinning::skin_rigid(std::uint32_t mesh, SkinKernel* kernel, Staging& staging, const SkinBlock& wanted) {
    const std::size_t vertices = wanted.vertices;
    const bool has_one_mover = data_.movers[mesh].per_vertex.empty();
    for (std::size_t first = 0; first < vertices;) {
        const std::uint32_t joint = data_.rigid_mover(mesh, static_cast<std::uint32_t>(first));
        std::size_t end = has_one_mover ? vertices : first + 1;
        while (end < vertices && data_.rigid_mover(mesh, static_cast<std::uint32_t>(end)) == joint) ++end;
        if (joint == kNone) {
            run(copy_block, staging, wanted, first, end - first);
        } else {
            state_.make_rigid_palette(joint);
            run(kernel, staging, wanted, first, end - first);
        }
        first = end;
    }
}

void Skinning::skin_mesh(std::uint32_t mesh_number, std::uint32_t vertices, std::uint64_t at) {
    const Mesh& mesh = data_.object.meshes[mesh_number];
    if (vertices == 0) return;
    SkinBlock wanted{};
    wanted.vertices = vertices;
    wanted.out_positions = output_at(out_.positions, at);
    wanted.out_normals = output_at(out_.normals, at);
    wanted.out_tangents = output_at(out_.tangents, at);
    const auto weights = std::span<const float>(state_.morph_weights)
                             .subspan(data_.first_morph_target[mesh_number], mesh.targets.size());
    if (method_ == SkinningMethod::dual_quaternion && !mesh.is_rigid() &&
        skin_by_dual_quaternions(state_, mesh_number, motions_of_, weights, wanted)) {
        return;
    }
    wanted.palette = state_.palette.data();
    wanted.streams = vertices >= kManyVertices;
    const Kernel chosen = kernel();
    const bool has_eight_lanes = kHasEightLanes && chosen == Kernel::avx2;
    SkinKernel* const skin = kernel_table(chosen).skin;
    if (mesh.is_rigid()) {
        const bool moves = data_.movers[mesh_number].per_vertex.empty() && data_.rigid_mover(mesh_number, 0) != kNone;
        Staging staging(mesh, nullptr, has_eight_lanes && moves, weights, state_.active_targets, wanted);
        skin_rigid(mesh_number, skin, staging, wanted);
        return;
    }
    const bool is_finite = state_.make_palette(mesh_number);
    const SkinPlan* const plan = is_finite && has_eight_lanes ? &data_.skin_plans[mesh_number] : nullptr;
    Staging staging(mesh, plan, has_eight_lanes, weights, state_.active_targets, wanted);
    if (!is_finite) return run_apart(skin, staging, wanted);
    run(skin, staging, wanted, 0, vertices);
}

}  // namespace

Result<void, CallError> skin(Pose& pose, const SkinRequest& request) {
    PoseState& state = PoseState::of(pose);
    const auto& meshes = state.data->object.meshes;
    const bool has_all = request.mesh == kAllMeshes;
    if (!has_all && request.mesh >= meshes.size()) return CallError::out_of_range;
    if (request.lod != nullptr && request.lod->model() != state.model) return CallError::other_model;
    const auto vertices_of = [&](std::uint32_t mesh) {
        return request.lod != nullptr ? request.lod->vertices(mesh) : meshes[mesh].vertices;
    };
    const auto& first_vertex = state.data->first_vertex;
    const auto room = check_room(request.out, has_all ? first_vertex.back() : vertices_of(request.mesh));
    if (!room) return room;
    state.refresh();
    Skinning skinning(state, request);
    if (!has_all) {
        skinning.skin_mesh(request.mesh, vertices_of(request.mesh), 0);
        return {};
    }
    for (std::uint32_t mesh = 0; mesh < meshes.size(); ++mesh)
        skinning.skin_mesh(mesh, vertices_of(mesh), first_vertex[mesh]);
    return {};
}

void prepare_skin(Pose& pose, SkinningMethod method) {
    PoseState& state = PoseState::of(pose);
    if (method == SkinningMethod::dual_quaternion && !state.dual) state.dual.emplace(state.model);
}

}  // namespace bendy
