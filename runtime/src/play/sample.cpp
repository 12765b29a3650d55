#include <bendy/format/find_key.h>
#include <bendy/format/slerp.h>
#include <bendy/runtime/sample.h>

#include "kernels/flush_denormals.h"
#include "kernels/kernel_table.h"
#include "model/standing_rotations.h"
#include "pose/pose_state.h"
#include "unpack.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace bendy {
namespace {

/// The keys around a time, and the position between them.
struct Interval {
    std::size_t left = 0;
    std::size_t right = 0;  // equal to left if there is nothing to interpolate
    double fraction = 0.0;  // [0, 1)
    double seconds = 0.0;   // from left to right
};

Interval timed_interval(std::span<const float> times, float seconds) {
    const std::size_t left = find_key(
        times.size(), [times](std::size_t key) { return times[key]; }, seconds);
    if (left + 1 == times.size() || !(seconds > times[left])) return {left, left};
    const double length = double{times[left + 1]} - times[left];
    return {left, left + 1, (double{seconds} - times[left]) / length, length};
}

/// Returns the left keys of a group's tracks: find_key of each, but before the last key. The searches do not wait for
/// one another.
TimedKeys search_keys(const TimedGroup& group, float seconds) {
    TimedKeys found{};
    TimedKeys rest{};
    std::copy_n(group.keys, kBlockJoints, rest.begin());
    for (std::uint32_t most = *std::max_element(rest.begin(), rest.end()); most > 1; most -= most / 2) {
        for (std::size_t lane = 0; lane < kBlockJoints; ++lane) {
            const std::uint32_t half = rest[lane] / 2;
            found[lane] += group.times[lane][found[lane] + half] <= seconds ? half : 0;
            rest[lane] -= half;
        }
    }
    for (std::size_t lane = 0; lane < kBlockJoints; ++lane) found[lane] = std::min(found[lane], group.keys[lane] - 2);
    return found;
}

/// Sets them, given any; few steps lead from those of a moment shortly before.
void find_keys(const TimedGroup& group, float seconds, TimedKeys& keys) {
    std::uint32_t missed = 0;  // lanes whose key is too late
    for (std::size_t lane = 0; lane < kBlockJoints; ++lane) {
        keys[lane] = std::min(keys[lane], group.keys[lane] - 2);
        const std::uint32_t is_late = group.times[lane][keys[lane]] > seconds ? 1 : 0;
        missed += is_late & (keys[lane] > 0 ? 1u : 0u);
    }
    constexpr int kMostSteps = 4;
    std::uint32_t steps = 1;  // of all lanes, in the last round
    for (int round = 0; round < kMostSteps && steps > 0 && missed == 0; ++round) {
        steps = 0;
        for (std::size_t lane = 0; lane < kBlockJoints; ++lane) {
            const std::uint32_t is_early = group.times[lane][keys[lane] + 1] <= seconds ? 1 : 0;
            const std::uint32_t step = is_early & (keys[lane] + 2 < group.keys[lane] ? 1u : 0u);
            keys[lane] += step;
            steps += step;
        }
    }
    if (missed + steps > 0) keys = search_keys(group, seconds);
}

Interval frame_interval(const TrackView& track, const Clip& clip, float seconds) {
    const double frame = (double{seconds} - clip.start) * clip.frame_rate;
    const double last = track.keys - 1.0;
    if (!(frame > 0.0)) return {};
    if (frame >= last) return {track.keys - std::size_t{1}, track.keys - std::size_t{1}};
    const double whole = std::floor(frame);
    const auto left = static_cast<std::size_t>(whole);
    if (frame == whole) return {left, left};
    return {left, left + 1, frame - whole, 1.0 / clip.frame_rate};
}

void slerp(std::span<const float> a, std::span<const float> b, double u, std::span<float> out) {
    double dot = 0.0;
    for (std::size_t c = 0; c < 4; ++c) dot += double{a[c]} * b[c];
    const SlerpWeights weights = slerp_weights(dot, u);
    for (std::size_t c = 0; c < 4; ++c) out[c] = static_cast<float>(weights.first * a[c] + weights.second * b[c]);
}

void hermite(std::span<const float> left, std::span<const float> right, const Interval& at, std::span<float> out) {
    const std::size_t n = out.size();  // a key is in-tangent, value, out-tangent, n numbers each
    const double u = at.fraction;
    const double u2 = u * u;
    const double u3 = u2 * u;
    for (std::size_t c = 0; c < n; ++c) {
        const double value = (2.0 * u3 - 3.0 * u2 + 1.0) * left[n + c] +
                             at.seconds * (u3 - 2.0 * u2 + u) * left[2 * n + c] +
                             (-2.0 * u3 + 3.0 * u2) * right[n + c] + at.seconds * (u3 - u2) * right[c];
        out[c] = static_cast<float>(value);
    }
}

void normalise(std::span<float> q) {
    double square = 0.0;
    for (const float c : q) square += double{c} * c;
    if (!(square > 0.0)) return;
    const double length = std::sqrt(square);
    for (float& c : q) c = static_cast<float>(c / length);
}

void set_joint(const TrackView& track, std::span<const float> value, JointTransform& joint) {
    switch (track.path) {
        case TrackPath::translation:
            joint.translation = {value[0], value[1], value[2]};
            break;
        case TrackPath::rotation:
            joint.rotation = glm::quat(value[3], value[0], value[1], value[2]);
            break;
        case TrackPath::scale:
            joint.scale = {value[0], value[1], value[2]};
            break;
        case TrackPath::weights:
            break;
    }
}

Interval find_interval(const TrackView& track, const Clip& clip, float seconds) {
    return track.times.empty() ? frame_interval(track, clip, seconds) : timed_interval(track.times, seconds);
}

void sample_between(const TrackView& track, const Interval& at, std::span<float> value) {
    assert(value.size() == track.components);
    const std::size_t n = value.size();
    const bool cubic = track.interpolation == Interpolation::cubic;
    const std::size_t per_key = cubic ? 3 * n : n;
    const auto key = [&](std::size_t k) { return track.values.subspan(k * per_key, per_key); };
    const auto key_value = [&](std::size_t k) { return key(k).subspan(cubic ? n : 0, n); };

    if (at.left == at.right || track.interpolation == Interpolation::step) {
        std::copy_n(key_value(at.left).begin(), n, value.begin());
        if (cubic && track.path == TrackPath::rotation) normalise(value);
        return;
    }
    if (cubic) {
        hermite(key(at.left), key(at.right), at, value);
        if (track.path == TrackPath::rotation) normalise(value);
        return;
    }
    const auto left = key_value(at.left);
    const auto right = key_value(at.right);
    if (track.path == TrackPath::rotation) {
        slerp(left, right, at.fraction, value);
        return;
    }
    for (std::size_t c = 0; c < n; ++c) {
        value[c] = static_cast<float>((1.0 - at.fraction) * left[c] + at.fraction * right[c]);
    }
}

}  // namespace

