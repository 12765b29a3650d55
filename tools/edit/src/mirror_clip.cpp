#include "mirror_clip.h"

#include <bendy/format/bind_palette.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <utility>

namespace bendy::edit {
namespace {

/// Rest poses are written with rounded numbers: what is this close to an axis, or to its mirror image, is meant to be
/// there. A ten-thousandth of a turn of one radian moves a hand by less than a tenth of a millimetre.
constexpr double kRestRounding = 1e-4;
/// Of the size of the skeleton: beyond it, a rest pose is not symmetric.
constexpr double kAsymmetry = 0.02;

glm::dquat to_quat(const std::array<float, 4>& q) {
    const glm::dquat quat(q[3], q[0], q[1], q[2]);
    const double length = std::sqrt(glm::dot(quat, quat));
    return length > 0.0 ? quat / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

glm::dvec3 to_vec(const std::array<float, 3>& v) {
    return {v[0], v[1], v[2]};
}

/// A unit vector or quaternion along an axis, if it is nearly along one.
template <class Numbers>
Numbers snapped(Numbers numbers) {
    Numbers axis = numbers;
    int ones = 0;
    for (int c = 0; c < Numbers::length(); ++c) {
        const bool is_one = std::abs(std::abs(numbers[c]) - 1.0) < kRestRounding;
        if (!is_one && !(std::abs(numbers[c]) < kRestRounding)) return numbers;
        axis[c] = is_one ? std::copysign(1.0, numbers[c]) : 0.0;
        ones += is_one ? 1 : 0;
    }
    return ones == 1 ? axis : numbers;
}

/// The matrix of a rotation; exact for a snapped one.
glm::dmat3 to_matrix(const glm::dquat& q) {
    glm::dmat3 matrix(0.0);
    for (int c = 0; c < 3; ++c) {
        glm::dvec3 axis(0.0);
        axis[c] = 1.0;
        const glm::dquat turned = q * glm::dquat(0.0, axis) * glm::conjugate(q);
        matrix[c] = glm::dvec3(turned.x, turned.y, turned.z);
    }
    return matrix;
}

/// The axes that scales are swapped along: each row has a 1 where the rotation's largest number is.
glm::dmat3 swapped_axes(const glm::dmat3& turn) {
    glm::dmat3 axes(0.0);
    for (int row = 0; row < 3; ++row) {
        int largest = 0;
        for (int c = 1; c < 3; ++c) {
            if (std::abs(turn[c][row]) > std::abs(turn[largest][row])) largest = c;
        }
        axes[largest][row] = 1.0;
    }
    return axes;
}

/// `to` minus where `from` comes to lie; zeros if they differ by rounding.
glm::dvec3 shift_between(const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 shift = to - from;
    return glm::length(shift) <= kRestRounding * 0.1 * glm::length(to) ? glm::dvec3(0.0) : shift;
}

void map_rotation(std::span<float> q, const glm::dquat& before, const glm::dquat& after, bool is_unit) {
    const glm::dquat turned = before * glm::dquat(q[3], q[0], q[1], q[2]) * after;
    const double square = glm::dot(turned, turned);
    const double scale = is_unit && std::abs(square - 1.0) > kUnitTolerance ? 1.0 / std::sqrt(square) : 1.0;
    q[0] = static_cast<float>(turned.x * scale);
    q[1] = static_cast<float>(turned.y * scale);
    q[2] = static_cast<float>(turned.z * scale);
    q[3] = static_cast<float>(turned.w * scale);
}

void map_vector(std::span<float> v, const glm::dmat3& matrix, const glm::dvec3& shift) {
    const glm::dvec3 moved = matrix * glm::dvec3(v[0], v[1], v[2]) + shift;
    for (int c = 0; c < 3; ++c) v[static_cast<std::size_t>(c)] = static_cast<float>(moved[c]);
}

std::string millimetres(double metres) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3g mm", metres * 1e3);
    return text.data();
}

bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

Mirror::Mirror(const Document& document, const ObjectView& object)
    : object_(&object),
      sides_(pair_joints(object)),
      materials_(pair_sides(names_of(std::span(document.materials).first(document.global_materials)))),
      textures_(pair_sides(names_of(document.textures))),
      lists_(document.extensions) {}

Result<Mirror, Problem> Mirror::of(const Document& document, const ObjectView& object) {
    Mirror mirror(document, object);
    if (const auto measured = mirror.measure(); !measured) return measured.error();
    mirror.make_maps();
    mirror.pair_meshes();
    return mirror;
}

Result<void, Problem> Mirror::measure() {
    const auto& joints = object_->skeleton.joints;
    std::vector<RestRecord> rests;
    std::vector<std::uint32_t> parents;
    for (const JointView& joint : joints) {
        const glm::dquat local = to_quat(joint.rest.rotation);
        rotations_.push_back(joint.parent == kNone ? local : glm::normalize(rotations_[joint.parent] * local));
        rests.push_back(joint.rest);
        parents.push_back(joint.parent);
    }
    for (const glm::dmat4& matrix : rest_matrices(rests, parents)) positions_.emplace_back(matrix[3]);
    if (sides_.pairs == 0) {
        return Problem{
            "no two joints are a left and a right one, by their roles or by names such as arm.L and arm.R; --role "
            "ROLE=JOINT says what they are"};
    }
    glm::dvec3 across(0.0);
    glm::dvec3 between(0.0);
    double pairs = 0.0;
    for (std::uint32_t left = 0; left < joints.size(); ++left) {
        const std::uint32_t right = sides_.other[left];
        if (!sides_.is_left[left] || !is_finite(positions_[left]) || !is_finite(positions_[right])) continue;
        if (positions_[left] == positions_[right]) continue;  // such as expressions, which have no place
        across += positions_[left] - positions_[right];
        between += 0.5 * (positions_[left] + positions_[right]);
        size_ = std::max(size_, glm::distance(positions_[left], positions_[right]));
        pairs += 1.0;
    }
    const double length = glm::length(across);
    if (!(length > 1e-3 * size_ * pairs) || !std::isfinite(length))
        return Problem{"left and right joints are at the same place at rest, so there is no plane between them"};
    normal_ = snapped(across / length);
    offset_ = glm::dot(normal_, between) / pairs;
    return {};
}

void Mirror::make_maps() {
    const auto& joints = object_->skeleton.joints;
    const glm::dquat half_turn(0.0, normal_);
    std::vector<glm::dquat> changes;  // c, by joint
    for (std::uint32_t joint = 0; joint < joints.size(); ++joint) {
        const glm::dquat c = glm::conjugate(rotations_[joint]) * half_turn * rotations_[sides_.other[joint]];
        changes.push_back(snapped(c));
    }
    for (std::uint32_t joint = 0; joint < joints.size(); ++joint) {
        const RestRecord& rest = joints[joint].rest;
        const RestRecord& there = joints[sides_.other[joint]].rest;
        Map& map = maps_.emplace_back();
        map.before = glm::conjugate(joints[joint].parent == kNone ? half_turn : changes[joints[joint].parent]);
        map.after = changes[joint];
        // A reflection is the half turn about its normal, with all signs changed.
        map.move = -to_matrix(map.before);
        map.shift = shift_between(map.move * to_vec(rest.translation), to_vec(there.translation));
        map.scale = swapped_axes(to_matrix(glm::conjugate(map.after)));
        map.scale_shift = shift_between(map.scale * to_vec(rest.scale), to_vec(there.scale));
    }
}

void Mirror::pair_meshes() {
    const auto& meshes = object_->meshes;
    meshes_ = pair_sides(names_of(meshes));
    for (std::uint32_t mesh = 0; mesh < meshes.size(); ++mesh) {
        const auto names = names_of(meshes[mesh].targets);
        const auto swapped = pair_sides(names);
        std::vector<std::uint32_t>& targets = targets_.emplace_back(swapped);
        if (meshes_[mesh] == mesh) continue;
        // To the other mesh if it has all the targets, in any order; a target has its own name there, or the other one.
        const auto names_there = names_of(meshes[meshes_[mesh]].targets);
        std::vector<bool> is_taken(names_there.size());
        bool fits = names.size() == names_there.size();
        for (std::size_t t = 0; t < names.size() && fits; ++t) {
            const std::string wanted = other_side(names[t]);
            std::size_t place = t;
            if (names_there[t] != wanted || is_taken[t]) {
                place = 0;
                while (place < names_there.size() && (is_taken[place] || names_there[place] != wanted)) ++place;
            }
            fits = place < names_there.size();
            if (!fits) break;
            is_taken[place] = true;
            targets[t] = static_cast<std::uint32_t>(place);
        }
        if (fits) continue;
        meshes_[meshes_[mesh]] = meshes_[mesh];
        meshes_[mesh] = mesh;
        targets = swapped;
    }
    for (std::uint32_t mesh = 0; mesh < meshes.size(); ++mesh) {  // both must fit
        if (meshes_[meshes_[mesh]] == mesh) continue;
        meshes_[mesh] = mesh;
        targets_[mesh] = pair_sides(names_of(meshes[mesh].targets));
    }
}

void Mirror::change_weights(ClipTrack& track) const {
    const std::vector<std::uint32_t>& to = targets_[track.target];
    std::vector<float> moved(track.components);
    for (std::size_t at = 0; at < track.values.size(); at += track.components) {
        const auto row = std::span(track.values).subspan(at, track.components);
        for (std::size_t t = 0; t < row.size(); ++t) moved[to[t]] = row[t];
        std::copy(moved.begin(), moved.end(), row.begin());
    }
    track.target = meshes_[track.target];
}

Mirror::Expressions Mirror::pair_expressions(const ClipKeys& clip) const {
    const auto is_expression = [](const CurveView& curve) {
        return curve.kind == CurveTarget::joint && curve.path == kExpressionPath;
    };
    std::map<std::string_view, std::uint32_t> by_name;  // in all clips: this one may have only those of one side
    for (const ClipView& each : object_->clips) {
        for (const CurveView& curve : each.curves) {
            if (is_expression(curve)) by_name.try_emplace(curve.name, curve.target);
        }
    }
    Expressions expressions;
    for (const ClipCurve& curve : clip.curves) {
        if (!is_expression(*curve.view)) continue;
        const std::string there = other_side(curve.name);
        const auto found = by_name.find(there);
        const std::uint32_t paired = sides_.other[curve.target];
        const std::uint32_t alone = paired != curve.target ? paired : kNone;
        const std::uint32_t other = found != by_name.end() ? found->second : alone;
        expressions.try_emplace(curve.target, there == curve.name ? curve.target : other);
    }
    return expressions;
}

void Mirror::change_track(ClipTrack& track, const Expressions& expressions) const {
    if (track.path == TrackPath::weights) return change_weights(track);
    if (const auto expression = expressions.find(track.target); expression != expressions.end()) {
        if (expression->second != kNone) track.target = expression->second;
        return;  // a number, not a place
    }
    if (sides_.is_kept[track.target]) return;
    const Map& map = maps_[track.target];
    track.target = sides_.other[track.target];
    const std::size_t n = track.components;
    for (std::size_t at = 0; at < track.values.size(); at += n) {
        const auto row = std::span(track.values).subspan(at, n);
        const bool is_tangent = track.is_cubic() && at / n % 3 != 1;
        const glm::dvec3 none(0.0);
        if (track.path == TrackPath::rotation) map_rotation(row, map.before, map.after, !track.is_cubic());
        if (track.path == TrackPath::translation) map_vector(row, map.move, is_tangent ? none : map.shift);
        if (track.path == TrackPath::scale) map_vector(row, map.scale, is_tangent ? none : map.scale_shift);
    }
}

/// Nothing: the curve cannot be mirrored.
std::optional<std::uint32_t> Mirror::target_there(const ClipCurve& curve, const Expressions& expressions) const {
    switch (curve.view->kind) {
        case CurveTarget::joint:
            if (curve.path == kExpressionPath) {
                const std::uint32_t other = expressions.at(curve.target);
                return other == kNone ? std::nullopt : std::optional(other);
            }
            if (sides_.is_kept[curve.target]) return std::nullopt;
            return sides_.other[curve.target];
        case CurveTarget::mesh:
            return meshes_[curve.target];
        case CurveTarget::material:
            return materials_[curve.target];
        case CurveTarget::texture:
            return textures_[curve.target];
        default:
            return curve.target;
    }
}

/// The path with the sides in it swapped, unless there is something at the path, and nothing on the other side; an
/// element of a list, such as a light, gives way to the one whose name is that of the other side.
std::string Mirror::path_there(const ClipCurve& curve) {
    if (curve.view->kind != CurveTarget::nothing) return other_side(curve.path);
    const auto other = [&](std::string_view list, std::string_view /*after*/, std::uint32_t element) {
        auto known = elements_.find(list);
        if (known == elements_.end()) {
            const std::vector<std::string>& names = lists_.list(list).names;
            known = elements_
                        .try_emplace(std::string(list),
                                     pair_sides(std::vector<std::string_view>(names.begin(), names.end())))
                        .first;
        }
        return std::optional(known->second[element]);
    };
    const std::string path = lists_.with_elements(curve.path, other).value_or(curve.path);
    const std::string swapped = other_side(path);
    return lists_.has(path) && !lists_.has(swapped) ? path : swapped;
}

void Mirror::change_curves(ClipKeys& clip, const Expressions& expressions, Log& log) {
    std::map<std::string_view, const CurveView*> by_name;
    for (const CurveView& curve : clip.view->curves) by_name.try_emplace(curve.name, &curve);
    std::vector<std::string_view> all;
    std::vector<std::size_t> kept;
    for (ClipCurve& curve : clip.curves) {
        all.push_back(curve.view->name.empty() ? curve.view->path : curve.view->name);
        const std::optional<std::uint32_t> target = target_there(curve, expressions);
        const std::string path = path_there(curve);
        const std::string name = other_side(curve.name);
        const bool is_moved = target && (*target != curve.target || path != curve.path);
        const auto counterpart = is_moved || name == curve.name ? by_name.end() : by_name.find(name);
        const bool has_place = !curve.path.empty() && curve.path != kExpressionPath;
        if (counterpart != by_name.end() && counterpart->second->kind == curve.view->kind && target) {
            curve.target = counterpart->second->target;  // the one that has the other name has the other place
            curve.path = counterpart->second->path;
        } else if (!target || (!is_moved && has_place && other_side(curve.path) != curve.path)) {
            kept.push_back(all.size() - 1);
            continue;
        } else {
            curve.target = *target;
            curve.path = path;
        }
        curve.name = name;
    }
    if (kept.empty()) return;
    log.warnings.push_back("not mirrored, without a counterpart: " +
                           (kept.size() == 1 ? "curve " : std::to_string(kept.size()) + " curves: ") +
                           list_names(all, kept));
}

void Mirror::warn(const ClipKeys& clip, const Expressions& expressions, Log& log) const {
    std::set<std::uint32_t> moved;
    for (const ClipTrack& track : clip.tracks) {
        const bool is_joint = track.path != TrackPath::weights && !expressions.contains(track.target);
        if (is_joint) moved.insert(track.target);
    }
    const auto names = names_of(object_->skeleton.joints);
    std::vector<std::size_t> kept;
    std::vector<std::size_t> alone;
    double worst = 0.0;
    std::uint32_t at = 0;
    for (const std::uint32_t joint : moved) {
        if (sides_.is_kept[joint]) {
            kept.push_back(joint);
            continue;
        }
        const glm::dvec3& here = positions_[joint];
        const glm::dvec3 image = here - 2.0 * (glm::dot(normal_, here) - offset_) * normal_;
        const double off = glm::distance(image, positions_[sides_.other[joint]]);
        if (sides_.other[joint] == joint) {
            if (off > 2.0 * kAsymmetry * size_) alone.push_back(joint);
        } else if (off > worst) {
            worst = off;
            at = joint;
        }
    }
    const auto list = [&](const std::vector<std::size_t>& joints) {
        return (joints.size() == 1 ? "joint " : std::to_string(joints.size()) + " joints: ") +
               list_names(names, joints);
    };
    if (!kept.empty()) log.warnings.push_back("not mirrored, without a counterpart: " + list(kept));
    if (!alone.empty()) {
        log.warnings.push_back("mirrored in its place, beside the middle and without a counterpart: " + list(alone));
    }
    if (worst > kAsymmetry * size_) {
        log.warnings.push_back("the rest pose is not symmetric: joint \"" + std::string(names[at]) + "\" is " +
                               millimetres(worst) + " from the mirror image of \"" +
                               std::string(names[sides_.other[at]]) + '"');
    }
}

Result<void, Problem> Mirror::change(ClipKeys& clip, Log& log) {
    if (!clip.plays.empty()) return Problem{"it plays stored frames, which cannot be mirrored"};
    const Expressions expressions = pair_expressions(clip);
    warn(clip, expressions, log);
    for (ClipTrack& track : clip.tracks) change_track(track, expressions);
    change_curves(clip, expressions, log);
    for (ClipMarker& marker : clip.markers) marker.name = other_side(marker.name);
    return {};
}

}  // namespace bendy::edit
