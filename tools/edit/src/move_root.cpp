#include "move_root.h"

#include "cycle.h"
#include "low_pass.h"

#include <bendy/format/bind_palette.h>

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace bendy::edit {
namespace {

/// Rounding, relative to the numbers that went into a matrix.
constexpr double kMatrixRounding = 1e-12;

/// value becomes matrix * value + shift.
struct Affine {
    glm::dmat3 matrix{1.0};
    glm::dvec3 shift{0.0};
};

/// Removes rounding, so that what does not change keeps its bits.
glm::dmat3 cleaned(glm::dmat3 matrix) {
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
            const double whole = std::round(matrix[c][r]);
            if (std::abs(matrix[c][r] - whole) < kMatrixRounding) matrix[c][r] = whole;
        }
    }
    return matrix;
}

void apply(const Affine& map, ClipTrack& track) {
    const std::size_t n = track.components;
    for (std::size_t at = 0; at < track.values.size(); at += n) {
        const bool is_tangent = track.is_cubic() && at / n % 3 != 1;
        glm::dvec3 value(track.values[at], track.values[at + 1], track.values[at + 2]);
        value = map.matrix * value + (is_tangent ? glm::dvec3(0.0) : map.shift);
        for (int c = 0; c < 3; ++c) track.values[at + static_cast<std::size_t>(c)] = static_cast<float>(value[c]);
    }
}

class RootMover {
public:
    RootMover(ClipKeys& clip, Log& log) : clip_(clip), log_(log), joints_(clip.object->skeleton.joints) {
        tracks_.resize(joints_.size());
        for (std::size_t k = 0; k < clip.tracks.size(); ++k) {
            const ClipTrack& track = clip.tracks[k];
            if (track.path != TrackPath::weights)
                tracks_[track.target].at(static_cast<std::size_t>(track.path)) = k + 1;
        }
    }

    Result<void, Problem> move(std::string_view from, std::string_view to) {
        if (const auto found = find_joints(from, to, "name the joint that moves, as in CLIP=JOINT.."); !found)
            return found.error();
        if (from_ == to_) {
            log_.warnings.push_back("clip \"" + std::string(clip_.view->name) + "\": joint \"" + name(to_) +
                                    "\" moves over the ground already");
            return {};
        }
        if (!moves(from_, TrackPath::translation)) {
            warn_that_it_rests();
            return {};
        }
        if (const auto free = check_those_above(); !free) return free.error();
        return send();
    }

    Result<void, Problem> stay(double window) {
        const double length = double{clip_.end} - clip_.start;
        const auto seconds = [](double number) { return with_three_digits(number) + " s"; };
        if (window > length)
            return Problem{"it lasts " + seconds(length) + ", and its way cannot be averaged over " + seconds(window)};
        if (const auto found = find_joints({}, {}, "--role hips=JOINT says which joint moves"); !found)
            return found.error();
        if (!moves(from_, TrackPath::translation) || !(length > 0.0)) {
            warn_that_it_rests();
            return {};
        }
        if (const auto free = check_those_above(); !free) return free.error();
        const Cycle cycle = find_cycle(clip_);
        if (window == 0.0 && !cycle.seconds) {
            log_.warnings.push_back("clip \"" + std::string(clip_.view->name) +
                                    "\" has no cycle that repeats: its way is "
                                    "averaged over its whole length; CLIP@SECONDS says over how much");
        }
        return take_out(window > 0.0 ? window : cycle.seconds.value_or(length), cycle.repeats);
    }

private:
    static constexpr std::size_t kMostKnots = 1u << 16u;
    static constexpr std::uint64_t kMostMoved = std::uint64_t{1} << 33u;  // numbers, to insert keys among others

    static std::string with_three_digits(double number) {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%.3g", std::abs(number) < 1e-6 ? 0.0 : number);
        return text.data();
    }

    void warn_that_it_rests() const {
        log_.warnings.push_back("clip \"" + std::string(clip_.view->name) + "\": joint \"" + name(from_) +
                                "\" does not move");
    }

