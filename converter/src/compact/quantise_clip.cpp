#include "compact/quantise_clip.h"

#include "evaluate.h"

#include <bendy/format/trig.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace bendy::converter {
namespace {

constexpr std::size_t kMostTried = 160;     // frames that steps are chosen on
constexpr std::uint64_t kWork = 4'000'000;  // joints * frames that may be quantised while steps are chosen
constexpr double kTwoPi = 2.0 * trig::kPi;
constexpr std::size_t kPaths = 3;  // translation, rotation, scale: TrackPath's order

enum class State : std::uint8_t { unpacked, rest, constant, animated };

struct Property {
    State state = State::unpacked;
    std::uint32_t components = 3;
    std::array<std::uint8_t, 3> steps{160, 160, 160};
    glm::dvec3 middle{0.0};  // between its extremes, relative to rest
    glm::dvec3 half{0.0};    // from there to either
    glm::dvec3 reach{0.0};   // metres that a unit of each component moves a probe by, at most
};

using Plan = std::array<Property, kPaths>;
using Numbers = std::array<std::int32_t, 3>;

std::size_t index(TrackPath path) {
    return static_cast<std::size_t>(path);
}

std::uint8_t step_code(double step) {
    const double exact = std::clamp(step, 1e-12, 1e7);
    int exponent = 0;
    const double mantissa = std::frexp(exact, &exponent);  // [0.5, 1)
    constexpr std::array<double, 3> kRoots{0.5946035575013605, 0.7071067811865476, 0.8408964152537145};
    int quarter = 0;
    while (quarter < 3 && mantissa >= kRoots[static_cast<std::size_t>(quarter)]) ++quarter;
    return static_cast<std::uint8_t>(std::clamp((exponent - 1) * 4 + quarter + 160, 0, 255));
}

glm::dquat exp_of(const glm::dvec3& v) {
    const auto q = packed_rotation({v.x, v.y, v.z});
    return {q[3], q[0], q[1], q[2]};
}

/// The rotation vector of q that is nearest to `near`, at most a turn long.
glm::dvec3 log_near(const glm::dquat& q, const glm::dvec3& near) {
    const double sign = q.w < 0.0 ? -1.0 : 1.0;
    const glm::dvec3 part(sign * q.x, sign * q.y, sign * q.z);
    const double sine = glm::length(part);
    const double angle = 2.0 * trig::atan2(sine, sign * q.w);
    if (sine < 1e-9) {
        const double length = glm::length(near);
        return length > trig::kPi ? near * (kTwoPi / length) : 2.0 * part;
    }
    const glm::dvec3 axis = part / sine;
    const glm::dvec3 other = axis * (angle - kTwoPi);
    const glm::dvec3 v = axis * angle;
    const glm::dvec3 a = v - near;
    const glm::dvec3 b = other - near;
    return glm::dot(a, a) <= glm::dot(b, b) ? v : other;
}

/// The points of a set that stick out along the axes: at most six.
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
    Quantiser(const Scene& scene, const Clip& clip, const GridTracks& packed,
              const std::vector<std::vector<glm::dvec3>>& probes, const QuantiseOptions& options)
        : scene_(scene), clip_(clip), grid_(packed.grid), probes_(probes), options_(options) {
        const std::size_t joints = scene.joints.size();
        plans_.resize(joints);
        rest_.reserve(joints);
        for (const Joint& joint : scene.joints) rest_.push_back(local_of(joint.rest));
        find_subtrees();
        read_source();
        for (const std::uint32_t number : packed.tracks) open_property(clip.tracks[number]);
        measure_reach();
        settle();
        choose_frames();
    }

    PackedSamples run() {
        choose_steps();
        return quantise_all();
    }

private:
    // --- the source

    void find_subtrees() {
        const std::size_t joints = scene_.joints.size();
        end_.resize(joints);
        for (std::size_t j = joints; j-- > 0;) {
            end_[j] = std::max(end_[j], j + 1);
            const std::uint32_t parent = scene_.joints[j].parent;
            if (parent != kNone) end_[parent] = std::max(end_[parent], end_[j]);
        }
    }

