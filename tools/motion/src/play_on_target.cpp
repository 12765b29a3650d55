#include "play_on_target.h"

#include "linear_keys.h"
#include "sample_times.h"
#include "spread_jumps.h"

#include <bendy/motion/retarget_clips.h>
#include <bendy/runtime/constrain.h>
#include <bendy/runtime/curve.h>
#include <bendy/runtime/sample.h>
#include <bendy/runtime/turn.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace bendy::motion {
namespace {

/// Numbers of a clip's samples, all joints together: bounds the memory for long clips.
constexpr std::size_t kMostNumbers = 40'000'000;
constexpr std::size_t kNumbers = 10;  // of a joint
constexpr double kStretched = 0.01;   // of a joint's distance from its parent, and of its scale
constexpr double kUneven = 0.002;     // radians: more samples are made where a joint is farther off halfway between two
constexpr unsigned kHalvings = 3;     // of the time between two samples
constexpr float kClosest = 5e-4f;     // seconds
constexpr float kInstant = 1e-5f;     // seconds, in which a track steps
constexpr double kOutside = 2e-5;     // radians: more samples are made where a joint is farther outside its limits

bool are_same(const JointTransform& a, const JointTransform& b) {
    return a.rotation == b.rotation && a.translation == b.translation && a.scale == b.scale;
}

/// Returns how many metres a number of a translation is, at most.
double unit_of(const glm::mat4& matrix) {
    double most = 1e-9;
    for (int axis = 0; axis < 3; ++axis) most = std::max(most, double{glm::length(glm::vec3(matrix[axis]))});
    return most;
}

/// The joints' numbers in one sample.
using Frame = std::vector<JointTransform>;

/// What Retarget says at a time.
struct Sample {
    float seconds = 0.0f;
    Retargeted done;
    Frame frame;
    Frame source;  ///< of the source
    std::vector<float> weights;
    std::vector<double> off;  ///< by shared bone: radians between its direction and the source's
};

Frame frame_of(const Pose& pose) {
    Frame frame;
    const auto joints = static_cast<std::uint32_t>(pose.model().joints().size());
    frame.reserve(joints);
    for (std::uint32_t joint = 0; joint < joints; ++joint) frame.push_back(pose.local(joint));
    return frame;
}

std::array<const Curve*, kContacts> contact_curves(const Clip& clip) {
    std::array<const Curve*, kContacts> curves{};
    for (std::size_t k = 0; k < kContacts; ++k) {
        curves[k] = find_curve(clip, kContactNames[k]);
        if (curves[k] != nullptr && curves[k]->components != 1) curves[k] = nullptr;
    }
    return curves;
}

class Following {
public:
    Following(Retarget& retarget, BoneComparison& comparison, const Clip& clip, const RetargetOptions& options)
        : retarget_(retarget),
          comparison_(comparison),
          clip_(clip),
          options_(options),
          source_(retarget.source()),
          target_(retarget.target()),
          curves_(contact_curves(clip)),
          farthest_(comparison.bones().size()) {
        result_.kept.resize(retarget.source().joints().size());
        result_.moves.resize(result_.kept.size());
        result_.stretches.resize(result_.kept.size());
        result_.has_contacts = std::any_of(curves_.begin(), curves_.end(), [](const Curve* c) { return c != nullptr; });
    }

    std::optional<Followed> run(const std::vector<std::uint32_t>& sampled_meshes) {
        const std::size_t numbers = kNumbers * target_.model().joints().size() + target_.morph_weights().size() + 1;
        times_ = sample_times(clip_, std::max<std::size_t>(2, kMostNumbers / numbers));
        find_kept();
        if (!play()) return std::nullopt;
        spread();
        make_tracks(sampled_meshes);
        make_contacts();
        measure();
        result_.pops = find_pops(source_.model(), clip_, result_.tracks, times_);
        compare_with_source();
        return std::move(result_);
    }

private:
    /// Joints that may have the source's numbers: where rests are the same, and no other joint has them.
    void find_kept() {
        const Model& from = retarget_.source();
        const Model& to = retarget_.target();
        source_of_.assign(to.joints().size(), kNone);
        std::vector<bool> is_taken(from.joints().size());
        for (std::uint32_t joint = 0; joint < source_of_.size(); ++joint) {
            const std::uint32_t source = retarget_.joints()[joint];
            if (source == kNone || is_taken[source]) continue;
            if (!are_same(from.joints()[source].rest, to.joints()[joint].rest)) continue;
            is_taken[source] = true;
            source_of_[joint] = source;
        }
    }

