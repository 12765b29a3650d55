#pragma once

#include <cstdint>
#include <functional>

namespace bendy::text_form {

/// Called now and then during long operations: bytes of the input processed so far, and in total.
using Progress = std::function<void(std::uint64_t done, std::uint64_t all)>;

}  // namespace bendy::text_form