    /// Local transforms at all frames, and rotations as vectors from rest that do not jump.
    void read_source() {
        const std::size_t joints = scene_.joints.size();
        locals_.resize(joints * grid_.frames);
        vectors_.resize(joints * grid_.frames);
        for (std::size_t f = 0; f < grid_.frames; ++f)
            std::copy(rest_.begin(), rest_.end(), locals_.begin() + static_cast<std::ptrdiff_t>(f * joints));
        const double snap = grid_.snap();
        std::vector<double> value;
        for (const Track& track : clip_.tracks) {
            if (track.path == TrackPath::weights) continue;
            for (std::uint32_t f = 0; f < grid_.frames; ++f) {
                evaluate_track(track, snapped(track, grid_.time_of(f), snap), value);
                set_property(track.path, value, locals_[f * joints + track.target]);
            }
        }
        for (std::size_t j = 0; j < joints; ++j) {
            glm::dvec3 before(0.0);
            for (std::size_t f = 0; f < grid_.frames; ++f) {
                const glm::dquat q = glm::conjugate(rest_[j].rotation) * locals_[f * joints + j].rotation;
                before = vectors_[f * joints + j] = log_near(q, before);
            }
        }
    }

    [[nodiscard]] const Local& local(std::size_t frame, std::size_t joint) const {
        return locals_[frame * scene_.joints.size() + joint];
    }

    /// A property relative to rest, as PACK stores it.
    [[nodiscard]] glm::dvec3 relative(std::size_t frame, std::size_t joint, TrackPath path) const {
        switch (path) {
            case TrackPath::translation:
                return local(frame, joint).translation - rest_[joint].translation;
            case TrackPath::rotation:
                return vectors_[frame * scene_.joints.size() + joint];
            default:
                return local(frame, joint).scale - rest_[joint].scale;
        }
    }

    void open_property(const Track& track) {
        Property& property = plans_[track.target][index(track.path)];
        property.state = State::animated;
        Box<glm::dvec3> box;
        double uneven = 0.0;
        for (std::size_t f = 0; f < grid_.frames; ++f) {
            const glm::dvec3 v = relative(f, track.target, track.path);
            box.add(v);
            uneven = std::max({uneven, std::abs(v.x - v.y), std::abs(v.x - v.z)});
        }
        const auto& [low, high] = box;
        property.middle = 0.5 * (low + high);
        property.half = 0.5 * (high - low);
        if (low == high || grid_.frames < 2) property.state = State::constant;
        if (low == glm::dvec3(0.0) && high == low) property.state = State::rest;
        constexpr double kEven = 1e-6;
        if (track.path == TrackPath::scale && uneven <= kEven) property.components = 1;
    }

    // --- how far a number reaches

    /// Points that a joint must put in their place: its own probes, the origins of children that turn themselves, and
    /// all the points of those that do not.
    void measure_reach() {
        const std::size_t joints = scene_.joints.size();
        std::vector<std::vector<glm::dvec3>> points(joints);
        std::vector<Affine> pose(joints);
        for (std::size_t j = 0; j < joints; ++j) {
            const std::uint32_t parent = scene_.joints[j].parent;
            pose[j] = to_affine(rest_[j], scene_.joints[j].rest.shear);
            if (parent != kNone) pose[j] = pose[parent] * pose[j];
        }
        aims_.resize(joints);
        for (std::size_t j = joints; j-- > 0;) {
            points[j].insert(points[j].end(), probes_[j].begin(), probes_[j].end());
            aims_[j] = outer_points(points[j]);
            const std::uint32_t above = scene_.joints[j].parent;
            set_reach(j, above == kNone ? glm::dmat3(1.0) : pose[above].linear, aims_[j]);
            const std::uint32_t parent = scene_.joints[j].parent;
            if (parent == kNone || aims_[j].empty()) continue;
            const Affine to_parent = to_affine(rest_[j], scene_.joints[j].rest.shear);
            const bool turns = plans_[j][index(TrackPath::rotation)].state == State::animated;
            if (turns && options_.corrects) {
                points[parent].push_back(to_parent.origin);
            } else {
                for (const glm::dvec3& point : aims_[j]) points[parent].push_back(to_parent(point));
            }
        }
    }

    /// Properties whose changes are as good as none are constant or at rest from the start: all of them on a chain
    /// together take a small part of the bound.
    void settle() {
        constexpr double kPart = 0.2;
        std::size_t deepest = 1;
        std::vector<std::size_t> depth(plans_.size(), 1);
        for (std::size_t j = 0; j < plans_.size(); ++j) {
            if (scene_.joints[j].parent != kNone) depth[j] = depth[scene_.joints[j].parent] + 1;
            deepest = std::max(deepest, depth[j]);
        }
        const double most = kPart * options_.max_error / static_cast<double>(deepest);
        for (Plan& plan : plans_) {
            for (Property& property : plan) {
                if (property.state != State::animated && property.state != State::constant) continue;
                if (glm::length(property.half * property.reach) < most) property.state = State::constant;
                if (glm::length((glm::abs(property.middle) + property.half) * property.reach) < most)
                    property.state = State::rest;
            }
        }
    }