    /// Joints above the one that moves must not move themselves.
    [[nodiscard]] Result<void, Problem> check_those_above() const {
        for (std::uint32_t above = joints_[from_].parent; above != kNone; above = joints_[above].parent) {
            const bool is_moved = moves(above, TrackPath::translation) || moves(above, TrackPath::rotation) ||
                                  moves(above, TrackPath::scale);
            if (!is_moved) continue;
            return Problem{"joint \"" + name(above) + "\" above \"" + name(from_) +
                           "\" moves too; give it as the one that root motion is taken from"};
        }
        return {};
    }

    [[nodiscard]] std::string name(std::uint32_t joint) const { return std::string(joints_[joint].name); }

    [[nodiscard]] const ClipTrack* track_of(std::uint32_t joint, TrackPath path) const {
        const std::size_t place = tracks_[joint].at(static_cast<std::size_t>(path));
        return place == 0 ? nullptr : &clip_.tracks[place - 1];
    }
    [[nodiscard]] bool moves(std::uint32_t joint, TrackPath path) const {
        const ClipTrack* const track = track_of(joint, path);
        return track != nullptr && !track->is_constant();
    }

    Result<std::uint32_t, Problem> find_one(std::string_view wanted) const {
        const auto found = find_named(names_of(joints_), wanted, "joint");
        if (!found) return found.error();
        if (found->size() > 1) {
            return Problem{std::to_string(found->size()) + " joints are called \"" + std::string(wanted) +
                           "\"; say which by its number, as in #" + std::to_string(found->front())};
        }
        return static_cast<std::uint32_t>(found->front());
    }

    /// \param advice  what to do if the joint is not known
    Result<void, Problem> find_joints(std::string_view from, std::string_view to, std::string_view advice) {
        if (from.empty()) {
            const auto& roles = clip_.object->roles;
            const auto hips = std::find_if(roles.begin(), roles.end(), [](const RoleRecord& record) {
                return record.role == static_cast<std::uint16_t>(Role::hips);
            });
            if (hips == roles.end()) return Problem{"no joint has the role hips; " + std::string(advice)};
            from_ = hips->joint;
            for (std::uint32_t at = from_; at != kNone; at = joints_[at].parent) {
                if (moves(at, TrackPath::translation)) from_ = at;
            }
        } else {
            const auto found = find_one(from);
            if (!found) return found.error();
            from_ = *found;
        }
        if (to.empty()) return {};
        const auto found = find_one(to);
        if (!found) return found.error();
        to_ = *found;
        std::uint32_t above = from.empty() ? from_ : joints_[from_].parent;  // it may be the highest one that moves
        while (above != kNone && above != to_) above = joints_[above].parent;
        if (above != kNone) return {};
        return Problem{"joint \"" + name(to_) + "\" is not above \"" + name(from_) + "\", whose movement it would get"};
    }

    /// The rest pose with what the clip sets and does not move.
    [[nodiscard]] std::vector<RestRecord> still_pose() const {
        std::vector<RestRecord> rests;
        for (std::uint32_t joint = 0; joint < joints_.size(); ++joint) {
            RestRecord& rest = rests.emplace_back(joints_[joint].rest);
            const auto set = [&](TrackPath path, auto& numbers) {
                const ClipTrack* const track = track_of(joint, path);
                if (track == nullptr) return;
                const auto value = track->value(0);
                std::copy(value.begin(), value.end(), numbers.begin());
            };
            set(TrackPath::translation, rest.translation);
            set(TrackPath::rotation, rest.rotation);
            set(TrackPath::scale, rest.scale);
        }
        return rests;
    }

    /// The movement of a joint over the ground, d = matrix * l + shift in model space, l the joint's translation; and
    /// the way back to l.
    struct Ground {
        Affine movement;
        glm::dmat3 back{1.0};
        std::vector<RestRecord> still;     ///< see still_pose
        std::vector<glm::dmat4> matrices;  ///< of that pose
    };

    [[nodiscard]] glm::dmat4 above(const Ground& ground, std::uint32_t joint) const {
        return joints_[joint].parent == kNone ? glm::dmat4(1.0) : ground.matrices[joints_[joint].parent];
    }

