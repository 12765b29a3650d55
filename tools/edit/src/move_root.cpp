#include "move_root.h"

#include <bendy/format/bind_palette.h>

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
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
        if (const auto found = find_joints(from, to); !found) return found.error();
        if (from_ == to_) {
            log_.warnings.push_back("clip \"" + std::string(clip_.view->name) + "\": joint \"" + name(to_) +
                                    "\" moves over the ground already");
            return {};
        }
        if (track_of(from_, TrackPath::translation) == nullptr || !moves(from_, TrackPath::translation)) {
            log_.warnings.push_back("clip \"" + std::string(clip_.view->name) + "\": joint \"" + name(from_) +
                                    "\" does not move");
            return {};
        }
        for (std::uint32_t above = joints_[from_].parent; above != kNone; above = joints_[above].parent) {
            const bool is_moved = moves(above, TrackPath::translation) || moves(above, TrackPath::rotation) ||
                                  moves(above, TrackPath::scale);
            if (!is_moved) continue;
            return Problem{"joint \"" + name(above) + "\" above \"" + name(from_) +
                           "\" moves too; give it as the one that root motion is taken from"};
        }
        return send();
    }

private:
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

    Result<void, Problem> find_joints(std::string_view from, std::string_view to) {
        if (from.empty()) {
            const auto& roles = clip_.object->roles;
            const auto hips = std::find_if(roles.begin(), roles.end(), [](const RoleRecord& record) {
                return record.role == static_cast<std::uint16_t>(Role::hips);
            });
            if (hips == roles.end())
                return Problem{"no joint has the role hips; name the joint that moves, as in CLIP=JOINT.."};
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

    Result<void, Problem> send() {
        std::vector<std::uint32_t> parents;
        std::vector<RestRecord> rests;
        for (const JointView& joint : joints_) {
            parents.push_back(joint.parent);
            rests.push_back(joint.rest);
        }
        const glm::dvec3 at_rest = rest_matrices(rests, parents)[from_][3];
        const std::vector<RestRecord> still = still_pose();
        const std::vector<glm::dmat4> matrices = rest_matrices(still, parents);
        const auto above = [&](std::uint32_t joint) {
            return joints_[joint].parent == kNone ? glm::dmat4(1.0) : matrices[joints_[joint].parent];
        };
        // d = chosen * (A l + a - at_rest) is the movement, in model space; l the joint's translation.
        const glm::dmat3 chosen(glm::dvec3(1, 0, 0), glm::dvec3(0), glm::dvec3(0, 0, 1));
        const glm::dmat4 a = above(from_);
        const Affine movement{chosen * glm::dmat3(a), chosen * (glm::dvec3(a[3]) - at_rest)};
        const auto back = inverse_of(glm::dmat3(a));
        if (!back) return flat(from_);
        ClipTrack& track = clip_.tracks[tracks_[from_].at(0) - 1];
        tell(track, movement);
        ClipTrack moved = track;
        apply({cleaned(glm::dmat3(1.0) - *back * movement.matrix), -(*back * movement.shift)}, track);
        if (to_ == kNone) return {};
        const auto into = inverse_of(glm::dmat3(above(to_)));
        if (!into) return flat(to_);
        const auto& place = still[to_].translation;
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

    void tell(const ClipTrack& track, const Affine& movement) const {
        std::array<double, 3> first{};
        std::array<double, 3> last{};
        sample(track, clip_.start, first);
        sample(track, clip_.end, last);
        const glm::dvec3 way = movement.matrix * glm::dvec3(last[0] - first[0], last[1] - first[1], last[2] - first[2]);
        std::array<char, 32> metres{};
        std::snprintf(metres.data(), metres.size(), "%.3g m", std::sqrt(way.x * way.x + way.z * way.z));
        log_.done.push_back("root motion of clip \"" + std::string(clip_.view->name) + "\", " + metres.data() +
                            " from start to end: from joint \"" + name(from_) + '"' +
                            (to_ == kNone ? ", taken out" : " to \"" + name(to_) + '"'));
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

Result<void, Problem> move_root(ClipKeys& clip, std::string_view from, std::string_view to, Log& log) {
    return RootMover(clip, log).move(from, to);
}

}  // namespace bendy::edit
