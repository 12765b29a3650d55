#include "optimise/compact/quantise_clip.h"

#include "optimise/compact/linear_errors.h"
#include "optimise/compact/quantise_plan.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace bendy::converter {
namespace {

constexpr std::uint64_t kWork = 40'000'000;  // limit on joints * frames quantised while choosing steps

using State = PropertyState;
using Numbers = std::array<std::int32_t, 3>;

glm::dquat exp_of(const glm::dvec3& v) {
    const auto q = packed_rotation({v.x, v.y, v.z});
    return {q[3], q[0], q[1], q[2]};
}

/// The extreme points of a set along the axes: at most six.
std::vector<glm::dvec3> outer_points(const std::vector<glm::dvec3>& points) {
    std::vector<glm::dvec3> outer;
    for (int axis = 0; axis < 3 && !points.empty(); ++axis) {
        const auto less = [axis](const glm::dvec3& a, const glm::dvec3& b) { return a[axis] < b[axis]; };
        const auto [low, high] = std::minmax_element(points.begin(), points.end(), less);
        for (const glm::dvec3& point : {*low, *high}) {
            if (std::find(outer.begin(), outer.end(), point) == outer.end()) outer.push_back(point);
        }
    }
    return outer;
}

class Quantiser {
public:
    Quantiser(const ClipFrames& frames, const Clip& clip, const std::vector<std::uint32_t>& packed,
              const std::vector<std::vector<glm::dvec3>>& probes, const QuantiseOptions& options)
        : frames_(frames), scene_(frames.scene()), probes_(probes), options_(options), plans_(frames.joints()) {
        find_subtrees();
        for (const std::uint32_t number : packed) open_property(clip.tracks[number]);
        measure_reach();
        settle();
        errors_.emplace(frames, plans_, aims_, probes, options.corrects);
    }

    PackedSamples run(const Grid& grid) {
        constexpr int kAttempts = 6;
        const std::vector<JointPlan> plans = plans_;
        aim_ = options_.max_error;
        for (int attempt = 1;; ++attempt) {
            choose_steps();
            double worst = 0.0;
            PackedSamples samples = quantise_all(grid, worst);
            if (worst <= options_.max_error || attempt == kAttempts) return samples;
            // Steps are chosen to first order, which is inexact if they are coarse. That error shrinks faster than the
            // steps do.
            constexpr double kLeast = 0.96;
            aim_ *= std::max(0.998 * options_.max_error / worst, attempt + 2 < kAttempts ? kLeast : 0.0);
            plans_ = plans;
        }
    }

private:
    // --- source

    void find_subtrees() {
        const std::size_t joints = scene_.joints.size();
        end_.resize(joints);
        for (std::size_t j = joints; j-- > 0;) {
            end_[j] = std::max(end_[j], j + 1);
            const std::uint32_t parent = scene_.joints[j].parent;
            if (parent != kNone) end_[parent] = std::max(end_[parent], end_[j]);
        }
    }

    void open_property(const Track& track) {
        Property& property = plans_[track.target][index(track.path)];
        property.state = State::animated;
        Box<glm::dvec3> box;
        double uneven = 0.0;
        for (std::size_t f = 0; f < frames_.frames(); ++f) {
            const glm::dvec3 v = frames_.relative(f, track.target, track.path);
            box.add(v);
            uneven = std::max({uneven, std::abs(v.x - v.y), std::abs(v.x - v.z)});
        }
        const auto& [low, high] = box;
        property.middle = 0.5 * (low + high);
        property.half = 0.5 * (high - low);
        if (low == high || frames_.frames() < 2) property.state = State::constant;
        if (low == glm::dvec3(0.0) && high == low) property.state = State::rest;
        constexpr double kEven = 1e-6;
        if (track.path == TrackPath::scale && uneven <= kEven) property.components = 1;
    }

    // --- reach of a number

