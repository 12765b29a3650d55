#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace bendy::converter::x {

/// What an X-file is made of. Separators (`;` and `,`) and comments say nothing that the counts do not, so that readers
/// never see them: files of many exporters have one too many or too few.
struct Token {
    enum class Kind : std::uint8_t { end, word, string, number, open, close, uuid, other };
    Kind kind = Kind::end;
    std::string_view text;     ///< of a word, a string (without its quotes), a uuid; into the file
    double number = 0.0;       ///< of a number of a binary file; a text file's numbers are words
    bool is_float = false;     ///< the number came as a 32-bit float
    std::uint64_t line = 0;    ///< of a text file, from 1
    std::uint64_t column = 0;  ///< in bytes, from 1; of a binary file: the byte
};

/// Where a token stands, in words: `line 3, column 7`, or `byte 120`.
std::string place_of(const Token& token);

/// A file's tokens, one after another, in time linear in its size.
class Tokens {
public:
    Tokens() = default;
    virtual ~Tokens() = default;
    Tokens(const Tokens&) = delete;
    Tokens& operator=(const Tokens&) = delete;
    Tokens(Tokens&&) = delete;
    Tokens& operator=(Tokens&&) = delete;

    /// Fails at its place on what can be no token.
    virtual Token next() = 0;
    /// No more numbers than so can follow: counts are held against it before anything is allocated.
    [[nodiscard]] virtual std::uint64_t numbers_left() const = 0;
};

/// Checks the 16 bytes at the start (`xof 0303txt 0032`) and gives the tokens after them, of text or of binary files.
/// Fails on other files; compressed ones (`tzip`, `bzip`) are decompressed before. \param file  must outlive the tokens
std::unique_ptr<Tokens> open_tokens(std::string_view file);

}  // namespace bendy::converter::x