    /// Between two samples there is a frame that is only compared, or more samples where something does not go evenly.
    bool play() {
        const std::vector<float> times = std::exchange(times_, {});
        most_ = 4 * times.size();
        RetargetState state;
        if (!result_.has_contacts && !find_contacts(times)) return false;
        if (ends_as_it_begins()) {
            for (const float time : times) {
                if (!step(time, state)) return false;
            }
        }
        auto first = sample_at(times.front(), state);
        if (!first) return false;
        record(std::move(*first));
        for (std::size_t k = 1; k < times.size(); ++k) {
            if (!advance(times[k], state)) return false;
        }
        return true;
    }

    /// Slows joints down that jump where the source does not: from one end of their limits to the other, or from one
    /// side of a straight leg to the other.
    void spread() {
        std::vector<std::uint32_t> joints, legs;
        for (std::uint32_t joint = 0; joint < source_of_.size(); ++joint) {
            if (source_of_[joint] == kNone) (is_in_leg(joint) ? legs : joints).push_back(joint);
        }
        // Between two samples that were changed there is one more, since joints turn quickly there, within limits.
        std::vector<Frame> all{frames_.front()};
        std::vector<double> allowed{0.0}, allowed_legs{0.0};
        for (std::size_t k = 1; k < frames_.size(); ++k) {
            const bool is_jump = times_[k] - times_[k - 1] < kInstant;  // of the source
            allowed.insert(allowed.end(), 2, is_jump ? allowed_[k] : 0.5 * allowed_[k]);
            const double more = options_.limits == Limits::hard ? kHardLegSpeed - kTurnSpeed : 0.0;
            allowed_legs.insert(allowed_legs.end(), 2, allowed.back() + 0.5 * more * (times_[k] - times_[k - 1]));
            all.push_back(std::move(between_[k - 1]));
            all.push_back(std::move(frames_[k]));
        }
        const bool repeats = ends_as_it_begins();
        std::vector<bool> changed = spread_jumps(target_.model(), all, allowed, joints, repeats);
        const std::vector<bool> changed_legs = spread_jumps(target_.model(), all, allowed_legs, legs, repeats);
        for (std::size_t k = 0; k < changed.size(); ++k) changed[k] = changed[k] || changed_legs[k];
        take_frames(std::move(all), changed);
    }

    [[nodiscard]] bool is_in_leg(std::uint32_t joint) const {
        const auto roles = target_.model().roles();
        return std::any_of(roles.begin(), roles.end(), [joint](const JointRole& one) {
            const auto role = static_cast<Role>(one.role);
            const bool is_human = role >= Role::left_upper_leg && role <= Role::right_toes;
            const bool is_animal = role >= Role::left_front_leg && role <= Role::right_hind_leg;
            return one.joint == joint && (is_human || is_animal);
        });
    }

    /// Takes what was made of the samples and of the frames between them: every other frame is a sample, and those
    /// between become samples where they were changed.
    void take_frames(std::vector<Frame> all, const std::vector<bool>& changed) {
        const std::vector<float> times = std::exchange(times_, {});
        const auto weights = std::exchange(weights_, {});
        const auto contacts = std::exchange(contacts_, {});
        frames_.clear();
        between_.clear();
        for (std::size_t k = 0; k < times.size(); ++k) {
            if (k > 0) {
                Frame& between = all[2 * k - 1];
                const float half = 0.5f * (times[k - 1] + times[k]);
                const bool is_sample = changed[2 * k - 1] && half > times[k - 1] && half < times[k];
                if (is_sample) {
                    times_.push_back(half);
                    frames_.push_back(std::move(between));
                    weights_.push_back(weights[k - 1]);
                    for (std::size_t w = 0; w < weights[k].size(); ++w)
                        weights_.back()[w] += 0.5f * (weights[k][w] - weights[k - 1][w]);
                    contacts_.push_back(contacts[k - 1]);
                    for (std::size_t c = 0; c < kContacts; ++c)
                        contacts_.back()[c] += 0.5f * (contacts[k][c] - contacts[k - 1][c]);
                    between_.insert(between_.end(), 2, {});
                } else {
                    between_.push_back(changed[2 * k - 2] || changed[2 * k] ? Frame() : std::move(between));
                }
            }
            times_.push_back(times[k]);
            frames_.push_back(std::move(all[2 * k]));
            weights_.push_back(weights[k]);
            contacts_.push_back(contacts[k]);
        }
    }

