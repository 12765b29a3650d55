#pragma once

#include <bendy/converter/source_format.h>

#include <array>
#include <span>
#include <string_view>

namespace bendy::converter {

/// How files of a format that `convert` reads are recognised.
struct ReadableFormat {
    SourceFormat format;
    std::string_view name;                          ///< with its article
    std::string_view signature;                     ///< the first bytes of such a file; empty: text without a signature
    std::array<std::string_view, 3> suffixes = {};  ///< of file names, lower case; unused entries are empty
};

/// All formats that this build reads.
std::span<const ReadableFormat> readable_formats();

}  // namespace bendy::converter
