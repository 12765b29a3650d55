// The types of lanes.h, which the code for each instruction set needs before it. Included after BENDY_LANES is defined.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

constexpr std::size_t kLanes = BENDY_LANES;
using Lanes = float __attribute__((vector_size(4 * BENDY_LANES)));
using Integers = std::int32_t __attribute__((vector_size(4 * BENDY_LANES)));
using Eight = float __attribute__((vector_size(32)));
using Quad = float __attribute__((vector_size(16)));

// NOLINTEND(misc-definitions-in-headers)
