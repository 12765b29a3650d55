#pragma once

#include "object_reader.h"
#include "x_file.h"

#include <string>
#include <vector>

namespace bendy::converter::x {

/// A Mesh whose type has been read, with all below it. Its own materials are appended to `materials`.
Mesh read_mesh(ObjectReader& in, std::vector<Material>& materials);

/// A Material whose type has been read.
Material read_material(ObjectReader& in);

/// A BendyName whose type has been read.
std::string read_name(ObjectReader& in);

}  // namespace bendy::converter::x
