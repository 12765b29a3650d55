// The types of lanes.h, for what an instruction set defines before it. Included after BENDY_LANES is defined.

// NOLINTBEGIN(misc-definitions-in-headers): this is a body; it stands in a nameless namespace

constexpr std::size_t kLanes = BENDY_LANES;
using Lanes = float __attribute__((vector_size(4 * BENDY_LANES)));
using Eight = float __attribute__((vector_size(32)));
using Quad = float __attribute__((vector_size(16)));

// NOLINTEND(misc-definitions-in-headers)
