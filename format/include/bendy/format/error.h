#pragma once

#include <bendy/format/public.h>

#include <cstdint>

namespace BENDY_PUBLIC bendy {

/// What is wrong; the table is error_codes.def.
enum class ErrorCode : std::uint8_t {
#define BENDY_ERROR(enumerator, kind, code, text) enumerator,
#include <bendy/format/error_codes.def>
#undef BENDY_ERROR
};

/// malformed: the grammar is broken. invalid: the grammar holds, the meaning does not. unsupported: a good file that
/// this version cannot read. io: the system said no.
enum class ErrorClass : std::uint8_t { malformed, invalid, unsupported, io };

/// A fault with its place. Small and without text: the words stand in the table, `describe` puts them together and
/// `chunk_path` finds the path (both in diagnostics.h).
struct Error {
    ErrorCode code = ErrorCode::kNotABendyFile;
    std::uint64_t offset = 0;  ///< bytes from the start of the file: of the chunk's header, or of the field inside it
    std::uint64_t value = 0;   ///< what was found, in the sense of the code's text
    std::uint64_t limit = 0;   ///< what it was held against
};

/// The code as `bendy validate` prints it, e.g. "CHUNK_TOO_LONG".
const char* code_name(ErrorCode code);
/// The code's class and its text with {v} and {l} still in it.
ErrorClass error_class(ErrorCode code);
const char* error_text(ErrorCode code);

}  // namespace bendy