    /// Goes on from the last sample to another time.
    bool advance(float time, RetargetState& state) {
        struct Next {
            float time;
            unsigned halvings;
        };
        std::vector<Next> next{{time, kHalvings}};  // the last one first
        while (!next.empty()) {
            const float from = times_.back(), to = next.back().time, half = 0.5f * (from + to);
            RetargetState after = state;
            auto between = sample_at(half, after);
            auto end = between ? sample_at(to, after) : std::nullopt;
            if (!end) return false;
            const bool has_room = half > from && half < to && times_.size() < most_;
            const unsigned halvings = next.back().halvings;
            const bool is_rough =
                (halvings > 0 && !is_even(*between, *end)) || (to - from > kClosest && leaves_limits(*between, *end));
            if (has_room && is_rough) {
                next.back().halvings = halvings > 0 ? halvings - 1 : 0;
                next.push_back({half, next.back().halvings});
                continue;
            }
            between_.push_back(std::move(between->frame));
            record(std::move(*end));
            state = after;
            next.pop_back();
        }
        return true;
    }

    /// Returns true if a sample is nearly halfway from the last one to another one.
    [[nodiscard]] bool is_even(const Sample& between, const Sample& end) const {
        for (std::uint32_t joint = 0; joint < between.frame.size(); ++joint) {
            if (source_of_[joint] != kNone) continue;
            const double half = 1.0 - std::abs(glm::dot(halfway(joint, end), between.frame[joint].rotation));
            if (half > 0.125 * kUneven * kUneven) return false;
        }
        return true;
    }

    /// Returns true if what lies halfway from the last sample to another one violates a constraint, and Retarget does
    /// not.
    [[nodiscard]] bool leaves_limits(const Sample& between, const Sample& end) const {
        if (options_.limits == Limits::off) return false;
        const Model& model = target_.model();
        return std::any_of(model.constraints().begin(), model.constraints().end(), [&](const Constraint& limit) {
            if (model.constraint(limit.joint) != &limit || source_of_[limit.joint] != kNone) return false;
            const auto outside = [&](const glm::quat& local) {
                const glm::quat& rest = model.joints()[limit.joint].rest.rotation;
                return violation(limit, to_constraint_space(limit, rest, local));
            };
            return outside(halfway(limit.joint, end)) > outside(between.frame[limit.joint].rotation) + kOutside;
        });
    }

    /// A joint's rotation in the middle between the last sample and another one.
    [[nodiscard]] glm::quat halfway(std::uint32_t joint, const Sample& end) const {
        const glm::quat &a = frames_.back()[joint].rotation, &b = end.frame[joint].rotation;
        return glm::normalize(glm::dot(a, b) < 0.0f ? a - b : a + b);
    }

    /// Then feet stand at the beginning as at the end, where they have come from.
    bool ends_as_it_begins() {
        constexpr double kSame = 0.01;  // of a rotation's numbers
        if (clip_.loop || !sample(source_, &clip_, clip_.start)) return clip_.loop;
        const Frame first = frame_of(source_);
        if (!sample(source_, &clip_, clip_.end)) return false;
        for (std::uint32_t joint = 0; joint < first.size(); ++joint) {
            const glm::quat& a = first[joint].rotation;
            if (1.0 - std::abs(glm::dot(a, source_.local(joint).rotation)) > kSame * kSame) return false;
        }
        return clip_.end > clip_.start;
    }

    /// Finds when feet stand. In a quick motion a foot leaves the ground between two frames: it is then let go in
    /// kLetGo, as it would jump otherwise to where the leg has it.
    bool find_contacts(const std::vector<float>& times) {
        constexpr float kLetGo = 0.06f;  // seconds
        std::vector<ContactWeights> found;
        RetargetState state;
        for (int round = 0; round < (ends_as_it_begins() ? 2 : 1); ++round) {
            found.clear();
            for (const float time : times) {
                const auto done = step(time, state);
                if (!done) return false;
                found.push_back(done->contacts);
            }
        }
        if (ends_as_it_begins()) found.front() = later(found.front(), found.back(), 0.0f);
        for (std::size_t k = 1; k < found.size(); ++k)
            found[k] = later(found[k], found[k - 1], (times[k] - times[k - 1]) / kLetGo);
        weights_over_time_ = {times, std::move(found)};
        return true;
    }

