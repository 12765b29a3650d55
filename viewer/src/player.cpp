#include "player.h"

#include <bendy/runtime/blend.h>

#include "overlay.h"

#include <algorithm>
#include <cmath>

namespace bendy::viewer {
namespace {

double length_of(const Cycle& cycle) {
    return static_cast<double>(cycle.end) - static_cast<double>(cycle.start);
}

}  // namespace

Player::Player(const Model& model)
    : cycle(model.cycles().empty() ? kNone : 0), model_(&model), pose_(model), mixed_in_(model) {
    update();
    for (const Chain& chain : model.chains()) {
        const bool has_target = chain.target != kNone;
        chains.push_back({false, has_target ? glm::vec3(pose_.model_space()[chain.target][3]) : tip_of(chain, pose_)});
    }
}

double Player::length() const {
    if (cycle >= model_->cycles().size()) return 0.0;
    const double own = length_of(model_->cycles()[cycle]);
    if (other >= model_->cycles().size()) return own;
    return own + (length_of(model_->cycles()[other]) - own) * static_cast<double>(share);
}

void Player::sample_at_phase(std::uint32_t number, Pose& pose) const {
    const Cycle& played = model_->cycles()[number];
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
    if (cycle < model_->cycles().size()) {
        sample_at_phase(cycle, pose_);
        if (other < model_->cycles().size()) {
            sample_at_phase(other, mixed_in_);
            (void)blend(pose_, mixed_in_, share);
        }
    } else {
        pose_.set_rest();
    }
    if (obeys_limits) constrain(pose_);
    ReachOptions options;
    options.carry_target = true;
    for (const std::uint32_t number : model_->chain_order()) {
        if (number < chains.size() && chains[number].is_on)
            (void)reach(pose_, &model_->chains()[number], chains[number].target, options);
    }
}

}  // namespace bendy::viewer
