#include "object_reader.h"

#include "failure.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace bendy::converter::x {
namespace {

/// from_chars knows no plus sign.
std::string_view without_plus(std::string_view text) {
    return text.size() > 1 && text.front() == '+' && text[1] != '-' ? text.substr(1) : text;
}

enum class Parsed : bool { no, yes };

/// A number of a text; what is too small is zero. Not a number: false; past the type's range: infinite.
template <class Number>
Parsed parse(std::string_view text, Number& number) {
    text = without_plus(text);
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, number);
    if (read.ptr != end || read.ec == std::errc::invalid_argument) return Parsed::no;
    if (read.ec == std::errc::result_out_of_range) {
        const bool is_small = text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos ||
                              text.starts_with("0.") || text.starts_with("-0.") || text.starts_with('.');
        number = is_small ? Number(0) : std::numeric_limits<Number>::infinity();
    }
    return Parsed::yes;
}

/// What Microsoft's library writes for numbers that are none: 1.#QNAN, -1.#IND00, 1.#INF00.
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
    std::uint64_t depth = type == "{" ? 1 : 0;  // a reference has begun already
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
        report_.warn("what is no number is taken as 0", place());
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
    const auto read = std::from_chars(text.data(), end, value);
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
    // Some writers forget the quotation marks.
    if (token_.kind != Token::Kind::string && token_.kind != Token::Kind::word) refuse_unexpected("a string");
    return token_.text;
}

}  // namespace bendy::converter::x
