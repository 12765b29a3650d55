#include <bendy/runtime/pose.h>

#include <bendy/runtime/local_to_model.h>

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
    const std::span<JointTransform> local = change_local();
    const auto joints = model_->joints();
    for (std::size_t joint = 0; joint < joints.size(); ++joint) local[joint] = joints[joint].rest;
    std::size_t weight = 0;
    for (const Pool& pool : model_->pools()) {
        for (const TargetView& target : pool.targets) target_weights_[weight++] = target.rest_weight;
    }
}

}  // namespace bendy
