#include <bendy/runtime/local_to_model.h>
#include <bendy/runtime/pose.h>

#include "kernels/pose_kernels.h"
#include "plan/palette_rows.h"
#include "plan/pose_plan.h"

#include <algorithm>
#include <span>

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

bool Pose::make_palette(std::uint32_t pool) {
    pool = model_->pose_plan().same_palette[pool];
    if (palette_pool_ == pool) return is_palette_finite_;
    palette_pool_ = pool;
    is_palette_finite_ = true;
    const PaletteView& palette = model_->pools()[pool].palette;
    if (palette.joints.empty()) return true;
    const PoseKernels* const kernels = pose_kernels();
    if (kernels != nullptr && !is_exact_) {
        const std::vector<PaletteMatrix>& inverse_bind = model_->pose_plan().inverse_bind[pool];
        is_palette_finite_ = kernels->palette({palette.joints.size(), &model_space_.front().matrix[0].x,
                                               palette.joints.data(), inverse_bind.data(), palette_.data()});
        return is_palette_finite_;
    }
    const auto inverse_bind = palette.inverse_bind();
    for (std::size_t entry = 0; entry < palette.joints.size(); ++entry) {
        // Large translations cancel here, which a product of floats would not survive.
        palette_[entry] = to_rows(exact_model_space(palette.joints[entry]) * glm::dmat4(inverse_bind[entry]));
        is_palette_finite_ = is_palette_finite_ && is_finite(palette_[entry]);
    }
    return is_palette_finite_;
}

bool Pose::make_rigid_palette(std::uint32_t joint) {
    palette_pool_ = kNone;
    palette_.front() = to_rows(exact_model_space(joint));
    return is_finite(palette_.front());
}

std::span<const PaletteMatrix> Pose::palette(std::uint32_t pool) {
    if (is_stale_) local_to_model(*this);
    make_palette(pool);
    return std::span(palette_).first(model_->pools()[pool].palette.joints.size());
}

}  // namespace bendy
