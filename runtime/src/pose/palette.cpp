#include "kernels/flush_denormals.h"
#include "kernels/pose_kernels.h"
#include "plan/palette_rows.h"
#include "pose_state.h"

#include <algorithm>

namespace bendy {
namespace {

bool is_finite(const PaletteMatrix& entry) {
    float sum = 0.0f;
    for (const auto& row : entry.rows) {
        for (const float number : row) sum += 0.0f * number;
    }
    return sum == 0.0f;
}

}  // namespace

bool PoseState::make_palette(std::uint32_t mesh) {
    mesh = data->pose_plan->same_palette[mesh];
    if (palette_mesh == mesh) return is_palette_finite;
    palette_mesh = mesh;
    is_palette_finite = compute_palette(mesh, palette.data());
    return is_palette_finite;
}

void PoseState::write_palette(std::uint32_t mesh, std::span<PaletteMatrix> out) const {
    mesh = data->pose_plan->same_palette[mesh];
    if (palette_mesh == mesh) {
        std::copy_n(palette.begin(), out.size(), out.begin());
    } else {
        (void)compute_palette(mesh, out.data());
    }
}

bool PoseState::compute_palette(std::uint32_t mesh, PaletteMatrix* out) const {
    const PaletteView& bind = data->object.meshes[mesh].palette;
    if (bind.joints.empty()) return true;
    const PoseKernels* const kernels = pose_kernels();
    if (kernels != nullptr && !is_exact) {
        const std::vector<PaletteMatrix>& inverse_bind = data->pose_plan->inverse_bind[mesh];
        const FlushDenormals flush;
        return kernels->palette(
            {bind.joints.size(), &model_space.front().matrix[0].x, bind.joints.data(), inverse_bind.data(), out});
    }
    const auto inverse_bind = bind.inverse_bind();
    bool are_finite = true;
    for (std::size_t entry = 0; entry < bind.joints.size(); ++entry) {
        // Large translations cancel here, so the product must be computed in doubles.
        out[entry] = to_rows(exact_matrix(bind.joints[entry]) * glm::dmat4(inverse_bind[entry]));
        are_finite = are_finite && is_finite(out[entry]);
    }
    return are_finite;
}

bool PoseState::make_rigid_palette(std::uint32_t joint) {
    palette_mesh = kNone;
    palette.front() = to_rows(exact_matrix(joint));
    return is_finite(palette.front());
}

}  // namespace bendy
