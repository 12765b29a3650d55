#include "object_reader.h"

#include "scene/failure.h"

#include <bendy/format/charconv.h>

#include <cmath>
#include <limits>
#include <system_error>

namespace bendy::converter::x {
namespace {

/// Tokens of `bin` files. Lists of numbers are returned one number at a time.
class BinaryTokens : public Tokens {
public:
    /// \param at         offset of the first token
    /// \param is_double  floats take 8 bytes
    BinaryTokens(std::string_view file, std::size_t at, bool is_double)
        : file_(file), at_(at), float_size_(is_double ? 8 : 4) {}

    Token next() override;
    /// A number in a list takes four bytes.
    [[nodiscard]] std::uint64_t numbers_left() const override { return (file_.size() - at_) / 4; }

private:
    /// Reads a little-endian integer of at most 8 bytes. Fails at the end of the file.
    std::uint64_t take(std::size_t size, const Token& token);
    std::string_view take_text(const Token& token);
    Token take_number(Token token);
    void begin_list(bool are_floats, const Token& token);

    std::string_view file_;
    std::size_t at_;
    std::size_t float_size_;
    std::uint64_t listed_ = 0;  ///< remaining numbers of the current list
    bool are_floats_ = false;
};

// Token numbers of binary X-files.
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
        token.number = bit_cast<double>(take(8, token));
    } else {
        token.number = double{bit_cast<float>(static_cast<std::uint32_t>(take(4, token)))};
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
        if (!is_sign && !is_type) fail(place_of(token), "unknown token number " + std::to_string(kind));
        token.kind = Token::Kind::other;
        return token;
    }
}

/// Tokens of `txt` files. A comment runs from `//` or `#` to the end of its line.
class TextTokens : public Tokens {
public:
    /// \param at  where the first token may start
    TextTokens(std::string_view file, std::size_t at) : file_(file), at_(at) {}

    Token next() override;
    /// A number takes at least a digit and a separator.
    [[nodiscard]] std::uint64_t numbers_left() const override { return (file_.size() - at_ + 1) / 2; }

private:
    void skip_blanks();
    void skip_line();
    Token enclosed(Token token, Token::Kind kind, char end, const char* what);

    std::string_view file_;
    std::size_t at_;
    std::size_t line_start_ = 0;
    std::uint64_t line_ = 1;
};

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f' || c == ';' || c == ',';
}

bool ends_word(char c) {
    return is_blank(c) || c == '{' || c == '}' || c == '[' || c == ']' || c == '<' || c == '>' || c == '"';
}

void TextTokens::skip_line() {
    const std::size_t end = file_.find('\n', at_);
    at_ = end == std::string_view::npos ? file_.size() : end;
}

void TextTokens::skip_blanks() {
    while (at_ < file_.size()) {
        const char c = file_[at_];
        if (c == '#' || (c == '/' && at_ + 1 < file_.size() && file_[at_ + 1] == '/')) {
            skip_line();
        } else if (!is_blank(c)) {
            return;
        } else {
            ++at_;
            if (c != '\n') continue;
            ++line_;
            line_start_ = at_;
        }
    }
}

/// Reads a token up to the next `end`.
Token TextTokens::enclosed(Token token, Token::Kind kind, char end, const char* what) {
    token.kind = kind;
    const std::size_t first = ++at_;
    for (; at_ < file_.size() && file_[at_] != end; ++at_) {
        if (file_[at_] != '\n') continue;
        ++line_;
        line_start_ = at_ + 1;
    }
    if (at_ == file_.size()) fail(place_of(token), std::string(what) + " is not ended");
    token.text = file_.substr(first, at_ - first);
    ++at_;
    return token;
}

