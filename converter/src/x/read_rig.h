#pragma once

#include "object_reader.h"
#include "x_file.h"

namespace bendy::converter::x {

/// A BendyConstraint whose type has been read; the record passes check_limit but for the rest pose.
Constraint read_constraint(ObjectReader& in);

/// A BendyIkChain whose type has been read; every number in its range.
IkChain read_chain(ObjectReader& in);

}  // namespace bendy::converter::x
