#pragma once

#include <bendy/format/joint.h>
#include <bendy/format/public.h>

#include <cstdint>
#include <string_view>
#include <vector>

// IKCH: an IK chain of an object; PULL: the weight of a joint in one.
namespace BENDY_PUBLIC bendy {

/// A chain. Its links are the joints on the path from the effector up to the start: no list is stored.
struct ChainView {
    std::uint32_t chunk = 0;
    std::string_view name;
    ChainRecord record;
    std::string_view extras;
};

/// Reads the IKCH chunks of an OBJE and checks all that memory safety hangs on: joints in range, start the effector or
/// above it, every weight's chain there and its joint in that chain, once.
std::vector<ChainView> read_chains(const ChunkTree& tree, std::uint32_t object, const SkeletonView& skeleton,
                                   Faults& faults);

/// Faults of meaning: numbers that are not finite, rotations that are not unit, weights outside 0 to 1.
void check_chain_values(const ChunkTree& tree, const ChainView& chain, Faults& faults);

}  // namespace bendy
