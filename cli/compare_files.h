#pragma once

#include "compare_leaves.h"
#include "difference.h"

#include <memory>
#include <optional>

namespace bendy::cli {

/// Reads a file that passes bendy::validate. The views refer to `bytes` and to the result itself.
std::unique_ptr<ReadFile> read_file(Bytes bytes);

/// Everything in which two files differ, in A's order. Where sums are equal it does not look further.
/// \param tolerance  as ContentComparer has it
Differences compare_files(const ReadFile& a, const ReadFile& b, std::optional<double> tolerance);

}  // namespace bendy::cli
