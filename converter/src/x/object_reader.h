#pragma once

#include "tokens.h"
#include "x_file.h"

#include <bendy/converter/report.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter::x {

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
