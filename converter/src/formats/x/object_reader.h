#pragma once

#include "parts.h"

#include <bendy/converter/report.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter::x {

/// A token of an X-file. Separators (`;` and `,`) and comments are redundant given the counts, so readers never see
/// them: many exporters write one too many or too few.
struct Token {
    enum class Kind : std::uint8_t { end, word, string, number, open, close, uuid, other };
    Kind kind = Kind::end;
    std::string_view text;     ///< of a word, a string (without its quotes), a uuid; refers to the file
    double number = 0.0;       ///< for a number in a binary file; numbers in text files are words
    bool is_float = false;     ///< the number was stored as a 32-bit float
    std::uint64_t line = 0;    ///< in a text file, from 1
    std::uint64_t column = 0;  ///< in bytes, from 1; in a binary file: the offset
};

/// A token's place in words: `line 3, column 7`, or `byte 120`.
std::string place_of(const Token& token);

/// Reads a file's tokens in sequence, in time linear in its size.
class Tokens {
public:
    Tokens() = default;
    virtual ~Tokens() = default;
    Tokens(const Tokens&) = delete;
    Tokens& operator=(const Tokens&) = delete;
    Tokens(Tokens&&) = delete;
    Tokens& operator=(Tokens&&) = delete;

    /// Fails at the place of an invalid token.
    virtual Token next() = 0;
    /// The most numbers that the remaining bytes can hold: check counts against it before allocating.
    [[nodiscard]] virtual std::uint64_t numbers_left() const = 0;
};

/// Checks the 16 bytes at the start (`xof 0303txt 0032`) and returns the tokens after them, of text or of binary files.
/// Fails on other files; compressed ones (`tzip`, `bzip`) must be decompressed first.
/// \param file  must outlive the tokens
std::unique_ptr<Tokens> open_tokens(std::string_view file);

/// Reads the elements of data objects: heads, numbers, strings. Every function fails at the place of an unexpected
/// token.
class ObjectReader {
public:
    ObjectReader(std::string_view file, Report& report) : tokens_(open_tokens(file)), report_(report) {}

    [[nodiscard]] Report& report() const { return report_; }
    /// The next token; `place` gives its place.
    const Token& next();
    [[nodiscard]] std::string place() const { return place_of(token_); }
    [[noreturn]] void refuse(const std::string& message) const;

    /// Reads the text between a template's name and its members: `NAME {`, with an optional uuid.
    /// \return NAME or empty
    std::string head();
    /// Reads the `}` of an object after its known members; further nested objects are skipped and reported.
    void end_of(const char* object);
    /// Reads the start of the next nested object, or the end of the outer one.
    /// \return false at its end
    bool inner(std::string_view& type, const char* of);
    /// Skips an object whose template name has been read, with all contents.
    void skip(std::string_view type);
    void skip_unknown(std::string_view type);
    /// Reads the rest of a reference: `{` NAME `}`.
    std::string reference();

    float number();
    double exact_number();
    std::uint32_t integer();
    /// Reads a count of things to come, each of at least `numbers_each` numbers. Fails if the file is too short for
    /// them.
    std::uint32_t count(std::uint32_t numbers_each, const char* what);
    /// Reads an index below `end`.
    std::uint32_t index(std::uint64_t end, const char* of);
    std::string_view string();

    /// Reads `N` floats for each of `count` things.
    template <class Vector>
    std::vector<Vector> vectors(std::uint32_t count) {
        std::vector<Vector> list(count);
        for (Vector& vector : list) {
            for (int i = 0; i < Vector::length(); ++i) vector[i] = number();
        }
        return list;
    }

private:
    [[noreturn]] void refuse_unexpected(const char* what) const;

    std::unique_ptr<Tokens> tokens_;
    Report& report_;
    Token token_;
};

/// Reads a Mesh after its type, with all nested objects. Its own materials are appended to `materials`.
Mesh read_mesh(ObjectReader& in, std::vector<Material>& materials);

/// Reads a Material after its type.
Material read_material(ObjectReader& in);

/// Reads a BendyName after its type.
std::string read_name(ObjectReader& in);

/// Reads a BendyConstraint after its type; the record passes check_constraint except for the rest pose.
Constraint read_constraint(ObjectReader& in);

/// Reads a BendyIkChain after its type; every number is in its range.
IkChain read_chain(ObjectReader& in);

/// Reads an AnimationSet after its type.
AnimationSet read_animation_set(ObjectReader& in);

/// Reads an X-file, text or binary. Indices inside a mesh are in range, counts agree; references to frames and
/// materials by name are not resolved yet. Fails at `line 3, column 7`; unknown objects are named in `report`.
XFile read_x_file(std::string_view file, Report& report);

}  // namespace bendy::converter::x
