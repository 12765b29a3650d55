#pragma once

#include "names.h"

namespace bendy::converter::x_out {

/// BendyConstraint of a joint, once for each scope.
void write_constraints(const Joint& joint, Text& text);

/// BendyIkChain of every chain.
void write_chains(const Scene& scene, const Names& names, Text& text);

}  // namespace bendy::converter::x_out
