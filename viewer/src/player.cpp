#include "player.h"

#include <bendy/runtime/blend.h>

#include "overlay.h"

#include <algorithm>
#include <cmath>

namespace bendy::viewer {
namespace {

double length_of(const Clip& clip) {
    return static_cast<double>(clip.end) - static_cast<double>(clip.start);
}

}  // namespace

Player::Player(const Model& model)
    : clip(model.clips().empty() ? kNone : 0), model_(&model), pose_(model), mixed_in_(model) {
    update();
    for (const Chain& chain : model.chains()) {
        const bool has_target = chain.target != kNone;
        chains.push_back({false, has_target ? glm::vec3(pose_.model_space()[chain.target][3]) : tip_of(chain, pose_)});
    }
}

double Player::length() const {
    if (clip >= model_->clips().size()) return 0.0;
    const double own = length_of(model_->clips()[clip]);
    if (other >= model_->clips().size()) return own;
    return own + (length_of(model_->clips()[other]) - own) * static_cast<double>(share);
}

void Player::sample_at_phase(std::uint32_t number, Pose& pose) const {
    const Clip& played = model_->clips()[number];
    (void)sample(pose, &played, played.start + phase * (played.end - played.start));
}

void Player::step(double seconds) {
    const double whole = length();
    if (is_playing && whole > 0.0) {
        const double next = static_cast<double>(phase) + seconds * static_cast<double>(speed) / whole;
        phase = static_cast<float>(next - std::floor(next));
    }
    update();
}

void Player::update() {
    if (clip < model_->clips().size()) {
        sample_at_phase(clip, pose_);
        if (other < model_->clips().size()) {
            sample_at_phase(other, mixed_in_);
            (void)blend(pose_, mixed_in_, share);
        }
    } else {
        pose_.set_rest();
    }
    if (obeys_constraints) constrain(pose_);
    ReachOptions options;
    options.carry_target = true;
    for (const std::uint32_t number : model_->chain_order()) {
        if (number < chains.size() && chains[number].is_on)
            (void)reach(pose_, &model_->chains()[number], chains[number].target, options);
    }
}

}  // namespace bendy::viewer