    [[nodiscard]] Result<Ground, Problem> find_ground() const {
        std::vector<std::uint32_t> parents;
        std::vector<RestRecord> rests;
        for (const JointView& joint : joints_) {
            parents.push_back(joint.parent);
            rests.push_back(joint.rest);
        }
        const glm::dvec3 at_rest = rest_matrices(rests, parents)[from_][3];
        Ground ground;
        ground.still = still_pose();
        ground.matrices = rest_matrices(ground.still, parents);
        const glm::dmat4 space = above(ground, from_);
        const auto back = inverse_of(glm::dmat3(space));
        if (!back) return flat(from_);
        const glm::dmat3 chosen(glm::dvec3(1, 0, 0), glm::dvec3(0), glm::dvec3(0, 0, 1));
        ground.movement = {chosen * glm::dmat3(space), chosen * (glm::dvec3(space[3]) - at_rest)};
        ground.back = *back;
        return ground;
    }

    [[nodiscard]] ClipTrack& moving_track() { return clip_.tracks[tracks_[from_].at(0) - 1]; }

    Result<void, Problem> send() {
        const auto ground = find_ground();
        if (!ground) return ground.error();
        const Affine& movement = ground->movement;
        ClipTrack& track = moving_track();
        log_.done.push_back("root motion of " + way_of(track, movement) + " from start to end: from joint \"" +
                            name(from_) + '"' + (to_ == kNone ? ", taken out" : " to \"" + name(to_) + '"'));
        ClipTrack moved = track;
        apply({cleaned(glm::dmat3(1.0) - ground->back * movement.matrix), -(ground->back * movement.shift)}, track);
        if (to_ == kNone) return {};
        const auto into = inverse_of(glm::dmat3(above(*ground, to_)));
        if (!into) return flat(to_);
        const auto& place = ground->still[to_].translation;
        apply({cleaned(*into * movement.matrix), *into * movement.shift + glm::dvec3(place[0], place[1], place[2])},
              moved);
        moved.target = to_;
        if (const std::size_t before = tracks_[to_].at(0); before != 0) {
            clip_.tracks[before - 1] = std::move(moved);
        } else {
            clip_.tracks.push_back(std::move(moved));
        }
        warn_of_others();
        return {};
    }

    /// The mean of the movement over a window around each time goes.
    Result<void, Problem> take_out(double window, bool repeats) {
        const auto ground = find_ground();
        if (!ground) return ground.error();
        ClipTrack& track = moving_track();
        const double length = double{clip_.end} - clip_.start;
        const LowPass path(places_of(track, ground->movement, length), length, window, repeats);
        log_.done.push_back(way_of(track, ground->movement) + " at " +
                            with_three_digits(glm::length(path.at(length) - path.at(0.0)) / length) +
                            " m/s, averaged over " + with_three_digits(window) + " s: taken out of joint \"" +
                            name(from_) + '"');
        const std::vector<double> knots = knots_of(path, track, length);
        if (knots.size() > kMostKnots || std::uint64_t{knots.size()} * track.values.size() > kMostMoved)
            return Problem{"its way is too long or too winding; --trim takes a part of it"};
        for (const double at : knots) insert_key(track, static_cast<float>(clip_.start + at));
        for (std::size_t k = 0; k < track.times.size(); ++k) {
            const double at = std::clamp(double{track.times[k]} - clip_.start, 0.0, length);
            const std::span<float> key = track.key(k);
            const glm::dvec3 place = ground->back * path.at(at), slope = ground->back * path.slope(at);
            for (std::size_t c = 0; c < key.size(); ++c) {
                const auto axis = static_cast<int>(c % 3);
                const bool is_value = !track.is_cubic() || c / 3 == 1;
                key[c] = static_cast<float>(double{key[c]} - (is_value ? place[axis] : slope[axis]));
            }
        }
        track.has_frames = false;
        return {};
    }