    /// Points that a joint must put in place: its own probes, the origins of children that rotate, and all points of
    /// those that do not.
    void measure_reach() {
        const std::size_t joints = scene_.joints.size();
        std::vector<std::vector<glm::dvec3>> points(joints);
        std::vector<Affine> pose(joints);
        place_joints(scene_.joints, frames_.rest(), pose);
        aims_.resize(joints);
        for (std::size_t j = joints; j-- > 0;) {
            points[j].insert(points[j].end(), probes_[j].begin(), probes_[j].end());
            aims_[j] = outer_points(points[j]);
            const std::uint32_t above = scene_.joints[j].parent;
            set_reach(j, above == kNone ? glm::dmat3(1.0) : pose[above].linear, aims_[j]);
            const std::uint32_t parent = scene_.joints[j].parent;
            if (parent == kNone || aims_[j].empty()) continue;
            const Affine to_parent = to_affine(frames_.rest()[j], scene_.joints[j].rest.shear);
            const bool turns = plans_[j][index(TrackPath::rotation)].state == State::animated;
            if (turns && options_.corrects) {
                points[parent].push_back(to_parent.origin);
            } else {
                for (const glm::dvec3& point : aims_[j]) points[parent].push_back(to_parent(point));
            }
        }
    }

    /// Sets properties that hardly change to constant or rest: all of them on a chain together use a small part of the
    /// bound.
    void settle() {
        constexpr double kPart = 0.2;
        std::size_t deepest = 1;
        std::vector<std::size_t> depth(plans_.size(), 1);
        for (std::size_t j = 0; j < plans_.size(); ++j) {
            if (scene_.joints[j].parent != kNone) depth[j] = depth[scene_.joints[j].parent] + 1;
            deepest = std::max(deepest, depth[j]);
        }
        const double most = kPart * options_.max_error / static_cast<double>(deepest);
        for (JointPlan& plan : plans_) {
            for (Property& property : plan) {
                if (!property.is_stored()) continue;
                if (glm::length(property.half * property.reach) < most) property.state = State::constant;
                if (glm::length((glm::abs(property.middle) + property.half) * property.reach) < most)
                    property.state = State::rest;
            }
        }
    }

    /// \param above  parent's space to model space, at rest
    void set_reach(std::size_t joint, const glm::dmat3& above, const std::vector<glm::dvec3>& points) {
        const glm::dmat3 stretched = stretch(frames_.rest()[joint].scale, scene_.joints[joint].rest.shear);
        const glm::dmat3 turned = above * glm::mat3_cast(frames_.rest()[joint].rotation);
        JointPlan& plan = plans_[joint];
        for (int c = 0; c < 3; ++c) {
            glm::dvec3 unit(0.0);
            unit[c] = 1.0;
            plan[index(TrackPath::translation)].reach[c] = glm::length(above * unit);
            double turn = 0.0;
            double grow = 0.0;
            for (const glm::dvec3& point : points) {
                turn = std::max(turn, glm::length(turned * glm::cross(unit, stretched * point)));
                grow = std::max(grow, glm::length(turned * unit) * std::abs(point[c]));
            }
            plan[index(TrackPath::rotation)].reach[c] = turn;
            plan[index(TrackPath::scale)].reach[c] = grow;
        }
        Property& scale = plan[index(TrackPath::scale)];
        if (scale.components == 1) scale.reach = glm::dvec3(std::max({scale.reach.x, scale.reach.y, scale.reach.z}));
    }

    // --- one joint at one frame

    /// The rotation, starting from `turn`, that brings the joint's aims nearest to their targets in the least-squares
    /// sense: one Gauss-Newton step.
    [[nodiscard]] glm::dquat correct(std::size_t joint, const Affine& parent, const glm::dvec3& origin,
                                     const glm::dmat3& stretched, const glm::dquat& turn, const Affine& wanted) const {
        const glm::dmat3 axes = parent.linear * glm::mat3_cast(turn);
        glm::dmat3 normal(0.0);
        glm::dvec3 right(0.0);
        for (const glm::dvec3& aim : aims_[joint]) {
            const glm::dvec3 arm = stretched * aim;
            const glm::dvec3 off = wanted(aim) - (origin + axes * arm);
            const glm::dmat3 moves(axes * glm::dvec3(0.0, -arm.z, arm.y), axes * glm::dvec3(arm.z, 0.0, -arm.x),
                                   axes * glm::dvec3(-arm.y, arm.x, 0.0));
            for (int a = 0; a < 3; ++a) {
                right[a] += glm::dot(moves[a], off);
                for (int b = 0; b < 3; ++b) normal[b][a] += glm::dot(moves[a], moves[b]);
            }
        }
        const double damping = 1e-6 * (normal[0][0] + normal[1][1] + normal[2][2]);
        if (!(damping > 0.0)) return turn;
        for (int a = 0; a < 3; ++a) normal[a][a] += damping;
        const glm::dvec3 by = glm::inverse(normal) * right;
        constexpr double kMost = 0.3;  // radians: a larger one is not a rounding error
        const double length = glm::length(by);
        if (!(length < kMost)) return turn;
        return turn * exp_of(by);
    }

