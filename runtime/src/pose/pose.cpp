#include <bendy/runtime/pose.h>

#include <bendy/runtime/local_to_model.h>

#include "plan/pose_plan.h"

#include <algorithm>

namespace bendy {

Pose::Pose(const Model& model)
    : model_(&model),
      local_(model.joints().size()),
      model_space_(model.joints().size()),
      exact_model_space_(model.joints().size()),
      target_weights_(model.target_count()),
      ik_links_(model.longest_chain()),
      palette_(std::max(model.largest_palette(), 1u)) {
    model.make_plans();
    set_rest();
    local_to_model(*this);
}

void Pose::set_rest() {
    const PosePlan& plan = model_->pose_plan();
    is_stale_ = true;
    std::copy(plan.rest.begin(), plan.rest.end(), local_.begin());
    std::copy(plan.rest_weights.begin(), plan.rest_weights.end(), target_weights_.begin());
}

}  // namespace bendy
