#pragma once

#include <bendy/format/result.h>
#include <bendy/text_form/progress.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::text_form {

/// An error in a text, and its position.
struct TextFault {
    std::uint64_t line = 1;    ///< counted from 1
    std::uint64_t column = 1;  ///< characters (code points), counted from 1
    std::string what;
};

/// Builds the file that a text form describes, including its sums, or returns the text's first fault. The file is well
/// formed, but its content is not checked: use `validate`. Does not recurse; takes memory in proportion to the text.
/// \param text  UTF-8, with or without a byte-order mark
Result<std::vector<std::byte>, TextFault> assemble(std::string_view text, const Progress& progress = {});

}  // namespace bendy::text_form
