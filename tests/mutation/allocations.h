#pragma once

#include <cstddef>
#include <cstdint>

// What this program takes from operator new, which allocations.cpp replaces; and a way to let one of them fail.
namespace bendy::test {

struct Allocations {
    std::uint64_t count = 0;
    std::uint64_t bytes = 0;    ///< all together, freed ones too
    std::uint64_t largest = 0;  ///< bytes
    std::int64_t live = 0;      ///< not freed yet
};

/// Counts from zero from here on, but for `live`.
void restart_count();
Allocations allocations();

/// The `number`-th allocation from here on fails, 1 the next; 0: none does. Once it has failed, all go well again.
void fail_allocation(std::uint64_t number);
/// Whether one that was to fail has not been reached.
bool is_failure_pending();

}  // namespace bendy::test
