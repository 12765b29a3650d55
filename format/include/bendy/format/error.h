#pragma once

#include <bendy/format/public.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// Kinds of errors, as listed in error_codes.def.
enum class ErrorCode : std::uint8_t {
#define BENDY_ERROR(enumerator, kind, code, text) enumerator,
#include <bendy/format/error_codes.def>
#undef BENDY_ERROR
};

/// malformed: the grammar is violated. invalid: the grammar is followed, but the content is wrong. unsupported: a valid
/// file that this version cannot read. io: an error of the operating system.
enum class ErrorClass : std::uint8_t { malformed, invalid, unsupported, io };

/// An error and its location. Small and without text: the texts are in the table, `describe` fills them in and
/// `chunk_path` finds the path (both in diagnostics.h).
struct Error {
    ErrorCode code = ErrorCode::kNotABendyFile;
    std::uint64_t offset = 0;  ///< bytes from the start of the file, to the chunk's header or to the field inside it
    std::uint64_t value = 0;   ///< what was found; the meaning depends on the code's text
    std::uint64_t limit = 0;   ///< the limit or expectation that it violates
};

/// Returns the code as `bendy validate` prints it, e.g. "CHUNK_TOO_LONG".
const char* code_name(ErrorCode code);
/// Returns the class of a code, and its text with the placeholders {v} and {l}.
ErrorClass error_class(ErrorCode code);
/// Returns the name of a class: "malformed".
const char* class_name(ErrorClass kind);
const char* error_text(ErrorCode code);

/// A list of faults, where more than the first is wanted. Keeps at most kMost, so that a hostile file cannot make the
/// list larger than itself, and counts the rest.
class Faults {
public:
    static constexpr std::size_t kMost = 1'000;

    void add(const Error& fault) {
        if (list_.size() < kMost) {
            list_.push_back(fault);
        } else {
            ++left_out_;
        }
    }
    [[nodiscard]] const std::vector<Error>& list() const& { return list_; }
    const std::vector<Error>& list() const&& = delete;  // it would outlive its owner
    [[nodiscard]] std::size_t left_out() const { return left_out_; }
    /// Number of all faults so far, kept or not.
    [[nodiscard]] std::size_t count() const { return list_.size() + left_out_; }
    [[nodiscard]] bool empty() const { return list_.empty(); }

private:
    std::vector<Error> list_;
    std::size_t left_out_ = 0;
};

}  // namespace bendy