Token TextTokens::next() {
    skip_blanks();
    Token token;
    token.line = line_;
    token.column = at_ - line_start_ + 1;
    if (at_ == file_.size()) return token;
    switch (const char c = file_[at_]) {
        case '"':
            return enclosed(token, Token::Kind::string, '"', "a string");
        case '<':
            return enclosed(token, Token::Kind::uuid, '>', "a template's number");
        case '{':
        case '}':
        case '[':
        case ']':
        case '>':
            token.kind = c == '{' ? Token::Kind::open : c == '}' ? Token::Kind::close : Token::Kind::other;
            token.text = file_.substr(at_++, 1);
            return token;
        default:
            break;
    }
    const std::size_t first = at_;
    while (at_ < file_.size() && !ends_word(file_[at_])) ++at_;
    token.kind = Token::Kind::word;
    token.text = file_.substr(first, at_ - first);
    return token;
}

constexpr std::size_t kHeaderSize = 16;

/// Strips a plus sign, which from_chars does not accept.
std::string_view without_plus(std::string_view text) {
    return text.size() > 1 && text.front() == '+' && text[1] != '-' ? text.substr(1) : text;
}

enum class Parsed : bool { no, yes };

/// Parses a number; underflow gives zero. Not a number: false; overflow: infinite.
template <class Number>
Parsed parse(std::string_view text, Number& number) {
    text = without_plus(text);
    const char* const end = text.data() + text.size();
    const auto read = from_chars(text.data(), end, number);
    if (read.ptr != end || read.ec == std::errc::invalid_argument) return Parsed::no;
    if (read.ec == std::errc::result_out_of_range) {
        const bool is_small = text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos ||
                              text.starts_with("0.") || text.starts_with("-0.") || text.starts_with('.');
        number = is_small ? Number(0) : std::numeric_limits<Number>::infinity();
    }
    return Parsed::yes;
}

/// Whether the text is one of the non-numbers that Microsoft's library writes: 1.#QNAN, -1.#IND00, 1.#INF00.
bool is_no_number(std::string_view text) {
    return text.find(".#") <= 2;
}

std::string shown(const Token& token) {
    switch (token.kind) {
        case Token::Kind::end:
            return "the end of the file";
        case Token::Kind::open:
            return "'{'";
        case Token::Kind::close:
            return "'}'";
        case Token::Kind::number:
            return "a number";
        case Token::Kind::string:
            return "the string " + quote(token.text);
        case Token::Kind::uuid:
            return "a template's number";
        case Token::Kind::other:
            return token.text.empty() ? "a sign" : quote(token.text);
        default:
            return quote(token.text);
    }
}

}  // namespace

std::string place_of(const Token& token) {
    if (token.line == 0) return "byte " + std::to_string(token.column);
    return "line " + std::to_string(token.line) + ", column " + std::to_string(token.column);
}

std::unique_ptr<Tokens> open_tokens(std::string_view file) {
    if (!file.starts_with("xof "))
        fail({}, "this is not an X-file: it does not begin with 'xof ', but with " + quote(file.substr(0, 4)));
    if (file.size() < kHeaderSize)
        fail({}, "the X-file's header is truncated: expected 16 bytes, found " + std::to_string(file.size()));
    const std::string_view variant = file.substr(8, 4);
    const std::string_view float_size = file.substr(12, 4);
    if (variant != "txt " && variant != "bin ")
        fail({}, "the X-file is of an unknown variant " + quote(variant) + ": txt, bin, tzip and bzip are read");
    if (float_size != "0032" && float_size != "0064")
        fail({}, "the X-file's floats have an unknown size " + quote(float_size) + ": 0032 and 0064 are read");
    if (variant == "txt ") return std::make_unique<TextTokens>(file, kHeaderSize);
    return std::make_unique<BinaryTokens>(file, kHeaderSize, float_size == "0064");
}

const Token& ObjectReader::next() {
    token_ = tokens_->next();
    return token_;
}

void ObjectReader::refuse(const std::string& message) const {
    fail(place(), message);
}

void ObjectReader::refuse_unexpected(const char* what) const {
    refuse("expected " + std::string(what) + ", found " + shown(token_));
}

std::string ObjectReader::head() {
    std::string name;
    next();
    if (token_.kind == Token::Kind::word) {
        name = token_.text;
        next();
    }
    if (token_.kind != Token::Kind::open) refuse_unexpected("'{'");
    return name;
}

void ObjectReader::end_of(const char* object) {
    std::string_view type;
    while (inner(type, object)) skip_unknown(type);
}