    /// Quantises a value relative to rest into `numbers`, and returns the decoded value.
    static glm::dvec3 round(const Property& property, const glm::dvec3& value, Numbers& numbers) {
        glm::dvec3 decoded;
        for (std::uint32_t c = 0; c < 3; ++c) {
            const std::uint32_t from = c < property.components ? c : 0;
            const auto at = static_cast<int>(from);
            if (c < property.components) {
                const double step = step_size(property.steps[c]);
                numbers[c] = static_cast<std::int32_t>(std::clamp(std::nearbyint(value[at] / step), -2e9, 2e9));
            }
            decoded[static_cast<int>(c)] = numbers[from] * step_size(property.steps[from]);
        }
        return decoded;
    }

    /// Quantises a joint whose parent is at its decoded place. Stores the numbers by path in `numbers`.
    Affine quantise_joint(std::size_t frame, std::size_t joint, const Affine& parent, const Affine& wanted,
                          std::array<Numbers, kPaths>& numbers) const {
        const JointPlan& plan = plans_[joint];
        const Local& source = frames_.local(frame, joint);
        Local out = source;
        const Property& move = plan[index(TrackPath::translation)];
        if (move.state != State::unpacked) {
            glm::dvec3 by = value_of(move, frames_.relative(frame, joint, TrackPath::translation));
            if (move.state == State::animated && options_.corrects) {
                const glm::dvec3 place =
                    glm::inverse(parent.linear) * (wanted.origin - parent.origin) - frames_.rest()[joint].translation;
                const glm::dvec3 shift = place - by;
                const double near =
                    64.0 * (step_size(move.steps[0]) + step_size(move.steps[1]) + step_size(move.steps[2]));
                if (glm::length(shift) < near) by = place;  // not if the parent has no volume
            }
            if (move.state != State::rest) by = round(move, by, numbers[0]);
            out.translation = frames_.rest()[joint].translation + by;
        }
        const Property& grow = plan[index(TrackPath::scale)];
        if (grow.state != State::unpacked) {
            glm::dvec3 by = value_of(grow, frames_.relative(frame, joint, TrackPath::scale));
            if (grow.state != State::rest) by = round(grow, by, numbers[2]);
            out.scale = frames_.rest()[joint].scale + by;
        }
        const Property& turn = plan[index(TrackPath::rotation)];
        const glm::dmat3 stretched = stretch(out.scale, scene_.joints[joint].rest.shear);
        const glm::dvec3 origin = parent(out.translation);
        if (turn.state != State::unpacked) {
            const glm::dvec3 exact = frames_.relative(frame, joint, TrackPath::rotation);
            glm::dvec3 by = value_of(turn, exact);
            if (turn.state == State::animated && options_.corrects) {
                const glm::dquat wish = correct(joint, parent, origin, stretched, source.rotation, wanted);
                by = log_near(glm::conjugate(frames_.rest()[joint].rotation) * wish, exact);
            }
            if (turn.state != State::rest) by = round(turn, by, numbers[1]);
            out.rotation = turn.state == State::rest ? frames_.rest()[joint].rotation
                                                     : frames_.rest()[joint].rotation * exp_of(by);
        }
        return {parent.linear * (glm::mat3_cast(out.rotation) * stretched), origin};
    }

    static glm::dvec3 value_of(const Property& property, const glm::dvec3& exact) {
        if (property.state == State::rest) return glm::dvec3(0.0);
        return property.state == State::constant ? property.middle : exact;
    }

    // --- choosing steps

    bool try_subtree(std::size_t first, std::size_t end) {
        if (!errors_->try_subtree(plans_, first, end, aim_)) return false;
        errors_->keep(first, end);
        return true;
    }
    bool try_all() { return try_subtree(0, scene_.joints.size()); }
    [[nodiscard]] bool may_go_on() const { return errors_->work() < most_work_; }