    /// \param above  parent's space to model space, at rest
    void set_reach(std::size_t joint, const glm::dmat3& above, const std::vector<glm::dvec3>& points) {
        const glm::dmat3 stretched = stretch(rest_[joint].scale, scene_.joints[joint].rest.shear);
        const glm::dmat3 turned = above * glm::mat3_cast(rest_[joint].rotation);
        Plan& plan = plans_[joint];
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

    /// The rotation, from `turn` on, that brings the joint's aims nearest to where they should be, in the sense of
    /// least squares: one step of Gauss and Newton.
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
        constexpr double kMost = 0.3;  // radians: what is farther off is not a rounding error
        const double length = glm::length(by);
        if (!(length < kMost)) return turn;
        return turn * exp_of(by);
    }

    /// The property's numbers for a value relative to rest, and what they decode to.
    static glm::dvec3 round(const Property& property, const glm::dvec3& value, Numbers& numbers) {
        glm::dvec3 decoded;
        for (std::uint32_t c = 0; c < 3; ++c) {
            const std::uint32_t from = c < property.components ? c : 0;
            const auto at = static_cast<int>(from);
            if (c < property.components) {
                const double step = packed_step(property.steps[c]);
                numbers[c] = static_cast<std::int32_t>(std::clamp(std::nearbyint(value[at] / step), -2e9, 2e9));
            }
            decoded[static_cast<int>(c)] = numbers[from] * static_cast<double>(packed_step(property.steps[from]));
        }
        return decoded;
    }

    /// Quantises a joint whose parent is in its decoded place. `numbers` takes them by path.
    Affine quantise_joint(std::size_t frame, std::size_t joint, const Affine& parent, const Affine& wanted,
                          std::array<Numbers, kPaths>& numbers) const {
        const Plan& plan = plans_[joint];
        const Local& source = local(frame, joint);
        Local out = source;
        const Property& move = plan[index(TrackPath::translation)];
        if (move.state != State::unpacked) {
            glm::dvec3 by = value_of(move, relative(frame, joint, TrackPath::translation));
            if (move.state == State::animated && options_.corrects) {
                const glm::dvec3 place =
                    glm::inverse(parent.linear) * (wanted.origin - parent.origin) - rest_[joint].translation;
                const glm::dvec3 shift = place - by;
                const double near =
                    64.0 * (packed_step(move.steps[0]) + packed_step(move.steps[1]) + packed_step(move.steps[2]));
                if (glm::length(shift) < near) by = place;  // not for parents without volume
            }
            if (move.state != State::rest) by = round(move, by, numbers[0]);
            out.translation = rest_[joint].translation + by;
        }
        const Property& grow = plan[index(TrackPath::scale)];
        if (grow.state != State::unpacked) {
            glm::dvec3 by = value_of(grow, relative(frame, joint, TrackPath::scale));
            if (grow.state != State::rest) by = round(grow, by, numbers[2]);
            out.scale = rest_[joint].scale + by;
        }
        const Property& turn = plan[index(TrackPath::rotation)];
        const glm::dmat3 stretched = stretch(out.scale, scene_.joints[joint].rest.shear);
        const glm::dvec3 origin = parent(out.translation);
        if (turn.state != State::unpacked) {
            const glm::dvec3 exact = relative(frame, joint, TrackPath::rotation);
            glm::dvec3 by = value_of(turn, exact);
            if (turn.state == State::animated && options_.corrects) {
                const glm::dquat wish = correct(joint, parent, origin, stretched, source.rotation, wanted);
                by = log_near(glm::conjugate(rest_[joint].rotation) * wish, exact);
            }
            if (turn.state != State::rest) by = round(turn, by, numbers[1]);
            out.rotation = turn.state == State::rest ? rest_[joint].rotation : rest_[joint].rotation * exp_of(by);
        }
        return {parent.linear * (glm::mat3_cast(out.rotation) * stretched), origin};
    }

    static glm::dvec3 value_of(const Property& property, const glm::dvec3& exact) {
        if (property.state == State::rest) return glm::dvec3(0.0);
        return property.state == State::constant ? property.middle : exact;
    }

