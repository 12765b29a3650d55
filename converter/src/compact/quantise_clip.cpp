#include "compact/quantise_clip.h"

#include "compact/lanes.h"
#include "evaluate.h"

#include <bendy/format/trig.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <type_traits>
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

/// The steps of all codes: packed_step, whose power of two takes longer than what is done with it.
float step_size(std::uint8_t code) {
    static const auto kSteps = [] {
        std::array<float, 256> steps{};
        for (std::size_t k = 0; k < steps.size(); ++k) steps.at(k) = packed_step(static_cast<std::uint8_t>(k));
        return steps;
    }();
    return kSteps[code];
}

// What is done to a joint at one frame is written for several frames at once too: T is double or Several.
template <class T>
using Vector = glm::vec<3, T>;
template <class T>
using Matrix = glm::mat<3, 3, T>;
template <class T>
using Turn = glm::qua<T>;

/// The rotation vector of q that is nearest to `near`, at most a turn long.
template <class T>
Vector<T> log_near(const Turn<T>& q, const Vector<T>& near) {
    const T sign = select(q.w < T(0.0), T(-1.0), T(1.0));
    const Vector<T> part(sign * q.x, sign * q.y, sign * q.z);
    const T sine = glm::length(part);
    const T angle = T(2.0) * atan2(sine, sign * q.w);
    const T length = glm::length(near);
    const Vector<T> without_axis = select(length > T(trig::kPi), near * (T(kTwoPi) / length), T(2.0) * part);
    const Vector<T> axis = part / sine;
    const Vector<T> other = axis * (angle - T(kTwoPi));
    const Vector<T> v = axis * angle;
    const Vector<T> a = v - near;
    const Vector<T> b = other - near;
    return select(sine < T(1e-9), without_axis, select(glm::dot(a, a) <= glm::dot(b, b), v, other));
}

template <class T>
Matrix<T> stretch_matrix(const Vector<T>& scale, const glm::vec3& shear) {
    const T none(0.0);
    return {scale.x, none, none, T(double{shear.x}), scale.y, none, T(double{shear.y}), T(double{shear.z}), scale.z};
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

}  // namespace

/// What of a clip is the same however often it is quantised.
class ClipFrames {
public:
    /// A joint's transform, as Affine.
    template <class T>
    struct Place {
        Matrix<T> linear{T(1.0)};
        Vector<T> origin{T(0.0)};

        Vector<T> operator()(const Vector<T>& point) const { return linear * point + origin; }
    };

    /// What the clip asks of a joint: relative to rest, as PACK stores it, and as it is where PACK has no such track.
    template <class T>
    struct Source {
        Vector<T> move, turn, grow;
        Turn<T> rotation;  // as it is
    };

    ClipFrames(const Scene& its_scene, const Clip& its_clip, const GridTracks& its_tracks)
        : scene(its_scene), clip(its_clip), tracks(its_tracks) {
        const std::size_t joints = scene.joints.size();
        rest.reserve(joints);
        for (const Joint& joint : scene.joints) rest.push_back(local_of(joint.rest));
        is_packed_.resize(joints);
        for (const std::uint32_t number : tracks.tracks) {
            const Track& track = clip.tracks[number];
            is_packed_[track.target][index(track.path)] = true;
        }
        read();
        choose_frames();
    }

    [[nodiscard]] std::size_t frames() const { return tracks.grid.frames; }

    /// A property relative to rest, as PACK stores it.
    [[nodiscard]] glm::dvec3 relative(std::size_t frame, std::size_t joint, TrackPath path) const {
        switch (path) {
            case TrackPath::translation:
                return local(frame, joint).translation - rest[joint].translation;
            case TrackPath::rotation:
                return vectors_[frame * scene.joints.size() + joint];
            default:
                return local(frame, joint).scale - rest[joint].scale;
        }
    }