    /// Tries a change of one joint's plan; reverts it if the error is too large.
    template <class Change>
    bool attempt(std::size_t joint, Change change) {
        const JointPlan before = plans_[joint];
        change(plans_[joint]);
        if (try_subtree(joint, end_[joint])) return true;
        plans_[joint] = before;
        return false;
    }

    void set_steps(double share) {
        for (JointPlan& plan : plans_) {
            for (Property& property : plan) {
                for (std::uint32_t c = 0; c < 3; ++c) {
                    const double reach = std::max(property.reach[static_cast<int>(c)], 1e-9);
                    property.steps[c] = step_code(share * aim_ / reach);
                }
            }
        }
    }

    void choose_steps() {
        most_work_ = errors_->work() + kWork;
        double low = 1e-3;
        double high = 8.0;
        for (int halving = 0; halving < 6; ++halving) {  // to a fifth of an octave: codes are a quarter apart
            const double middle = std::sqrt(low * high);
            set_steps(middle);
            (try_all() ? low : high) = middle;
        }
        set_steps(low);
        if (!try_all()) return;
        for (std::size_t j = 0; j < plans_.size(); ++j) simplify(j);
        grow_steps();
    }

    /// Tries to drop a joint's animation, property by property.
    void simplify(std::size_t joint) {
        for (std::size_t path = 0; path < kPaths && may_go_on(); ++path) {
            const State state = plans_[joint][path].state;
            if (state != State::animated && state != State::constant) continue;
            if (attempt(joint, [&](JointPlan& plan) { plan[path].state = State::rest; })) continue;
            if (state == State::animated) attempt(joint, [&](JointPlan& plan) { plan[path].state = State::constant; });
        }
    }

    /// A property's components from `first` on, whose steps are changed together.
    struct Steps {
        std::size_t joint, path;
        std::uint32_t first, end;
    };

    /// The steps of all changing properties; a coarser step of a constant saves next to nothing.
    [[nodiscard]] std::vector<Steps> all_steps(bool together) const {
        std::vector<Steps> steps;
        for (std::size_t j = 0; j < plans_.size(); ++j) {
            for (std::size_t path = 0; path < kPaths; ++path) {
                const Property& property = plans_[j][path];
                if (property.state != State::animated) continue;
                const std::uint32_t width = together ? property.components : 1;
                for (std::uint32_t c = 0; c < property.components; c += width) steps.push_back({j, path, c, c + width});
            }
        }
        return steps;
    }

    /// Whether the steps are so coarse that all numbers are 0: coarser ones would save nothing.
    [[nodiscard]] bool is_spent(const Steps& those) const {
        constexpr double kZero = 0.25;  // of a step
        const Property& property = plans_[those.joint][those.path];
        for (std::uint32_t c = those.first; c < those.end; ++c) {
            const auto at = static_cast<int>(c);
            const double largest = std::abs(property.middle[at]) + property.half[at];
            if (largest > kZero * step_size(property.steps[c])) return false;
        }
        return true;
    }

    /// Makes steps coarser, in an order that favours none, until none can grow: first whole properties in large
    /// increments, which needs few attempts.
    void grow_steps() {
        constexpr std::array<std::uint8_t, 4> kBy{4, 2, 2, 2};  // step code increments, by pass; later passes use 1
        constexpr std::size_t kTogether = 3;                    // passes
        constexpr std::size_t kMostPasses = 8;
        constexpr std::uint8_t kLargest = 250;
        std::vector<Steps> steps = all_steps(true);
        std::uint32_t random = 7;
        for (std::size_t pass = 0; pass < kMostPasses && !steps.empty() && may_go_on(); ++pass) {
            if (pass == kTogether) steps = all_steps(false);
            for (std::size_t k = steps.size(); k-- > 1;) {
                random = random * 1664525u + 1013904223u;
                std::swap(steps[k], steps[(random >> 8) % (k + 1)]);
            }
            const std::uint8_t by = pass < kBy.size() ? kBy.at(pass) : std::uint8_t{1};
            std::erase_if(steps, [&](const Steps& those) {
                if (!may_go_on()) return false;
                const auto& codes = plans_[those.joint][those.path].steps;
                const auto is_large = [&](std::uint8_t code) { return code > kLargest - by; };
                if (std::any_of(codes.begin() + those.first, codes.begin() + those.end, is_large)) return true;
                if (is_spent(those)) return true;
                const bool grew = attempt(those.joint, [&](JointPlan& plan) {
                    for (std::uint32_t c = those.first; c < those.end; ++c) {
                        std::uint8_t& code = plan[those.path].steps.at(c);
                        code = static_cast<std::uint8_t>(code + by);
                    }
                });
                return !grew && by == 1;
            });
        }
    }

