#pragma once

#include <cstdint>
#include <functional>

namespace bendy::text_form {

/// Called now and then during long work: bytes of the input that are done, and all of them.
using Progress = std::function<void(std::uint64_t done, std::uint64_t all)>;

}  // namespace bendy::text_form