    [[nodiscard]] Source<double> source(std::size_t frame, std::size_t joint) const {
        const Local& at = local(frame, joint);
        const auto& is_packed = is_packed_[joint];
        return {is_packed[0] ? relative(frame, joint, TrackPath::translation) : at.translation,
                relative(frame, joint, TrackPath::rotation),
                is_packed[2] ? relative(frame, joint, TrackPath::scale) : at.scale, at.rotation};
    }

    /// Where the clip has the joints at a frame.
    void place(std::size_t frame, std::span<Place<double>> out) const {
        for (std::size_t j = 0; j < scene.joints.size(); ++j) {
            const std::uint32_t parent = scene.joints[j].parent;
            const Affine at = to_affine(local(frame, j), scene.joints[j].rest.shear);
            if (parent == kNone) {
                out[j] = {at.linear, at.origin};
            } else {
                out[j] = {out[parent].linear * at.linear, out[parent](at.origin)};
            }
        }
    }

    const Scene& scene;
    const Clip& clip;
    const GridTracks& tracks;
    std::vector<Local> rest;  // per joint

    // The frames that steps are chosen on, kSeveral side by side; the last ones again where they do not come out even.
    std::size_t tried = 0;                 // frames
    std::size_t groups = 0;                // of them
    std::vector<Source<Several>> sources;  // group by group, per joint
    std::vector<Place<Several>> wanted;    // the same, model space

private:
    [[nodiscard]] const Local& local(std::size_t frame, std::size_t joint) const {
        return locals_[frame * scene.joints.size() + joint];
    }

    /// Local transforms at all frames, and rotations as vectors from rest that do not jump.
    void read() {
        const Grid& grid = tracks.grid;
        const std::size_t joints = scene.joints.size();
        locals_.resize(joints * grid.frames);
        vectors_.resize(joints * grid.frames);
        for (std::size_t f = 0; f < grid.frames; ++f)
            std::copy(rest.begin(), rest.end(), locals_.begin() + static_cast<std::ptrdiff_t>(f * joints));
        const double snap = grid.snap();
        std::vector<double> value;
        for (const Track& track : clip.tracks) {
            if (track.path == TrackPath::weights) continue;
            for (std::uint32_t f = 0; f < grid.frames; ++f) {
                evaluate_track(track, snapped(track, grid.time_of(f), snap), value);
                set_property(track.path, value, locals_[f * joints + track.target]);
            }
        }
        for (std::size_t j = 0; j < joints; ++j) {
            glm::dvec3 before(0.0);
            for (std::size_t f = 0; f < grid.frames; ++f) {
                const glm::dquat q = glm::conjugate(rest[j].rotation) * locals_[f * joints + j].rotation;
                before = vectors_[f * joints + j] = log_near<double>(q, before);
            }
        }
    }

    void choose_frames() {
        const std::size_t joints = scene.joints.size();
        tried = std::min<std::size_t>(frames(), kMostTried);
        groups = (tried + kSeveral - 1) / kSeveral;
        sources.resize(groups * joints);
        wanted.resize(groups * joints);
        std::vector<Place<double>> pose(joints);
        for (std::size_t k = 0; k < groups * kSeveral; ++k) {
            const std::size_t frame = tried < 2 ? 0 : std::min(k, tried - 1) * (frames() - 1) / (tried - 1);
            place(frame, pose);
            for (std::size_t j = 0; j < joints; ++j) {
                const std::size_t at = k / kSeveral * joints + j;
                put(source(frame, j), k % kSeveral, sources[at]);
                put(pose[j], k % kSeveral, wanted[at]);
            }
        }
    }

    static void put(const glm::dvec3& vector, std::size_t lane, Vector<Several>& out) {
        for (int c = 0; c < 3; ++c) set_lane(out[c], lane, vector[c]);
    }
    static void put(const Source<double>& source, std::size_t lane, Source<Several>& out) {
        put(source.move, lane, out.move);
        put(source.turn, lane, out.turn);
        put(source.grow, lane, out.grow);
        for (int c = 0; c < 4; ++c) set_lane(out.rotation[c], lane, source.rotation[c]);
    }
    static void put(const Place<double>& place, std::size_t lane, Place<Several>& out) {
        for (int c = 0; c < 3; ++c) put(place.linear[c], lane, out.linear[c]);
        put(place.origin, lane, out.origin);
    }

