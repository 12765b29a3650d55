#pragma once

#include <bendy/format/result.h>

#include <string>
#include <string_view>

namespace bendy::converter {

/// How far compact encodings may move a point of the skin: a length, or a share of the character's height.
struct ErrorBound {
    double value = 5e-5;  ///< metres, or a share (1 is the whole height); above 0, finite
    bool is_share = true;
};

/// Parses `0.1mm`, `1 cm`, `0.0005m`, `50um` or `0.005%`. The error is a one-line message.
Result<ErrorBound, std::string> parse_error_bound(std::string_view text);

}  // namespace bendy::converter