    [[nodiscard]] double square_error(std::size_t joint, const Affine& a, const Affine& b) const {
        double worst = 0.0;
        const glm::dmat3 linear = a.linear - b.linear;
        const glm::dvec3 origin = a.origin - b.origin;
        for (const glm::dvec3& probe : probes_[joint]) {
            const glm::dvec3 off = linear * probe + origin;
            worst = std::max(worst, glm::dot(off, off));
        }
        return worst;
    }

    // --- choosing steps

    void choose_frames() {
        const std::size_t joints = scene_.joints.size();
        const std::size_t tried = std::min<std::size_t>(grid_.frames, kMostTried);
        for (std::size_t k = 0; k < tried; ++k) tried_.push_back(tried < 2 ? 0 : k * (grid_.frames - 1) / (tried - 1));
        wanted_.resize(tried * joints);
        decoded_.resize(tried * joints);
        trial_.resize(tried * joints);
        order_.resize(tried);
        std::iota(order_.begin(), order_.end(), 0);
        for (std::size_t k = 0; k < tried; ++k) {
            place_source(tried_[k], std::span(wanted_).subspan(k * joints, joints));
        }
    }

    void place_source(std::size_t frame, std::span<Affine> out) const {
        for (std::size_t j = 0; j < scene_.joints.size(); ++j) {
            const std::uint32_t parent = scene_.joints[j].parent;
            const Affine at = to_affine(local(frame, j), scene_.joints[j].rest.shear);
            out[j] = parent == kNone ? at : out[parent] * at;
        }
    }

    /// Quantises the joint and all below it at all tried frames; true, and kept, if no probe is farther off than
    /// allowed.
    bool try_subtree(std::size_t first, std::size_t end) {
        const std::size_t joints = scene_.joints.size();
        const double most = options_.max_error * options_.max_error;
        std::array<Numbers, kPaths> numbers;
        for (std::size_t o = 0; o < order_.size(); ++o) {
            const std::size_t k = order_[o];
            for (std::size_t j = first; j < end; ++j) {
                const std::uint32_t parent = scene_.joints[j].parent;
                const std::size_t row = k * joints;
                const Affine above = parent == kNone ? Affine{} : (parent >= first ? trial_ : decoded_)[row + parent];
                trial_[row + j] = quantise_joint(tried_[k], j, above, wanted_[row + j], numbers);
                ++work_;
                if (square_error(j, trial_[row + j], wanted_[row + j]) <= most) continue;
                std::rotate(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(o),
                            order_.begin() + static_cast<std::ptrdiff_t>(o) + 1);
                return false;
            }
        }
        for (std::size_t k = 0; k < order_.size(); ++k) {
            const auto row = static_cast<std::ptrdiff_t>(k * joints);
            std::copy(trial_.begin() + row + static_cast<std::ptrdiff_t>(first),
                      trial_.begin() + row + static_cast<std::ptrdiff_t>(end),
                      decoded_.begin() + row + static_cast<std::ptrdiff_t>(first));
        }
        return true;
    }
    bool try_all() { return try_subtree(0, scene_.joints.size()); }

    /// Tries a change of one joint's plan; takes it back if the error is too large.
    template <class Change>
    bool attempt(std::size_t joint, Change change) {
        const Plan before = plans_[joint];
        change(plans_[joint]);
        if (try_subtree(joint, end_[joint])) return true;
        plans_[joint] = before;
        return false;
    }

    void set_steps(double share) {
        for (Plan& plan : plans_) {
            for (Property& property : plan) {
                for (std::uint32_t c = 0; c < 3; ++c) {
                    const double reach = std::max(property.reach[static_cast<int>(c)], 1e-9);
                    property.steps[c] = step_code(share * options_.max_error / reach);
                }
            }
        }
    }

    void choose_steps() {
        double low = 1e-3;
        double high = 8.0;
        for (int halving = 0; halving < 9; ++halving) {
            const double middle = std::sqrt(low * high);
            set_steps(middle);
            (try_all() ? low : high) = middle;
        }
        set_steps(low);
        if (!try_all()) return;
        for (std::size_t j = 0; j < plans_.size(); ++j) simplify(j);
        grow_steps();
    }

    /// Tries to do without a joint's changes.
    void simplify(std::size_t joint) {
        for (std::size_t path = 0; path < kPaths && work_ < kWork; ++path) {
            const State state = plans_[joint][path].state;
            if (state != State::animated && state != State::constant) continue;
            if (attempt(joint, [&](Plan& plan) { plan[path].state = State::rest; })) continue;
            if (state == State::animated) attempt(joint, [&](Plan& plan) { plan[path].state = State::constant; });
        }
    }

