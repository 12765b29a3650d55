#include "kernels/pose_kernels.h"
#include "plan/palette_rows.h"
#include "pose_state.h"

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
    PaletteStatus& status = palette_statuses[mesh];
    if (status != PaletteStatus::stale) return status == PaletteStatus::finite;
    const PaletteView& bind = data->object.meshes[mesh].palette;
    PaletteMatrix* const palette = palettes.data() + data->pose_plan->first_entry[mesh];
    const PoseKernels* const kernels = pose_kernels();
    bool are_finite = true;
    if (kernels != nullptr && !is_exact && !bind.joints.empty()) {
        const std::vector<PaletteMatrix>& inverse_bind = data->pose_plan->inverse_bind[mesh];
        are_finite = kernels->palette(
            {bind.joints.size(), &model_space.front().matrix[0].x, bind.joints.data(), inverse_bind.data(), palette});
    } else {
        const auto inverse_bind = bind.inverse_bind();
        for (std::size_t entry = 0; entry < bind.joints.size(); ++entry) {
            // Large translations cancel here, so the product must be computed in doubles.
            palette[entry] = to_rows(exact_matrix(bind.joints[entry]) * glm::dmat4(inverse_bind[entry]));
            are_finite = are_finite && is_finite(palette[entry]);
        }
    }
    status = are_finite ? PaletteStatus::finite : PaletteStatus::not_finite;
    return are_finite;
}

bool PoseState::make_rigid_palette(std::uint32_t joint) {
    rigid_palette = to_rows(exact_matrix(joint));
    return is_finite(rigid_palette);
}

}  // namespace bendy
