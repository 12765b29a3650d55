#pragma once

#include <bendy/format/joint.h>
#include <bendy/format/public.h>

#include <cstdint>
#include <string_view>
#include <vector>

// IKCH: an IK chain of an object; PULL: the weight of a joint in a chain.
namespace BENDY_PUBLIC bendy {

/// An IK chain. Its links are the joints on the path from the effector up to the start; the list is not stored.
struct ChainView {
    std::uint32_t chunk = 0;
    std::string_view name;
    ChainRecord record;
    std::uint32_t links = 0;  ///< number of joints from start to effector, both included
    std::string_view extras;

    [[nodiscard]] Solver solver() const { return static_cast<Solver>(record.solver); }
};

/// Reads the IKCH chunks of an OBJE and makes all checks that memory safety depends on: joints in range, the start
/// equal to the effector or one of its ancestors; for every weight, that its chain exists and that its joint is in that
/// chain, once.
std::vector<ChainView> read_chains(const ChunkTree& tree, std::uint32_t object, const SkeletonView& skeleton,
                                   Faults& faults);

/// Adds faults of content: numbers that are not finite, rotations that are not unit quaternions, weights outside 0 to
/// 1.
void check_chain_values(const ChunkTree& tree, const ChainView& chain, Faults& faults);

}  // namespace bendy
