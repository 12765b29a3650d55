#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/faults.h>

#include <filesystem>
#include <iosfwd>

namespace bendy::cli {

/// A line for each fault: the file, the code, what is wrong and where.
void print_fault_lines(std::ostream& out, const std::filesystem::path& file, const Faults& faults, Bytes bytes);

}  // namespace bendy::cli