bool ObjectReader::inner(std::string_view& type, const char* of) {
    for (;;) {
        next();
        if (token_.kind == Token::Kind::close) return false;
        if (token_.kind == Token::Kind::end) refuse(std::string("the file ends inside a ") + of);
        if (token_.kind == Token::Kind::uuid) continue;
        if (token_.kind == Token::Kind::open) {
            type = "{";
            return true;
        }
        if (token_.kind != Token::Kind::word) refuse_unexpected("a data object or '}'");
        type = token_.text;
        return true;
    }
}

void ObjectReader::skip(std::string_view type) {
    const std::string begin = place();
    std::uint64_t depth = type == "{" ? 1 : 0;  // a reference has already begun
    do {
        next();
        if (token_.kind == Token::Kind::end) fail(begin, "the file ends inside this data object");
        if (token_.kind == Token::Kind::open) ++depth;
        if (token_.kind == Token::Kind::close && depth == 0) refuse("there is a '}' without a '{'");
        if (token_.kind == Token::Kind::close) --depth;
    } while (depth != 0 || token_.kind != Token::Kind::close);
}

void ObjectReader::skip_unknown(std::string_view type) {
    report_.warn(type == "{" ? std::string("reference left out") : "data object of type " + quote(type) + " left out",
                 place());
    skip(type);
}

std::string ObjectReader::reference() {
    std::string name;
    next();
    for (; token_.kind == Token::Kind::word || token_.kind == Token::Kind::uuid; next()) {
        if (token_.kind == Token::Kind::word && name.empty()) name = token_.text;
    }
    if (token_.kind != Token::Kind::close) refuse_unexpected("'}'");
    return name;
}

float ObjectReader::number() {
    next();
    float value = 0.0f;
    if (token_.kind == Token::Kind::number) {
        value = static_cast<float>(token_.number);
    } else if (token_.kind != Token::Kind::word) {
        refuse_unexpected("a number");
    } else if (parse(token_.text, value) == Parsed::no) {
        if (!is_no_number(token_.text)) refuse_unexpected("a number");
        report_.warn("a value that is not a number is taken as 0", place());
        return 0.0f;
    }
    if (!std::isfinite(value)) refuse("the number is not finite");
    return value;
}

double ObjectReader::exact_number() {
    next();
    double value = 0.0;
    if (token_.kind == Token::Kind::number) {
        value = token_.number;
    } else if (token_.kind != Token::Kind::word || parse(token_.text, value) == Parsed::no) {
        refuse_unexpected("a number");
    }
    if (!std::isfinite(value)) refuse("the number is not finite");
    return value;
}

std::uint32_t ObjectReader::integer() {
    next();
    std::uint32_t value = 0;
    if (token_.kind == Token::Kind::number) {
        if (token_.is_float) refuse("expected a whole number");
        return static_cast<std::uint32_t>(token_.number);
    }
    const std::string_view text = without_plus(token_.text);
    const char* const end = text.data() + text.size();
    if (token_.kind != Token::Kind::word) refuse_unexpected("a whole number");
    const auto read = from_chars(text.data(), end, value);
    if (read.ptr != end || read.ec != std::errc()) refuse_unexpected("a whole number of 32 bits");
    return value;
}

std::uint32_t ObjectReader::count(std::uint32_t numbers_each, const char* what) {
    const std::uint32_t count = integer();
    if (count > tokens_->numbers_left() / numbers_each)
        refuse(std::to_string(count) + ' ' + what + " do not fit into what remains of the file");
    return count;
}

std::uint32_t ObjectReader::index(std::uint64_t end, const char* of) {
    const std::uint32_t index = integer();
    if (index >= end)
        refuse("index " + std::to_string(index) + " is out of range: there are " + std::to_string(end) + ' ' + of);
    return index;
}

std::string_view ObjectReader::string() {
    next();
    // Some writers omit the quotation marks.
    if (token_.kind != Token::Kind::string && token_.kind != Token::Kind::word) refuse_unexpected("a string");
    return token_.text;
}

}  // namespace bendy::converter::x