    static ContactWeights later(ContactWeights now, const ContactWeights& before, float fallen) {
        for (std::size_t k = 0; k < kContacts; ++k) now[k] = std::max(now[k], before[k] - fallen);
        return now;
    }

    std::optional<Retargeted> step(float seconds, RetargetState& state) {
        if (!sample(source_, &clip_, seconds)) return std::nullopt;
        const auto done = bendy::retarget(target_, retarget_, source_, state, contacts_at(seconds));
        if (!done) return std::nullopt;
        return *done;
    }

    [[nodiscard]] std::optional<ContactWeights> contacts_at(float seconds) const {
        ContactWeights contacts{};
        if (result_.has_contacts) {
            for (std::size_t k = 0; k < kContacts; ++k) {
                if (curves_[k] != nullptr) (void)sample_curve(*curves_[k], seconds, std::span(&contacts[k], 1));
            }
            return contacts;
        }
        const auto& [times, weights] = weights_over_time_;
        if (weights.empty()) return std::nullopt;
        if (weights.size() == 1) return weights.front();
        const auto after = std::upper_bound(times.begin(), times.end(), seconds);
        const std::size_t k =
            std::clamp<std::size_t>(static_cast<std::size_t>(after - times.begin()), 1, times.size() - 1);
        const float share = (seconds - times[k - 1]) / (times[k] - times[k - 1]);
        for (std::size_t c = 0; c < kContacts; ++c)
            contacts[c] = weights[k - 1][c] + share * (weights[k][c] - weights[k - 1][c]);
        return contacts;
    }

    std::optional<Sample> sample_at(float seconds, RetargetState& state) {
        const auto done = step(seconds, state);
        if (!done) return std::nullopt;
        Sample sample{seconds, *done, frame_of(target_), frame_of(source_), {}, {}};
        for (const SharedBone& bone : comparison_.bones())
            sample.off.push_back(comparison_.angle(bone, source_, target_));
        sample.weights.assign(target_.morph_weights().begin(), target_.morph_weights().end());
        note_source(sample);
        note_kept(sample.frame);
        return sample;
    }

    void record(Sample sample) {
        note(sample.done, sample.seconds);
        note_off(sample);
        allowed_.push_back(allowed_since_last(sample));
        last_source_ = std::move(sample.source);
        times_.push_back(sample.seconds);
        frames_.push_back(std::move(sample.frame));
        weights_.push_back(std::move(sample.weights));
        contacts_.push_back(sample.done.contacts);
    }

    /// Radians by which a joint may turn since the last sample.
    [[nodiscard]] double allowed_since_last(const Sample& sample) const {
        if (times_.empty()) return 0.0;
        double turned = 0.0;
        for (std::size_t joint = 0; joint < sample.source.size(); ++joint) {
            turned = std::max(turned, turn_between(last_source_[joint].rotation, sample.source[joint].rotation));
        }
        return kTurnSpeed * (double{sample.seconds} - times_.back()) + kOfSource * turned;
    }

    void note(const Retargeted& done, float seconds) {
        ++result_.frames;
        if (done.turned > kMostTurned) {
            ++result_.limited;
            Held& held = result_.held[done.turned_joint];
            if (done.turned > held.angle) held = {done.turned, seconds};
        }
        if (done.missed > result_.missed) {
            result_.missed = done.missed;
            result_.missed_at = seconds;
            result_.missed_joint = done.missed_joint;
        }
        result_.lowered = std::max(result_.lowered, done.lowered);
    }

    void note_off(const Sample& sample) {
        for (std::size_t k = 0; k < sample.off.size(); ++k) {
            sum_off_ += sample.off[k];
            if (sample.off[k] <= farthest_[k].angle) continue;
            farthest_[k] = {comparison_.bones()[k].target.from, sample.off[k], sample.seconds};
        }
    }

    /// Finds the bones that are farthest off, and why.
    void compare_with_source() {
        const auto farther = [](FarthestOff& most, const FarthestOff& one) {
            if (one.angle > most.angle) most = one;
        };
        const std::vector<SharedBone>& bones = comparison_.bones();
        for (std::size_t k = 0; k < bones.size(); ++k) {
            farther(result_.farthest_off, farthest_[k]);
            if (farthest_[k].angle <= bones[k].far || !sample(source_, &clip_, farthest_[k].seconds)) continue;
            const Cause cause = comparison_.find_cause(bones[k], source_, target_);
            farther(result_.far_off[static_cast<std::size_t>(cause)], farthest_[k]);
        }
        if (!bones.empty()) result_.mean_off = sum_off_ / static_cast<double>(bones.size() * times_.size());
    }

