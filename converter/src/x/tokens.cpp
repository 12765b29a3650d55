#include "tokens.h"

#include "binary_tokens.h"
#include "failure.h"
#include "text_tokens.h"

namespace bendy::converter::x {
namespace {

constexpr std::size_t kHeaderSize = 16;

}  // namespace

std::string place_of(const Token& token) {
    if (token.line == 0) return "byte " + std::to_string(token.column);
    return "line " + std::to_string(token.line) + ", column " + std::to_string(token.column);
}

std::unique_ptr<Tokens> open_tokens(std::string_view file) {
    if (!file.starts_with("xof "))
        fail({}, "this is no X-file: it does not begin with 'xof ', but with " + quote(file.substr(0, 4)));
    if (file.size() < kHeaderSize) fail({}, "the X-file's header is truncated: 16 bytes are due");
    const std::string_view variant = file.substr(8, 4);
    const std::string_view float_size = file.substr(12, 4);
    if (variant != "txt " && variant != "bin ")
        fail({}, "the X-file is of an unknown variant " + quote(variant) + ": txt, bin, tzip and bzip are read");
    if (float_size != "0032" && float_size != "0064")
        fail({}, "the X-file's floats have an unknown size " + quote(float_size) + ": 0032 and 0064 are read");
    if (variant == "txt ") return std::make_unique<TextTokens>(file, kHeaderSize);
    return std::make_unique<BinaryTokens>(file, kHeaderSize, float_size == "0064");
}

}  // namespace bendy::converter::x
