#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/faults.h>
#include <bendy/format/public.h>

namespace BENDY_PUBLIC bendy {

/// Returns all errors of a file: in its structure (only the first, since the rest cannot be interpreted), its sums, its
/// records and its values. `bytes` must start on a 16-byte boundary.
Faults validate(Bytes bytes);

}  // namespace bendy