void sample_track(const TrackView& track, const Clip& clip, float seconds, std::span<float> value) {
    if (value.size() < track.components) return;
    sample_between(track, find_interval(track, clip, seconds), value.first(track.components));
}

FrameMix mix_frames(const PlayRecord& play, const Clip& clip, float seconds) {
    const double frame = (double{seconds} - clip.start) * clip.frame_rate;
    const std::uint32_t intervals = play.closed != 0 ? play.frames : play.frames - 1;
    const std::uint32_t end = play.closed != 0 ? play.first : play.first + intervals;
    if (!(frame > 0.0)) return {play.first, play.first};
    if (frame >= intervals) return {end, end};
    const double whole = std::floor(frame);
    const auto left = static_cast<std::uint32_t>(whole);
    const std::uint32_t right = left + 1 == play.frames ? 0 : left + 1;
    return {play.first + left, play.first + right, static_cast<float>(frame - whole)};
}

namespace {

/// Samples a clip into a pose.
class Sampling {
public:
    /// \param number  of the clip, which the pose's model has
    Sampling(std::size_t number, float seconds, Pose& pose)
        : number_(number),
          clip_(PoseState::of(pose).data->object.clips[number]),
          seconds_(seconds),
          state_(PoseState::of(pose)),
          model_(*state_.data),
          weights_(pose.change_morph_weights()) {}

    void run() const {
        const SamplePlan& plan = model_.pose_plan->clips[number_];
        const KernelTable& kernels = kernel_table();
        const FlushDenormals flush(kernels.flushes_denormals);
        state_.set_start(clip_.packed ? plan.packed.start : plan.start.empty() ? model_.pose_plan->rest : plan.start);
        sample_plays();
        for (const SampleLine& line : plan.lines) sample_line(line, kernels);
        for (std::size_t k = 0; k < plan.timed.size(); ++k) sample_timed(plan.timed[k], state_.timed_keys[k], kernels);
        if (clip_.packed) unpack(plan.packed, seconds_, joints(), state_.local);
    }

private:
    [[nodiscard]] std::size_t joints() const { return model_.joints.size(); }