    void note_source(const Sample& sample) {
        const Frame &now = sample.source, &frame = sample.frame;
        if (first_.empty()) first_ = now;
        for (std::uint32_t joint = 0; joint < now.size(); ++joint) {
            if (!are_same(now[joint], first_[joint])) result_.moves[joint] = true;
        }
        const auto to = target_.model().joints();
        for (std::uint32_t joint = 0; joint < frame.size(); ++joint) {
            const std::uint32_t from = retarget_.joints()[joint];
            const bool is_as_long =
                frame[joint].translation == to[joint].rest.translation && frame[joint].scale == to[joint].rest.scale;
            if (from != kNone && is_as_long && is_stretched(now[from], source_.model().joints()[from].rest))
                result_.stretches[from] = true;
        }
    }

    static bool is_stretched(const JointTransform& now, const JointTransform& rest) {
        return glm::length(now.translation - rest.translation) > kStretched * glm::length(rest.translation) ||
               glm::length(now.scale - rest.scale) > kStretched * glm::length(rest.scale);
    }

    void note_kept(const Frame& frame) {
        for (std::uint32_t joint = 0; joint < frame.size(); ++joint) {
            std::uint32_t& from = source_of_[joint];
            if (from != kNone && !are_same(frame[joint], source_.local(from))) from = kNone;
        }
    }

    void make_tracks(const std::vector<std::uint32_t>& sampled_meshes) {
        const auto joints = target_.model().joints();
        const bool is_free = options_.limits == Limits::off && !options_.plants_feet;
        const double turned = is_free ? kMostTurnedFree : kMostTurned;
        const double moved = kMostMoved * double{retarget_.leg()};
        target_.set_rest();
        const std::vector<glm::mat4> rests(target_.model_space().begin(), target_.model_space().end());
        for (std::uint32_t joint = 0; joint < joints.size(); ++joint) {
            if (source_of_[joint] != kNone) {
                result_.kept[source_of_[joint]] = true;
                continue;
            }
            const JointTransform& rest = joints[joint].rest;
            const auto four = [](const glm::quat& q) { return std::array{q.x, q.y, q.z, q.w}; };
            add_track(joint, TrackPath::rotation, four(rest.rotation), turned,
                      [&](const JointTransform& now) { return four(now.rotation); });
            const auto three = [](const glm::vec3& v) { return std::array{v.x, v.y, v.z}; };
            const double unit = joints[joint].parent == kNone ? 1.0 : unit_of(rests[joints[joint].parent]);
            add_track(joint, TrackPath::translation, three(rest.translation), moved / unit,
                      [&](const JointTransform& now) { return three(now.translation); });
            add_track(joint, TrackPath::scale, three(rest.scale), kMostWeight,
                      [&](const JointTransform& now) { return three(now.scale); });
        }
        for (const std::uint32_t mesh : sampled_meshes) add_weights(mesh);
    }

    template <std::size_t N, class Get>
    void add_track(std::uint32_t joint, TrackPath path, const std::array<float, N>& rest, double bound,
                   const Get& get) {
        Samples samples{N, path == TrackPath::rotation, {}};
        for (const Frame& frame : frames_) {
            const std::array<float, N> value = get(frame[joint]);
            samples.values.insert(samples.values.end(), value.begin(), value.end());
        }
        add_keys(joint, path, samples, rest, bound);
    }

