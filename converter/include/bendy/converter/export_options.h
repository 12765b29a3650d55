#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace bendy::converter {

struct ExportOptions {
    /// One level of detail of a file that has a collapse sequence: how many vertices of each pool are left, as
    /// Lod::vertices says. Empty: all there are.
    std::vector<std::uint32_t> vertices;
    /// Where the result will be written: links to images are relative to its folder. Empty: beside the bendy file.
    std::filesystem::path output = {};
};

}  // namespace bendy::converter
