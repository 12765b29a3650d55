#pragma once

#include "tokens.h"

namespace bendy::converter::x {

/// Tokens of `txt` files. A comment goes from `//` or `#` to the end of its line.
class TextTokens : public Tokens {
public:
    /// \param at  where the first may stand
    TextTokens(std::string_view file, std::size_t at) : file_(file), at_(at) {}

    Token next() override;
    /// A digit and what ends it.
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

}  // namespace bendy::converter::x