    std::vector<std::array<bool, kPaths>> is_packed_;  // per joint
    std::vector<Local> locals_;                        // frame by frame
    std::vector<glm::dvec3> vectors_;                  // frame by frame: rotations from rest
};

namespace {

template <class T>
using Place = ClipFrames::Place<T>;
template <class T>
using Source = ClipFrames::Source<T>;

class Quantiser {
public:
    Quantiser(const ClipFrames& frames, const std::vector<std::vector<glm::dvec3>>& probes,
              const QuantiseOptions& options)
        : frames_(frames), scene_(frames.scene), rest_(frames.rest), probes_(probes), options_(options) {
        plans_.resize(scene_.joints.size());
        find_subtrees();
        for (const std::uint32_t number : frames.tracks.tracks) open_property(frames.clip.tracks[number]);
        measure_reach();
        settle();
        decoded_.resize(frames.wanted.size());
        trial_.resize(frames.wanted.size());
        failed_at_.resize(frames.groups * kSeveral);
        is_tried_.resize(frames.groups);
        order_.resize(frames.tried);
        std::iota(order_.begin(), order_.end(), 0);
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
    template <class T>
    [[nodiscard]] Turn<T> correct(std::size_t joint, const Place<T>& parent, const Vector<T>& origin,
                                  const Matrix<T>& stretched, const Turn<T>& turn, const Place<T>& wanted) const {
        const Matrix<T> axes = parent.linear * glm::mat3_cast(turn);
        Matrix<T> normal(T(0.0));  // symmetric: its upper half
        Vector<T> right(T(0.0));
        for (const glm::dvec3& point : aims_[joint]) {
            const Vector<T> aim(point);
            const Vector<T> arm = stretched * aim;
            const Vector<T> off = wanted(aim) - (origin + axes * arm);
            const std::array<Vector<T>, 3> moves{axes[1] * -arm.z + axes[2] * arm.y, axes[0] * arm.z + axes[2] * -arm.x,
                                                 axes[0] * -arm.y + axes[1] * arm.x};
            for (int a = 0; a < 3; ++a) {
                const Vector<T>& move = moves[static_cast<std::size_t>(a)];
                right[a] += glm::dot(move, off);
                for (int b = a; b < 3; ++b) normal[b][a] += glm::dot(move, moves[static_cast<std::size_t>(b)]);
            }
        }
        const T damping = T(1e-6) * (normal[0][0] + normal[1][1] + normal[2][2]);
        for (int a = 0; a < 3; ++a) {
            normal[a][a] += damping;
            for (int b = 0; b < a; ++b) normal[b][a] = normal[a][b];
        }
        const Vector<T> by = glm::inverse(normal) * right;
        constexpr double kMost = 0.3;  // radians: what is farther off is not a rounding error
        return select(damping > T(0.0), select(glm::length(by) < T(kMost), turn * packed_turn(by), turn), turn);
    }

    /// What the property's whole numbers for a value relative to rest decode to. \param numbers  takes them of a double
    template <class T>
    static Vector<T> round(const Property& property, const Vector<T>& value, Numbers& numbers) {
        Vector<T> decoded;
        for (std::uint32_t c = 0; c < property.components; ++c) {
            const auto at = static_cast<int>(c);
            const T step(double{step_size(property.steps[c])});
            const T steps = whole(value[at] / step);
            if constexpr (std::is_same_v<T, double>) numbers[c] = static_cast<std::int32_t>(steps);
            decoded[at] = steps * step;
        }
        for (auto c = static_cast<int>(property.components); c < 3; ++c) decoded[c] = decoded[0];
        return decoded;
    }

    /// Quantises a joint whose parent is in its decoded place. `numbers` takes them by path.
    template <class T>
    Place<T> quantise_joint(std::size_t joint, const Source<T>& source, const Place<T>& parent, const Place<T>& wanted,
                            std::array<Numbers, kPaths>& numbers) const {
        const Plan& plan = plans_[joint];
        const Local& rest = rest_[joint];
        const Property& move = plan[index(TrackPath::translation)];
        Vector<T> translation = source.move;
        if (move.state != State::unpacked) {
            Vector<T> by = value_of(move, source.move);
            if (move.state == State::animated && options_.corrects) {
                const Vector<T> place =
                    glm::inverse(parent.linear) * (wanted.origin - parent.origin) - Vector<T>(rest.translation);
                const double near =
                    64.0 * double{step_size(move.steps[0]) + step_size(move.steps[1]) + step_size(move.steps[2])};
                by = select(glm::length(place - by) < T(near), place, by);  // not for parents without volume
            }
            if (move.state != State::rest) by = round(move, by, numbers[0]);
            translation = Vector<T>(rest.translation) + by;
        }
        const Property& grow = plan[index(TrackPath::scale)];
        Vector<T> scale = source.grow;
        if (grow.state != State::unpacked) {
            Vector<T> by = value_of(grow, source.grow);
            if (grow.state != State::rest) by = round(grow, by, numbers[2]);
            scale = Vector<T>(rest.scale) + by;
        }
        const Property& turn = plan[index(TrackPath::rotation)];
        const Matrix<T> stretched = stretch_matrix(scale, scene_.joints[joint].rest.shear);
        const Vector<T> origin = parent(translation);
        Turn<T> rotation = source.rotation;
        if (turn.state != State::unpacked) {
            const Turn<T> at_rest(rest.rotation);
            Vector<T> by = value_of(turn, source.turn);
            if (turn.state == State::animated && options_.corrects) {
                const Turn<T> wish = correct(joint, parent, origin, stretched, source.rotation, wanted);
                by = log_near(glm::conjugate(at_rest) * wish, source.turn);
            }
            if (turn.state != State::rest) by = round(turn, by, numbers[1]);
            rotation = turn.state == State::rest ? at_rest : at_rest * packed_turn(by);
        }
        return {parent.linear * (glm::mat3_cast(rotation) * stretched), origin};
    }

    template <class T>
    static Vector<T> value_of(const Property& property, const Vector<T>& exact) {
        if (property.state == State::rest) return Vector<T>(T(0.0));
        return property.state == State::constant ? Vector<T>(property.middle) : exact;
    }

    template <class T>
    [[nodiscard]] T square_error(std::size_t joint, const Place<T>& a, const Place<T>& b) const {
        T worst(0.0);
        const Matrix<T> linear = a.linear - b.linear;
        const Vector<T> origin = a.origin - b.origin;
        for (const glm::dvec3& probe : probes_[joint]) {
            const Vector<T> off = linear * Vector<T>(probe) + origin;
            const T square = glm::dot(off, off);
            worst = select(worst < square, square, worst);
        }
        return worst;
    }

    // --- choosing steps

    /// Quantises the joint and all below it at the tried frames of a group: failed_at_ takes, for each frame, the first
    /// joint with a probe that is farther off than allowed, or `end`. Stops where the frame `watched` fails.
    void try_group(std::size_t group, std::size_t first, std::size_t end, std::size_t watched) {
        const std::size_t row = group * scene_.joints.size();
        const Several most(options_.max_error * options_.max_error);
        std::array<Numbers, kPaths> unused;
        const auto failed_at = std::span(failed_at_).subspan(group * kSeveral, kSeveral);
        std::fill(failed_at.begin(), failed_at.end(), end);
        for (std::size_t j = first; j < end; ++j) {
            const std::uint32_t parent = scene_.joints[j].parent;
            const Place<Several>& wanted = frames_.wanted[row + j];
            const Place<Several> above =
                parent == kNone ? Place<Several>{} : (parent >= first ? trial_ : decoded_)[row + parent];
            trial_[row + j] = quantise_joint(j, frames_.sources[row + j], above, wanted, unused);
            const auto holds = square_error(j, trial_[row + j], wanted) <= most;
            for (std::size_t at = 0; at < kSeveral; ++at) {
                if (!lane(holds, at) && failed_at[at] == end) failed_at[at] = j;
            }
            if (failed_at_[watched] != end) return;
        }
    }

    /// Quantises the joint and all below it at all tried frames; true, and kept, if no probe is farther off than
    /// allowed. What is counted as work is what one frame after another would have taken.
    bool try_subtree(std::size_t first, std::size_t end) {
        std::fill(is_tried_.begin(), is_tried_.end(), false);
        for (std::size_t o = 0; o < order_.size(); ++o) {
            const std::size_t k = order_[o];
            const std::size_t group = k / kSeveral;
            if (!is_tried_[group]) try_group(group, first, end, k);
            is_tried_[group] = true;
            if (failed_at_[k] == end) continue;
            work_ += o * (end - first) + failed_at_[k] - first + 1;
            std::rotate(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(o),
                        order_.begin() + static_cast<std::ptrdiff_t>(o) + 1);
            return false;
        }
        work_ += order_.size() * (end - first);
        for (std::size_t group = 0; group < frames_.groups; ++group) {
            const auto row = static_cast<std::ptrdiff_t>(group * scene_.joints.size());
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
        const Grid& grid = frames_.tracks.grid;
        samples.frames = grid.frames;
        samples.start = grid.start;
        samples.frame_rate = grid.rate;
        samples.times = grid.times;
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
                track.numbers.resize(std::size_t{property.components} * (track.animated ? grid.frames : 1));
                samples.joints = track.joint + 1;
                samples.tracks.push_back(std::move(track));
            }
        }
        const std::size_t joints = scene_.joints.size();
        std::vector<Place<double>> wanted(joints);
        std::vector<Place<double>> decoded(joints);
        std::array<Numbers, kPaths> numbers{};
        for (std::size_t f = 0; f < grid.frames; ++f) {
            frames_.place(f, wanted);
            for (std::size_t j = 0; j < joints; ++j) {
                const std::uint32_t parent = scene_.joints[j].parent;
                decoded[j] = quantise_joint(j, frames_.source(f, j),
                                            parent == kNone ? Place<double>{} : decoded[parent], wanted[j], numbers);
                for (std::size_t path = 0; path < kPaths; ++path) {
                    const Property& property = plans_[j][path];
                    if (property.state != State::animated && property.state != State::constant) continue;
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
    const std::vector<Local>& rest_;  // per joint
    const std::vector<std::vector<glm::dvec3>>& probes_;
    QuantiseOptions options_;
    std::vector<Plan> plans_;                      // per joint
    std::vector<std::size_t> end_;                 // per joint: one past the last below it
    std::vector<std::vector<glm::dvec3>> aims_;    // per joint, in its space
    std::vector<std::size_t> order_;               // of tried frames: those that failed first
    std::vector<Place<Several>> decoded_, trial_;  // as ClipFrames::wanted
    std::vector<std::size_t> failed_at_;           // per tried frame, see try_group
    std::vector<bool> is_tried_;                   // per group
    std::uint64_t work_ = 0;
};

}  // namespace

std::shared_ptr<const ClipFrames> read_frames(const Scene& scene, const Clip& clip, const GridTracks& tracks) {
    return std::make_shared<const ClipFrames>(scene, clip, tracks);
}

PackedSamples quantise(const ClipFrames& frames, const std::vector<std::vector<glm::dvec3>>& probes,
                       const QuantiseOptions& options) {
    return Quantiser(frames, probes, options).run();
}

}  // namespace bendy::converter
