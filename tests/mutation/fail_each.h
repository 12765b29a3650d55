#pragma once

#include "mutation/allocations.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <new>

namespace bendy::test {

/// Does `work` again and again, its first allocation failing, then its second (the `step`-th after that, ...), until
/// there is none left. Each time work() must come to its end or let std::bad_alloc pass, and leave nothing behind; it
/// says by itself whether its result is good. Gives how many have failed.
template <class Work>
std::uint64_t fail_each_allocation(const Work& work, std::uint64_t step = 1) {
    work();  // what a thread or the program keeps is there before it is counted
    for (std::uint64_t number = 1, failures = 0;; number += step, ++failures) {
        const std::int64_t before = allocations().live;
        bool has_passed = false;
        fail_allocation(number);
        try {
            work();
        } catch (const std::bad_alloc&) {
            has_passed = true;
        }
        const bool is_over = is_failure_pending();
        fail_allocation(0);
        EXPECT_EQ(allocations().live, before) << "allocation " << number << " fails, and something is left behind";
        EXPECT_FALSE(is_over && has_passed);
        if (is_over || testing::Test::HasFailure()) return failures;
    }
}

}  // namespace bendy::test
