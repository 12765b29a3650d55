#include "text_tokens.h"

#include "failure.h"

namespace bendy::converter::x {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f' || c == ';' || c == ',';
}

bool ends_word(char c) {
    return is_blank(c) || c == '{' || c == '}' || c == '[' || c == ']' || c == '<' || c == '>' || c == '"';
}

}  // namespace

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

/// What stands up to the next `end`.
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

}  // namespace bendy::converter::x
