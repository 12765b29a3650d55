#include <bendy/runtime/skin.h>

#include <bendy/runtime/kernels.h>
#include <bendy/runtime/local_to_model.h>

#include "kernels/skin_kernel.h"
#include "staging.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace bendy {
namespace {

/// What nothing moves.
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

bool fits(const StridedFloats& memory, std::size_t numbers, std::uint64_t vertices) {
    if (memory.floats.empty() || vertices == 0) return true;
    if (memory.floats.size() < numbers || memory.stride < numbers) return false;
    return vertices - 1 <= (memory.floats.size() - numbers) / memory.stride;
}

bool fits(const VertexBuffer& out, std::uint64_t vertices) {
    return fits(out.positions, 3, vertices) && fits(out.normals, 3, vertices) && fits(out.tangents, 4, vertices);
}

SkinOutput output_at(const StridedFloats& memory, std::uint64_t vertex) {
    if (memory.floats.empty()) return {nullptr, 0};
    return {memory.floats.data() + vertex * memory.stride, memory.stride};
}

/// The same memory; each vector is that many floats without gaps.
template <class Vector>
StridedFloats as_floats(std::span<Vector> vectors) {
    constexpr auto kNumbers = static_cast<std::size_t>(Vector::length());
    static_assert(sizeof(Vector) == kNumbers * sizeof(float));
    if (vectors.empty()) return {};
    return {{&vectors.front().x, vectors.size() * kNumbers}, kNumbers};
}

VertexBuffer as_buffer(const Vertices& out) {
    return {as_floats(out.positions), as_floats(out.normals), as_floats(out.tangents)};
}

}  // namespace

/// The work on a pose's scratch memory.
class Skinning {
public:
    Skinning(const Model& model, Pose& pose) : model_(model), pose_(pose) { assert(&model == &pose.model()); }

    /// The first `vertices` of a pool, vertex 0 at `at` of the output.
    bool skin_pool(std::uint32_t pool, std::uint32_t vertices, std::uint64_t at, const VertexBuffer& out);
    /// Of all pools, each at its place; vertices_of(pool): how many of its first.
    template <class Count>
    bool skin_all(const Count& vertices_of, const VertexBuffer& out) {
        if (!fits(out, model_.vertex_count())) return false;
        for (std::uint32_t pool = 0; pool < model_.pools().size(); ++pool)
            skin_pool(pool, vertices_of(pool), model_.first_vertex(pool), out);
        return true;
    }

private:
    void run(SkinKernel* kernel, Staging& staging, const SkinBlock& wanted, std::size_t first, std::size_t count) const;
    void skin_rigid(std::uint32_t pool, Staging& staging, const SkinBlock& wanted);

    const Model& model_;
    Pose& pose_;
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

void Skinning::skin_rigid(std::uint32_t pool, Staging& staging, const SkinBlock& wanted) {
    SkinKernel* const chosen = skin_kernels(kernel()).linear;
    const std::size_t vertices = wanted.vertices;
    for (std::size_t first = 0; first < vertices;) {
        const std::uint32_t joint = model_.rigid_mover(pool, static_cast<std::uint32_t>(first));
        std::size_t end = first + 1;
        if (model_.has_one_mover(pool)) end = vertices;
        while (end < vertices && model_.rigid_mover(pool, static_cast<std::uint32_t>(end)) == joint) ++end;
        if (joint == kNone) {
            run(copy_block, staging, wanted, first, end - first);
        } else {
            run(pose_.make_rigid_palette(joint) ? chosen : skin_plain, staging, wanted, first, end - first);
        }
        first = end;
    }
}

bool Skinning::skin_pool(std::uint32_t pool_number, std::uint32_t vertices, std::uint64_t at, const VertexBuffer& out) {
    assert(pool_number < model_.pools().size());
    const Pool& pool = model_.pools()[pool_number];
    if (vertices == 0) return true;
    if (pose_.is_stale()) local_to_model(pose_);

    SkinBlock wanted{};
    wanted.vertices = vertices;
    wanted.palette = pose_.palette_.data();
    wanted.out_positions = output_at(out.positions, at);
    wanted.out_normals = output_at(out.normals, at);
    wanted.out_tangents = output_at(out.tangents, at);
    wanted.streams = vertices >= kManyVertices;
    const auto weights =
        std::span(pose_.target_weights_).subspan(model_.first_target(pool_number), pool.targets.size());
    if (pool.is_rigid()) {
        Staging staging(pool, nullptr, weights, wanted);
        skin_rigid(pool_number, staging, wanted);
        return true;
    }
    // Lanes multiply by weights that are zero, too.
    const Kernel chosen = pose_.make_palette(pool_number) ? kernel() : Kernel::plain;
    Staging staging(pool, chosen == Kernel::avx2 ? &model_.plan(pool_number) : nullptr, weights, wanted);
    run(skin_kernels(chosen).linear, staging, wanted, 0, vertices);
    return true;
}

bool skin_into(const Model& model, std::uint32_t pool, Pose& pose, const VertexBuffer& out) {
    const std::uint32_t vertices = model.pools()[pool].vertices;
    return fits(out, vertices) && Skinning(model, pose).skin_pool(pool, vertices, 0, out);
}

bool skin_into(const Model& model, Pose& pose, const VertexBuffer& out) {
    return Skinning(model, pose).skin_all([&](std::uint32_t pool) { return model.pools()[pool].vertices; }, out);
}

bool skin_into(const Model& model, std::uint32_t pool, Pose& pose, const Lod& lod, const VertexBuffer& out) {
    const std::uint32_t vertices = lod.vertices(pool);
    return fits(out, vertices) && Skinning(model, pose).skin_pool(pool, vertices, 0, out);
}

bool skin_into(const Model& model, Pose& pose, const Lod& lod, const VertexBuffer& out) {
    return Skinning(model, pose).skin_all([&](std::uint32_t pool) { return lod.vertices(pool); }, out);
}

bool skin(const Model& model, std::uint32_t pool, Pose& pose, const Vertices& out) {
    return skin_into(model, pool, pose, as_buffer(out));
}

bool skin(const Model& model, Pose& pose, const Vertices& out) {
    return skin_into(model, pose, as_buffer(out));
}

bool skin(const Model& model, std::uint32_t pool, Pose& pose, const Lod& lod, const Vertices& out) {
    return skin_into(model, pool, pose, lod, as_buffer(out));
}

bool skin(const Model& model, Pose& pose, const Lod& lod, const Vertices& out) {
    return skin_into(model, pose, lod, as_buffer(out));
}

}  // namespace bendy