    void add_weights(std::uint32_t mesh) {
        const Model& model = target_.model();
        const std::size_t count = model.meshes()[mesh].targets.size();
        Samples samples{count, false, {}};
        for (const std::vector<float>& all : weights_) {
            const auto begin = all.begin() + model.first_morph_target(mesh);
            samples.values.insert(samples.values.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
        }
        std::vector<float> rest;
        for (const MorphTargetView& target : model.meshes()[mesh].targets) rest.push_back(target.rest_weight);
        add_keys(mesh, TrackPath::weights, samples, rest, kMostWeight);
    }

    void add_keys(std::uint32_t target, TrackPath path, Samples& samples, std::span<const float> rest, double bound) {
        const std::vector<std::size_t> keys = linear_keys(samples, times_, bound);
        if (keys.size() == 1) {
            Samples both{samples.components, samples.is_rotation, {rest.begin(), rest.end()}};
            both.values.insert(both.values.end(), samples.values.begin(),
                               samples.values.begin() + static_cast<std::ptrdiff_t>(samples.components));
            constexpr std::array kTimes{0.0f, 1.0f};
            if (linear_keys(both, kTimes, bound).size() == 1) return;  // at rest
        }
        UnpackedTrack track;
        track.path = path;
        track.joint = target;
        track.components = static_cast<std::uint32_t>(samples.components);
        for (const std::size_t key : keys) {
            track.times.push_back(times_[key]);
            track.values.insert(track.values.end(), samples.at(key).begin(), samples.at(key).end());
        }
        result_.tracks.push_back(std::move(track));
    }

    void make_contacts() {
        if (result_.has_contacts) return;
        for (std::size_t k = 0; k < kContacts; ++k) {
            Samples samples{1, false, {}};
            for (const ContactWeights& weights : contacts_) samples.values.push_back(weights[k]);
            if (std::all_of(samples.values.begin(), samples.values.end(), [](float weight) { return weight == 0.0f; }))
                continue;
            ContactCurve curve{k, {}, {}};
            for (const std::size_t key : linear_keys(samples, times_, kMostWeight)) {
                curve.times.push_back(times_[key]);
                curve.values.push_back(samples.values[key]);
            }
            result_.contacts.push_back(std::move(curve));
        }
    }

    /// Compares what the tracks say with what Retarget has said.
    void measure() {
        Pose made(target_.model());
        for (std::size_t k = 0; k < frames_.size(); ++k) {
            compare(made, times_[k], frames_[k]);
            if (k < between_.size() && !between_[k].empty())
                compare(made, 0.5f * (times_[k] + times_[k + 1]), between_[k]);
        }
    }

    void compare(Pose& made, float seconds, const Frame& wanted) {
        made.set_rest();
        for (std::uint32_t joint = 0; joint < wanted.size(); ++joint) {
            if (source_of_[joint] != kNone) made.set_local(joint, wanted[joint]);
            target_.set_local(joint, wanted[joint]);
        }
        for (const UnpackedTrack& track : result_.tracks) {
            if (track.path != TrackPath::weights) set_from(made, track, seconds);
        }
        const auto a = made.model_space();
        const auto b = target_.model_space();
        double error = 0.0;
        for (std::size_t joint = 0; joint < a.size(); ++joint)
            error = std::max(error, double{glm::length(glm::vec3(a[joint][3] - b[joint][3]))});
        result_.mean_error += error / static_cast<double>(frames_.size() + between_.size());
        if (error <= result_.error) return;
        result_.error = error;
        result_.error_at = seconds;
    }

    void set_from(Pose& pose, const UnpackedTrack& track, float seconds) const {
        std::array<float, 4> value{};
        sample_track(view_of(track), clip_, seconds, value);
        JointTransform local = pose.local(track.joint);
        if (track.path == TrackPath::rotation) local.rotation = glm::quat(value[3], value[0], value[1], value[2]);
        if (track.path == TrackPath::translation) local.translation = {value[0], value[1], value[2]};
        if (track.path == TrackPath::scale) local.scale = {value[0], value[1], value[2]};
        pose.set_local(track.joint, local);
    }

    Retarget& retarget_;
    BoneComparison& comparison_;
    const Clip& clip_;
    RetargetOptions options_;
    Pose source_, target_;
    std::array<const Curve*, kContacts> curves_;
    std::vector<float> times_;
    std::size_t most_ = 0;                 // samples
    std::vector<Frame> frames_, between_;  // between: empty where that is not compared
    std::vector<double> allowed_;          // radians, by frame: see spread_jumps
    Frame first_, last_source_;            // of the source
    std::vector<FarthestOff> farthest_;    // by shared bone
    double sum_off_ = 0.0;                 // radians, of all bones in all frames
    std::vector<std::vector<float>> weights_;
    std::vector<ContactWeights> contacts_;
    std::pair<std::vector<float>, std::vector<ContactWeights>> weights_over_time_;  // found by find_contacts
    std::vector<std::uint32_t> source_of_;  // by joint of the target: the source's joint that has the same numbers
    Followed result_;
};

}  // namespace

std::optional<Followed> play_on_target(Retarget& retarget, BoneComparison& comparison, const Clip& clip,
                                       const RetargetOptions& options,
                                       const std::vector<std::uint32_t>& sampled_meshes) {
    return Following(retarget, comparison, clip, options).run(sampled_meshes);
}

}  // namespace bendy::motion