    // --- the result

    [[nodiscard]] double error_of(std::size_t joint, const Affine& decoded, const Affine& wanted) const {
        double worst = 0.0;
        const glm::dmat3 linear = decoded.linear - wanted.linear;
        const glm::dvec3 origin = decoded.origin - wanted.origin;
        for (const glm::dvec3& probe : probes_[joint]) {
            const glm::dvec3 off = linear * probe + origin;
            worst = std::max(worst, glm::dot(off, off));
        }
        return std::sqrt(worst);
    }

    /// \param worst  receives the largest error of a probe at the frames
    PackedSamples quantise_all(const Grid& grid, double& worst) {
        PackedSamples samples;
        samples.frames = grid.frames;
        samples.start = grid.start;
        samples.frame_rate = grid.rate;
        samples.times = grid.times;
        std::vector<std::array<std::size_t, kPaths>> place(plans_.size());
        for (std::size_t j = 0; j < plans_.size(); ++j) {
            for (std::size_t path = 0; path < kPaths; ++path) {
                const Property& property = plans_[j][path];
                place[j][path] = samples.tracks.size();
                if (!property.is_stored()) continue;
                PackedTrack track;
                track.path = static_cast<TrackPath>(path);
                track.joint = static_cast<std::uint32_t>(j);
                track.steps = property.steps;
                track.components = property.components;
                track.animated = property.state == State::animated;
                track.numbers.resize(std::size_t{property.components} * (track.animated ? grid.frames : 1));
                samples.joints = track.joint + 1;
                samples.tracks.push_back(std::move(track));
            }
        }
        const std::size_t joints = scene_.joints.size();
        std::vector<Affine> wanted(joints);
        std::vector<Affine> decoded(joints);
        std::array<Numbers, kPaths> numbers{};
        for (std::size_t f = 0; f < grid.frames; ++f) {
            frames_.place(f, wanted);
            for (std::size_t j = 0; j < joints; ++j) {
                const std::uint32_t parent = scene_.joints[j].parent;
                decoded[j] = quantise_joint(f, j, parent == kNone ? Affine{} : decoded[parent], wanted[j], numbers);
                worst = std::max(worst, error_of(j, decoded[j], wanted[j]));
                for (std::size_t path = 0; path < kPaths; ++path) {
                    const Property& property = plans_[j][path];
                    if (!property.is_stored()) continue;
                    PackedTrack& track = samples.tracks[place[j][path]];
                    const std::size_t stride = track.animated ? grid.frames : 1;
                    for (std::uint32_t c = 0; c < track.components; ++c)
                        track.numbers[c * stride + (track.animated ? f : 0)] = numbers[path][c];
                }
            }
        }
        return samples;
    }

    const ClipFrames& frames_;
    const Scene& scene_;
    const std::vector<std::vector<glm::dvec3>>& probes_;
    QuantiseOptions options_;
    std::vector<JointPlan> plans_;               // per joint
    std::vector<std::size_t> end_;               // per joint: one past its last descendant
    std::vector<std::vector<glm::dvec3>> aims_;  // per joint, in its space
    std::optional<LinearErrors> errors_;
    double aim_ = 0.0;  // metres
    std::uint64_t most_work_ = 0;
};

}  // namespace

PackedSamples quantise(const ClipFrames& frames, const Clip& clip, const GridTracks& packed,
                       const std::vector<std::vector<glm::dvec3>>& probes, const QuantiseOptions& options) {
    return Quantiser(frames, clip, packed.tracks, probes, options).run(packed.grid);
}

}  // namespace bendy::converter