    /// Makes steps coarser, one after another in an order that favours none, until none can be.
    void grow_steps() {
        struct Step {
            std::size_t joint, path;
            std::uint32_t component;
        };
        std::vector<Step> steps;
        for (std::size_t j = 0; j < plans_.size(); ++j) {
            for (std::size_t path = 0; path < kPaths; ++path) {
                const Property& property = plans_[j][path];
                if (property.state != State::animated && property.state != State::constant) continue;
                for (std::uint32_t c = 0; c < property.components; ++c) steps.push_back({j, path, c});
            }
        }
        std::uint32_t random = 7;
        for (int pass = 0; pass < 40 && !steps.empty() && work_ < kWork; ++pass) {
            for (std::size_t k = steps.size(); k-- > 1;) {
                random = random * 1664525u + 1013904223u;
                std::swap(steps[k], steps[(random >> 8) % (k + 1)]);
            }
            const int by = pass < 3 ? 2 : 1;
            std::erase_if(steps, [&](const Step& step) {
                if (work_ >= kWork) return false;
                if (plans_[step.joint][step.path].steps[step.component] > 250) return true;
                const bool grew = attempt(step.joint, [&](Plan& plan) {
                    auto& code = plan[step.path].steps[step.component];
                    code = static_cast<std::uint8_t>(code + by);
                });
                return !grew && by == 1;
            });
        }
    }

    // --- the result

    PackedSamples quantise_all() {
        PackedSamples samples;
        samples.frames = grid_.frames;
        samples.start = grid_.start;
        samples.frame_rate = grid_.rate;
        samples.times = grid_.times;
        std::vector<std::array<std::size_t, kPaths>> place(plans_.size());
        for (std::size_t j = 0; j < plans_.size(); ++j) {
            for (std::size_t path = 0; path < kPaths; ++path) {
                const Property& property = plans_[j][path];
                place[j][path] = samples.tracks.size();
                if (property.state != State::animated && property.state != State::constant) continue;
                PackedTrack track;
                track.path = static_cast<TrackPath>(path);
                track.joint = static_cast<std::uint32_t>(j);
                track.steps = property.steps;
                track.components = property.components;
                track.animated = property.state == State::animated;
                track.numbers.resize(std::size_t{property.components} * (track.animated ? grid_.frames : 1));
                samples.joints = track.joint + 1;
                samples.tracks.push_back(std::move(track));
            }
        }
        const std::size_t joints = scene_.joints.size();
        std::vector<Affine> wanted(joints);
        std::vector<Affine> decoded(joints);
        std::array<Numbers, kPaths> numbers{};
        for (std::size_t f = 0; f < grid_.frames; ++f) {
            place_source(f, wanted);
            for (std::size_t j = 0; j < joints; ++j) {
                const std::uint32_t parent = scene_.joints[j].parent;
                decoded[j] = quantise_joint(f, j, parent == kNone ? Affine{} : decoded[parent], wanted[j], numbers);
                for (std::size_t path = 0; path < kPaths; ++path) {
                    const Property& property = plans_[j][path];
                    if (property.state != State::animated && property.state != State::constant) continue;
                    PackedTrack& track = samples.tracks[place[j][path]];
                    const std::size_t stride = track.animated ? grid_.frames : 1;
                    for (std::uint32_t c = 0; c < track.components; ++c)
                        track.numbers[c * stride + (track.animated ? f : 0)] = numbers[path][c];
                }
            }
        }
        return samples;
    }

    const Scene& scene_;
    const Clip& clip_;
    Grid grid_;
    const std::vector<std::vector<glm::dvec3>>& probes_;
    QuantiseOptions options_;
    std::vector<Plan> plans_;                       // per joint
    std::vector<Local> rest_;                       // per joint
    std::vector<std::size_t> end_;                  // per joint: one past the last below it
    std::vector<std::vector<glm::dvec3>> aims_;     // per joint, in its space
    std::vector<Local> locals_;                     // frame by frame
    std::vector<glm::dvec3> vectors_;               // frame by frame: rotations from rest
    std::vector<std::size_t> tried_;                // frames
    std::vector<std::size_t> order_;                // of tried frames: those that failed first
    std::vector<Affine> wanted_, decoded_, trial_;  // by tried frame, model space
    std::uint64_t work_ = 0;
};

}  // namespace

PackedSamples quantise(const Scene& scene, const Clip& clip, const GridTracks& packed,
                       const std::vector<std::vector<glm::dvec3>>& probes, const QuantiseOptions& options) {
    return Quantiser(scene, clip, packed, probes, options).run();
}

}  // namespace bendy::converter
