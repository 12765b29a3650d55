#pragma once

#include "parts.h"

#include <bendy/converter/report.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

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
    /// The largest count of numbers that the remaining bytes can hold: check counts against it before allocating.
    [[nodiscard]] virtual std::uint64_t numbers_left() const = 0;
};

/// Checks the 16 bytes at the start (`xof 0303txt 0032`) and gives the tokens after them, of text or of binary files.
/// Fails on other files; compressed ones (`tzip`, `bzip`) are decompressed before. \param file  must outlive the tokens
std::unique_ptr<Tokens> open_tokens(std::string_view file);

/// Reads the pieces of data objects: heads, numbers, strings. Every function fails at the place of what it did not
/// expect.
class ObjectReader {
public:
    ObjectReader(std::string_view file, Report& report) : tokens_(open_tokens(file)), report_(report) {}

    [[nodiscard]] Report& report() const { return report_; }
    /// The next token; its place is `place`.
    const Token& next();
    [[nodiscard]] std::string place() const { return place_of(token_); }
    [[noreturn]] void refuse(const std::string& message) const;

    /// What stands between a template's name and its members: `NAME {`, with an optional uuid. \return NAME or empty
    std::string head();
    /// The `}` of an object that has nothing more to say; objects in it are skipped, and named.
    void end_of(const char* object);
    /// The next object inside of another, or the other's end. \return false at its end
    bool inner(std::string_view& type, const char* of);
    /// Skips an object whose template's name has been read, whatever is in it.
    void skip(std::string_view type);
    void skip_unknown(std::string_view type);
    /// A reference that has begun: `{` NAME `}`.
    std::string reference();

    float number();
    double exact_number();
    std::uint32_t integer();
    /// A number of things to come, each of at least so many numbers. Never more than can follow.
    std::uint32_t count(std::uint32_t numbers_each, const char* what);
    /// Below `end`.
    std::uint32_t index(std::uint64_t end, const char* of);
    std::string_view string();

    /// `N` floats for each of `count` things.
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

/// A Mesh whose type has been read, with all below it. Its own materials are appended to `materials`.
Mesh read_mesh(ObjectReader& in, std::vector<Material>& materials);

/// A Material whose type has been read.
Material read_material(ObjectReader& in);

/// A BendyName whose type has been read.
std::string read_name(ObjectReader& in);

/// A BendyConstraint whose type has been read; the record passes check_constraint but for the rest pose.
Constraint read_constraint(ObjectReader& in);

/// A BendyIkChain whose type has been read; every number in its range.
IkChain read_chain(ObjectReader& in);

/// An AnimationSet whose type has been read.
AnimationSet read_animation_set(ObjectReader& in);

/// Reads an X-file, text or binary. Indices inside a mesh are in range, counts agree; what refers to frames and
/// materials by name is not looked up yet. Fails at `line 3, column 7`; what is not known is named in `report`.
XFile read_x_file(std::string_view file, Report& report);

}  // namespace bendy::converter::x