    void sample_plays() const {
        for (const PlayRecord& play : clip_.plays) sample_frames(play);
    }

    void sample_frames(const PlayRecord& play) const {
        const Mesh& mesh = model_.object.meshes[play.mesh];
        const FrameMix mix = mix_frames(play, clip_, seconds_);
        const auto add = [&](std::uint32_t frame, float weight) {
            if (frame == 0) return;  // the mesh's own streams have the remaining weight
            weights_[model_.first_morph_target[play.mesh] + mesh.first_frame + frame - 1] += weight;
        };
        add(mix.left, 1.0f - mix.fraction);
        add(mix.right, mix.fraction);
    }

    void sample_line(const SampleLine& line, const KernelTable& kernels) const {
        const Interval at = find_interval(*line.clock, clip_, seconds_);
        for (const TrackView* track : line.others) sample_one(*track, at);
        if (at.left == at.right) {  // tangents have no part in a key
            for (const TrackView* track : line.cubic_tracks) sample_one(*track, at);
        } else if (!line.cubic_tracks.empty()) {
            SampleBlock block = block_of(line.cubic, at);
            block.seconds = static_cast<float>(at.seconds);
            kernels.sample_cubic(block);
        }
        if (line.linear.is_empty()) return;
        SampleBlock block = block_of(line.linear, at);
        if (at.left + 1 == line.clock->keys) {  // at the last key: interpolate fully from the one before it
            block.left = at.left - 1;
            block.fraction = 1.0f;
        }
        kernels.sample(block);
    }

    [[nodiscard]] SampleBlock block_of(const SampleGroups& groups, const Interval& at) const {
        return {groups.rotations.data(),
                groups.rotations.size(),
                groups.vectors.data(),
                groups.vectors.size(),
                groups.tracks.data(),
                groups.tracks.size(),
                at.left,
                static_cast<float>(at.fraction),
                0.0f,
                &state_.local.front().rotation[0][0]};
    }

    void sample_timed(const TimedGroup& group, TimedKeys& keys, const KernelTable& kernels) const {
        find_keys(group, seconds_, keys);
        TimedBlock block{&group.tracks, {}, {}, {}, seconds_, group.is_rotation, &state_.local.front().rotation[0][0]};
        const std::size_t width = group.is_rotation ? 4 : 3;
        for (std::size_t lane = 0; lane < kBlockJoints; ++lane) {
            block.keys[lane] = group.tracks.keys[lane] + width * keys[lane];
            block.left[lane] = group.times[lane][keys[lane]];
            block.right[lane] = group.times[lane][keys[lane] + 1];
        }
        kernels.sample_timed(block);
    }

    void sample_one(const TrackView& track, const Interval& at) const {
        if (track.path == TrackPath::weights) {
            const std::size_t first = model_.first_morph_target[track.target];
            sample_between(track, at, weights_.subspan(first, track.components));
            return;
        }
        std::array<float, 4> value{};
        sample_between(track, at, std::span(value).first(track.components));
        JointTransform joint = state_.local_of(track.target);
        set_joint(track, value, joint);
        state_.set_local(track.target, joint);
    }

    std::size_t number_;
    const Clip& clip_;
    float seconds_;
    PoseState& state_;
    const ModelData& model_;
    std::span<float> weights_;
};

}  // namespace

bool stand(Pose& pose) {
    PoseState& state = PoseState::of(pose);
    state.set_rest();
    for (const StandingJoint& standing : standing_rotations(pose.model()))
        state.set_rotation(standing.joint, standing.rotation);
    return pose.model().standing_pose() != nullptr;
}

Result<void, CallError> sample(Pose& pose, const Clip* clip, float seconds) {
    const ModelData& model = *PoseState::of(pose).data;
    const std::size_t number = model.number_of(clip);
    if (number < model.object.clips.size() && !std::isnan(seconds)) {
        Sampling(number, seconds, pose).run();
        return {};
    }
    pose.set_rest();
    if (clip == nullptr) return CallError::missing;
    return number < model.object.clips.size() ? CallError::not_finite : CallError::other_model;
}

}  // namespace bendy
