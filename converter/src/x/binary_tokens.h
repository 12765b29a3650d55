#pragma once

#include "tokens.h"

namespace bendy::converter::x {

/// Tokens of `bin` files. Lists of numbers come number by number.
class BinaryTokens : public Tokens {
public:
    /// \param at         where the first stands
    /// \param is_double  floats take 8 bytes
    BinaryTokens(std::string_view file, std::size_t at, bool is_double)
        : file_(file), at_(at), float_size_(is_double ? 8 : 4) {}

    Token next() override;
    /// Four bytes in a list.
    [[nodiscard]] std::uint64_t numbers_left() const override { return (file_.size() - at_) / 4; }

private:
    /// Little-endian, of at most 8 bytes. Fails where the file ends before.
    std::uint64_t take(std::size_t size, const Token& token);
    std::string_view take_text(const Token& token);
    Token take_number(Token token);
    void begin_list(bool are_floats, const Token& token);

    std::string_view file_;
    std::size_t at_;
    std::size_t float_size_;
    std::uint64_t listed_ = 0;  ///< numbers of the list that are still to come
    bool are_floats_ = false;
};

}  // namespace bendy::converter::x
