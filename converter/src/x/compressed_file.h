#pragma once

#include "source/source_file.h"

#include <string>
#include <string_view>

namespace bendy::converter::x {

/// True of `xof 0303tzip0032` and `xof 0303bzip0032`: text or binary files that are compressed after their header.
bool is_compressed(std::string_view file);

/// The plain file, its header included. The data is MSZIP: blocks of at most 32,768 bytes, each deflated with the block
/// before it as its dictionary (MS-MCI, section 2). Fails at the byte of the block that is damaged. What the blocks
/// become is charged to the budget as it grows.
std::string decompress(std::string_view file, Budget& budget);

}  // namespace bendy::converter::x
