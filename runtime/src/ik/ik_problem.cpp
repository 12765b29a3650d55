#include "ik_problem.h"

#include "math/nearest_rotation.h"
#include "math/rotation.h"

#include <bendy/format/trig.h>

#include <algorithm>
#include <cmath>

namespace bendy {
namespace {

template <class Legal>
glm::dquat through_limits(const IkLink& link, const glm::dquat& local, const Legal& legal) {
    const glm::dquat R = glm::conjugate(link.rest_frame) * local * link.frame;
    const glm::dquat inside = legal(R);
    return inside == R ? local : glm::normalize(link.rest_frame * inside * glm::conjugate(link.frame));
}

/// Returns how far a joint swings about Y and about Z: low and high limit together; zero if it has no swing.
glm::dvec2 swing_widths(const Constraint& constraint) {
    const ConstraintModel model = constraint.model();
    if (model != ConstraintModel::swing_twist_ellipse && model != ConstraintModel::swing_twist_pyramid)
        return glm::dvec2(0.0);
    const LimitShape& shape = constraint.shape;
    return {shape.swing_low[0] + shape.swing_high[0], shape.swing_low[1] + shape.swing_high[1]};
}

}  // namespace

void IkProblem::place(std::size_t first) {
    if (is_uneven) return place_unevenly();
    glm::dquat global = first == 0 ? glm::dquat(1.0, 0.0, 0.0, 0.0) : links[first - 1].global;
    glm::dvec3 position = first == 0 ? origin : links[first - 1].position + global * links[first - 1].bone;
    for (std::size_t i = first; i < links.size(); ++i) {
        IkLink& link = links[i];
        global = global * link.local;
        link.global = global;
        link.position = position;
        position += global * link.bone;
    }
    tip = position;
    tip_global = global * tip_rotation;
}

void IkProblem::place_unevenly() {
    glm::dmat3 space(1.0);
    glm::dquat global(1.0, 0.0, 0.0, 0.0);
    glm::dvec3 position = origin;
    for (IkLink& link : links) {
        global = global * link.local;
        link.global = global;
        link.position = position;
        link.space = space;
        space = space * glm::mat3_cast(link.local) * link.shape;
        const glm::dvec3 bone = space * link.end;
        link.bone = glm::conjugate(global) * bone;
        link.bone_length = glm::length(bone);
        position += bone;
    }
    tip = position;
    tip_global = global * tip_rotation;
    glm::dvec3 arm(0.0);
    for (std::size_t i = links.size(); i-- > 0;) {
        IkLink& link = links[i];
        arm = link.local * (link.shape * (link.end + arm));
        link.arm = arm;
    }
}

void IkProblem::place_next(std::size_t link) {
    if (is_uneven) return place_unevenly();
    const IkLink& before = links[link];
    const glm::dvec3 end = before.position + before.global * before.bone;
    if (link + 1 == links.size()) {
        tip = end;
        tip_global = before.global * tip_rotation;
    } else {
        links[link + 1].position = end;
        links[link + 1].global = before.global * links[link + 1].local;
    }
}

glm::dquat IkProblem::parent_global(std::size_t link) const {
    return link == 0 ? glm::dquat(1.0, 0.0, 0.0, 0.0) : links[link - 1].global;
}

double IkProblem::distance() const {
    return glm::length(target - tip);
}

double IkProblem::rotation_error() const {
    return has_rotation ? angle_between(tip_global, target_rotation) : 0.0;
}

bool IkProblem::is_reached() const {
    return (position_weight == 0.0 || distance() <= tolerance) && (!has_rotation || rotation_error() <= tolerance);
}

bool IkProblem::is_stretched_out() const {
    if (!is_out_of_reach) return false;
    const double beyond = glm::length(target - origin) - std::max(reach, longest);
    return distance() <= beyond + tolerance;
}

double IkProblem::cost() const {
    const glm::dvec3 off = target - tip;
    const double r = rotation_error();
    return position_weight * glm::dot(off, off) + (has_rotation ? rotation_weight * r * r : 0.0);
}

void IkProblem::save() {
    for (IkLink& link : links) link.saved = link.local;
}

glm::dquat legal_local(const IkLink& link, const glm::dquat& local) {
    if (link.constraint == nullptr) return local;
    const Constraint& c = *link.constraint;
    return through_limits(link, local, [&](const glm::dquat& R) { return quick_legal_rotation(c, c.shape, R); });
}

glm::dquat middle_local(const IkLink& link) {
    if (link.constraint == nullptr) return link.rest_frame;
    const Constraint& constraint = *link.constraint;
    const auto& angles = constraint.shape.angles;
    const auto& preferred = constraint.record.preferred;
    glm::dquat R = from_vector({preferred[0], preferred[1], preferred[2]});
    if (R != glm::dquat(1.0, 0.0, 0.0, 0.0))
        return legal_local(link, glm::normalize(link.rest_frame * R * glm::conjugate(link.frame)));
    if (constraint.model() == ConstraintModel::hinge) R = about(0, angles[0].middle);
    if (constraint.model() == ConstraintModel::euler_box) {
        for (const std::size_t axis : axes_of(constraint.euler_order()))
            R = about(static_cast<int>(axis), angles.at(axis).middle) * R;
    }
    return glm::normalize(link.rest_frame * R * glm::conjugate(link.frame));
}

glm::dquat softly_legal_local(const IkLink& link, const glm::dquat& local) {
    if (link.constraint == nullptr || !link.constraint->has_soft_zone) return legal_local(link, local);
    const Constraint& c = *link.constraint;
    return through_limits(link, local, [&](const glm::dquat& R) {
        const glm::dquat before = glm::conjugate(link.rest_frame) * link.local * link.frame;
        const auto depth = [&](const glm::dquat& rotation) {
            return angle_between(quick_legal_rotation(c, c.inner, rotation), rotation);
        };
        const double in_zone = depth(R);
        constexpr double kRounding = 1e-9;
        const bool goes_deeper = in_zone > kRounding && in_zone > depth(before);
        return quick_legal_rotation(c, c.shape, goes_deeper ? between(before, R, 0.5) : R);
    });
}

glm::dvec3 preferred_side(const Constraint& constraint) {
    const auto& preferred = constraint.record.preferred;
    const glm::dvec3 said(preferred[0], preferred[1], preferred[2]);
    if (said != glm::dvec3(0.0)) return said;
    const LimitShape& shape = constraint.shape;
    const auto middle = [&](std::size_t axis) {
        return shape.angles.at(axis).half < trig::kPi ? shape.angles.at(axis).middle : 0.0;
    };
    const auto swing = [&](std::size_t side) {  // free: infinite; counts as half a turn
        return std::min(shape.swing_high.at(side), 1.0) - std::min(shape.swing_low.at(side), 1.0);
    };
    switch (constraint.model()) {
        case ConstraintModel::hinge:
            return {middle(0), 0.0, 0.0};
        case ConstraintModel::swing_twist_ellipse:
        case ConstraintModel::swing_twist_pyramid:
            return {middle(0), swing(0), swing(1)};
        case ConstraintModel::euler_box:
            return {middle(0), middle(1), middle(2)};
        default:
            return glm::dvec3(0.0);
    }
}

glm::dvec3 only_axis(const Constraint& constraint) {
    if (constraint.model() == ConstraintModel::hinge) return {1.0, 0.0, 0.0};
    const glm::dvec2 widths = swing_widths(constraint);
    constexpr double kNarrow = 1e-6;  // radians
    const bool has_y = widths.x > kNarrow, has_z = widths.y > kNarrow;
    return has_y == has_z ? glm::dvec3(0.0) : glm::dvec3(0.0, has_y ? 1.0 : 0.0, has_z ? 1.0 : 0.0);
}

glm::dvec3 bend_axis(const Constraint& constraint, const glm::dquat& rest_frame, const glm::dquat& local) {
    const glm::dvec3 only = only_axis(constraint);
    return constraint.model() == ConstraintModel::hinge ? local * (constraint.frame * only) : rest_frame * only;
}

glm::dvec3 wider_axis(const Constraint& constraint) {
    const glm::dvec2 widths = swing_widths(constraint);
    if (widths == glm::dvec2(0.0) || only_axis(constraint) != glm::dvec3(0.0)) return glm::dvec3(0.0);
    const glm::dvec3 axis = widths.x >= widths.y ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0);
    return glm::dot(axis, preferred_side(constraint)) < 0.0 ? -axis : axis;
}

glm::dvec3 freed(const IkLink& link, const glm::dvec3& vector) {
    const glm::dquat axes = link.global * link.frame;
    return axes * (link.freedom * (glm::conjugate(axes) * vector));
}

glm::dquat turn_link(IkProblem& problem, std::size_t link, const glm::dquat& rotation) {
    IkLink& l = problem.links[link];
    const bool is_whole = l.freedom == glm::dvec3(1.0);
    const glm::dquat turn = is_whole ? rotation : from_vector(freed(l, to_vector(rotation)));
    const glm::dquat parent = problem.parent_global(link);
    const glm::dquat before = l.global;
    l.local = softly_legal_local(l, glm::normalize(glm::conjugate(parent) * (turn * l.global)));
    l.global = parent * l.local;
    return l.global * glm::conjugate(before);
}

void point_at_target(IkProblem& problem) {
    for (std::size_t i = 0; i < problem.links.size(); ++i) {
        const IkLink& link = problem.links[i];
        if (link.is_fixed || link.bone_length == 0.0) continue;
        turn_link(problem, i, between(link.global * link.bone, problem.target - link.position));
        problem.place_next(i);
    }
    problem.place();
}

}  // namespace bendy
