#pragma once

#include "rig/fields.h"
#include "x_file.h"

#include <limits>

// What stands in the templates BendyConstraint and BendyIkChain, in its order: the writer, the reader and the
// templates' own text all walk it. Numbers are the records' own (spec/chunks/LIMT.md, IKCH.md): right-handed, radians,
// metres.
namespace bendy::converter::x {

inline constexpr float kMost = std::numeric_limits<float>::max();  ///< in ranges: free, as X-files know no infinity

template <class Walk>
void walk_constraint(Walk& walk, LimitRecord& record) {
    walk.word("model", kModelNames, record.model);
    walk.word("order", kOrderNames, record.euler_order);
    walk.word("scope", kScopeNames, record.scope);
    walk.integer("flags", record.flags, kLimitFlags - 1);
    walk.number("softZone", record.soft_zone, 0.0f, kMost);
    walk.numbers("frame", record.frame, -kMost, kMost);
    walk.ranges("rotationMin", record.rotation_min);
    walk.ranges("rotationMax", record.rotation_max);
    walk.ranges("translationMin", record.translation_min);
    walk.ranges("translationMax", record.translation_max);
    walk.numbers("stiffness", record.stiffness, 0.0f, 1.0f);
    walk.numbers("preferred", record.preferred, -kMost, kMost);
}

template <class Walk>
void walk_chain(Walk& walk, IkChain& chain) {
    ChainRecord& record = chain.record;
    walk.text("name", chain.name);
    walk.frame("start", chain.start);
    walk.frame("effector", chain.effector);
    walk.frame("target", chain.target);
    walk.frame("pole", chain.pole);
    walk.word("solver", kSolverNames, record.solver);
    walk.integer("flags", record.flags, kChainFlags - 1);
    walk.integer("iterations", record.iterations, std::numeric_limits<std::uint16_t>::max());
    walk.integer("priority", record.priority, std::numeric_limits<std::uint8_t>::max());
    walk.number("tolerance", record.tolerance, 0.0f, kMost);
    walk.numbers("poleVector", record.pole_vector, -kMost, kMost);
    walk.number("poleAngle", record.pole_angle, -kMost, kMost);
    walk.numbers("tipOffset", record.tip_offset, -kMost, kMost);
    walk.numbers("tipRotation", record.tip_rotation, -kMost, kMost);
    walk.number("positionWeight", record.position_weight, 0.0f, 1.0f);
    walk.number("rotationWeight", record.rotation_weight, 0.0f, 1.0f);
    walk.number("influence", record.influence, 0.0f, 1.0f);
    walk.number("stretch", record.stretch, 0.0f, kMost);
    walk.number("compress", record.compress, 0.0f, 1.0f);
    walk.text("extras", chain.extras);
    walk.weights("weights", chain.weights);
}

}  // namespace bendy::converter::x
