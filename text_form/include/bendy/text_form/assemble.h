#pragma once

#include <bendy/format/result.h>
#include <bendy/text_form/progress.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::text_form {

/// What is wrong with a text, and where.
struct TextFault {
    std::uint64_t line = 1;    ///< counted from 1
    std::uint64_t column = 1;  ///< characters (code points), counted from 1
    std::string what;
};

/// The file whose text form the text is, with its sums; or the text's first fault. The file is well formed, but nobody
/// has asked whether its content makes sense: `validate` does. Does not recurse; takes memory in proportion to the
/// text. \param text  UTF-8, with or without a byte-order mark
Result<std::vector<std::byte>, TextFault> assemble(std::string_view text, const Progress& progress = {});

}  // namespace bendy::text_form