    [[nodiscard]] std::vector<glm::dvec3> places_of(const ClipTrack& track, const Affine& movement,
                                                    double length) const {
        constexpr double kPlacesPerSecond = 240.0, kMost = 1e6;
        const auto steps = static_cast<std::uint32_t>(std::clamp(std::ceil(length * kPlacesPerSecond), 2.0, kMost));
        std::vector<glm::dvec3> places;
        for (std::uint32_t k = 0; k <= steps; ++k) {
            std::array<double, 3> value{};
            sample(track, clip_.start + length * k / steps, value);
            places.push_back(movement.matrix * glm::dvec3(value[0], value[1], value[2]) + movement.shift);
        }
        return places;
    }

    /// Times between the track's keys at which there must be another, since the path is not straight.
    static std::vector<double> knots_of(const LowPass& path, const ClipTrack& track, double length) {
        constexpr double kStraight = 2e-4, kClosest = 1.0 / 120.0;  // metres, seconds
        std::vector<double> knots;
        if (track.interpolation == Interpolation::step) return knots;
        std::vector<std::pair<double, double>> spans{{0.0, length}};
        while (!spans.empty() && knots.size() <= kMostKnots) {
            const auto [from, to] = spans.back();
            spans.pop_back();
            const auto off = [&, from = from, to = to](double share) {
                return glm::length(path.at(from + share * (to - from)) -
                                   ((1.0 - share) * path.at(from) + share * path.at(to)));
            };
            if (to - from < kClosest || std::max({off(0.25), off(0.5), off(0.75)}) < kStraight) continue;
            const double middle = 0.5 * (from + to);
            knots.push_back(middle);
            spans.insert(spans.end(), {{from, middle}, {middle, to}});
        }
        return knots;
    }

    [[nodiscard]] static Result<glm::dmat3, Problem> inverse_of(const glm::dmat3& matrix) {
        const glm::dmat3 inverse = glm::inverse(matrix);
        for (int c = 0; c < 3; ++c) {
            for (int r = 0; r < 3; ++r) {
                if (!std::isfinite(inverse[c][r])) return Problem{};
            }
        }
        return inverse;
    }
    [[nodiscard]] Problem flat(std::uint32_t joint) const {
        return {"a joint above \"" + name(joint) + "\" is scaled to nothing, so that it cannot move"};
    }

    /// "clip "Walk", 1.4 m"
    [[nodiscard]] std::string way_of(const ClipTrack& track, const Affine& movement) const {
        std::array<double, 3> first{};
        std::array<double, 3> last{};
        sample(track, clip_.start, first);
        sample(track, clip_.end, last);
        const glm::dvec3 way = movement.matrix * glm::dvec3(last[0] - first[0], last[1] - first[1], last[2] - first[2]);
        return "clip \"" + std::string(clip_.view->name) + "\", " + with_three_digits(glm::length(way)) + " m";
    }

    /// Other joints below the one that moves now move with it.
    void warn_of_others() const {
        std::vector<std::size_t> others;
        std::vector<bool> is_on_path(joints_.size());
        for (std::uint32_t at = from_; at != to_; at = joints_[at].parent) is_on_path[at] = true;
        for (std::uint32_t joint = 0; joint < joints_.size(); ++joint) {
            const std::uint32_t parent = joints_[joint].parent;
            if (is_on_path[joint] || parent == kNone) continue;
            const bool hangs_there = parent == to_ || (is_on_path[parent] && parent != from_);
            if (hangs_there && moves(joint, TrackPath::translation)) others.push_back(joint);
        }
        if (!others.empty()) {
            log_.warnings.push_back("clip \"" + std::string(clip_.view->name) + "\": these move with \"" + name(to_) +
                                    "\" now, besides their own movement: joints " +
                                    list_names(names_of(joints_), others));
        }
    }

    ClipKeys& clip_;
    Log& log_;
    const std::vector<JointView>& joints_;
    std::vector<std::array<std::size_t, 3>> tracks_;  // by joint and path: number of the track, plus 1; 0: none
    std::uint32_t from_ = kNone, to_ = kNone;
};

}  // namespace

Result<void, Problem> keep_on_the_spot(ClipKeys& clip, double window, Log& log) {
    return RootMover(clip, log).stay(window);
}

Result<void, Problem> move_root(ClipKeys& clip, std::string_view from, std::string_view to, Log& log) {
    return RootMover(clip, log).move(from, to);
}

}  // namespace bendy::edit
