#include "binary_tokens.h"

#include "failure.h"

#include <bit>

namespace bendy::converter::x {
namespace {

// The numbers of tokens in binary X-files.
constexpr std::uint64_t kName = 1;
constexpr std::uint64_t kString = 2;
constexpr std::uint64_t kInteger = 3;
constexpr std::uint64_t kUuid = 5;
constexpr std::uint64_t kIntegers = 6;
constexpr std::uint64_t kFloats = 7;
constexpr std::uint64_t kOpen = 10;
constexpr std::uint64_t kClose = 11;
constexpr std::uint64_t kFirstSign = 12;  // ( ) [ ] < > .
constexpr std::uint64_t kComma = 19;
constexpr std::uint64_t kSemicolon = 20;
constexpr std::uint64_t kTemplate = 31;
constexpr std::uint64_t kFirstType = 40;  // WORD, DWORD, FLOAT, ...: in templates
constexpr std::uint64_t kLastType = 52;
constexpr std::size_t kUuidSize = 16;

}  // namespace

std::uint64_t BinaryTokens::take(std::size_t size, const Token& token) {
    if (size > file_.size() - at_) fail(place_of(token), "the file ends inside of this");
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
        value |= std::uint64_t{static_cast<unsigned char>(file_[at_ + i])} << (8 * i);
    at_ += size;
    return value;
}

std::string_view BinaryTokens::take_text(const Token& token) {
    const std::uint64_t size = take(4, token);
    if (size > file_.size() - at_)
        fail(place_of(token), "a text of " + std::to_string(size) + " bytes does not fit into the file");
    const std::string_view text = file_.substr(at_, static_cast<std::size_t>(size));
    at_ += text.size();
    return text;
}

void BinaryTokens::begin_list(bool are_floats, const Token& token) {
    are_floats_ = are_floats;
    listed_ = take(4, token);
    if (listed_ > (file_.size() - at_) / (are_floats ? float_size_ : 4))
        fail(place_of(token), "a list of " + std::to_string(listed_) + " numbers does not fit into the file");
}

Token BinaryTokens::take_number(Token token) {
    token.kind = Token::Kind::number;
    token.is_float = are_floats_;
    if (!are_floats_) {
        token.number = static_cast<double>(take(4, token));
    } else if (float_size_ == 8) {
        token.number = std::bit_cast<double>(take(8, token));
    } else {
        token.number = double{std::bit_cast<float>(static_cast<std::uint32_t>(take(4, token)))};
    }
    return token;
}

Token BinaryTokens::next() {
    for (;;) {
        Token token;
        token.column = at_;
        if (listed_ > 0) {
            --listed_;
            return take_number(token);
        }
        if (at_ == file_.size()) return token;
        const std::uint64_t kind = take(2, token);
        switch (kind) {
            case kComma:
            case kSemicolon:
                continue;
            case kIntegers:
            case kFloats:
                begin_list(kind == kFloats, token);
                continue;
            case kInteger:
                are_floats_ = false;
                return take_number(token);
            case kName:
            case kString:
                token.kind = kind == kName ? Token::Kind::word : Token::Kind::string;
                token.text = take_text(token);
                return token;
            case kUuid:
                if (kUuidSize > file_.size() - at_) fail(place_of(token), "the file ends inside of this");
                token.kind = Token::Kind::uuid;
                token.text = file_.substr(at_, kUuidSize);
                at_ += kUuidSize;
                return token;
            case kOpen:
            case kClose:
                token.kind = kind == kOpen ? Token::Kind::open : Token::Kind::close;
                return token;
            case kTemplate:
                token.kind = Token::Kind::word;
                token.text = "template";
                return token;
            default:
                break;
        }
        const bool is_sign = kind >= kFirstSign && kind < kComma;
        const bool is_type = kind >= kFirstType && kind <= kLastType;
        if (!is_sign && !is_type) fail(place_of(token), "there is no token of number " + std::to_string(kind));
        token.kind = Token::Kind::other;
        return token;
    }
}

}  // namespace bendy::converter::x
