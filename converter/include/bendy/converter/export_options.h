#pragma once

#include <cstdint>
#include <vector>

namespace bendy::converter {

struct ExportOptions {
    /// One level of detail of a file that has a collapse sequence: how many vertices of each pool are left, as
    /// Lod::vertices says. Empty: all there are.
    std::vector<std::uint32_t> vertices;
};

}  // namespace bendy::converter
