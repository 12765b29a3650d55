#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/faults.h>
#include <bendy/format/public.h>

namespace BENDY_PUBLIC bendy {

/// Everything that is wrong with a file: its structure (the first fault ends it there, since what follows cannot be
/// told), its sums, its records and its values. `bytes` must start on a 16-byte boundary.
Faults validate(Bytes bytes);

}  // namespace bendy
