#pragma once

#include "parts.h"
#include "rigging/rig/fields.h"

#include <limits>

// The fields of the templates BendyConstraint and BendyIkChain, in order; the writer, the reader and the templates' own
// text all visit them. Numbers are those of the records (spec/chunks/LIMT.md, IKCH.md): right-handed, radians, metres.
namespace bendy::converter::x {

inline constexpr float kMost = std::numeric_limits<float>::max();  ///< in ranges: free, as X-files have no infinity

template <class Visitor>
void visit_constraint(Visitor& visitor, ConstraintRecord& record) {
    visitor.word("model", kValueNames<ConstraintModel>, record.model);
    visitor.word("order", kOrderNames, record.euler_order);
    visitor.word("scope", kValueNames<ConstraintScope>, record.scope);
    visitor.integer("flags", record.flags, kConstraintFlags - 1);
    visitor.number("softZone", record.soft_zone, 0.0f, kMost);
    visitor.numbers("frame", record.frame, -kMost, kMost);
    visitor.ranges("rotationMin", record.rotation_min);
    visitor.ranges("rotationMax", record.rotation_max);
    visitor.ranges("translationMin", record.translation_min);
    visitor.ranges("translationMax", record.translation_max);
    visitor.numbers("stiffness", record.stiffness, 0.0f, 1.0f);
    visitor.numbers("preferred", record.preferred, -kMost, kMost);
}

template <class Visitor>
void visit_chain(Visitor& visitor, IkChain& chain) {
    ChainRecord& record = chain.record;
    visitor.text("name", chain.name);
    visitor.frame("start", chain.start);
    visitor.frame("effector", chain.effector);
    visitor.frame("target", chain.target);
    visitor.frame("pole", chain.pole);
    visitor.word("solver", kValueNames<Solver>, record.solver);
    visitor.integer("flags", record.flags, kChainFlags - 1);
    visitor.integer("iterations", record.iterations, std::numeric_limits<std::uint16_t>::max());
    visitor.integer("priority", record.priority, std::numeric_limits<std::uint8_t>::max());
    visitor.number("tolerance", record.tolerance, 0.0f, kMost);
    visitor.numbers("poleVector", record.pole_vector, -kMost, kMost);
    visitor.number("poleAngle", record.pole_angle, -kMost, kMost);
    visitor.numbers("tipOffset", record.tip_offset, -kMost, kMost);
    visitor.numbers("tipRotation", record.tip_rotation, -kMost, kMost);
    visitor.number("positionWeight", record.position_weight, 0.0f, 1.0f);
    visitor.number("rotationWeight", record.rotation_weight, 0.0f, 1.0f);
    visitor.number("influence", record.influence, 0.0f, 1.0f);
    visitor.number("stretch", record.stretch, 0.0f, kMost);
    visitor.number("compress", record.compress, 0.0f, 1.0f);
    visitor.text("extras", chain.extras);
    visitor.weights("weights", chain.weights);
}

}  // namespace bendy::converter::x
