#include <bendy/format/error.h>

#include <array>

namespace bendy {
namespace {

struct Entry {
    const char* name;
    ErrorClass kind;
    const char* text;
};

constexpr Entry kEntries[] = {
#define BENDY_ERROR(enumerator, kind, code, text) {code, ErrorClass::kind, text},
#include <bendy/format/error_codes.def>
#undef BENDY_ERROR
};

const Entry& entry(ErrorCode code) {
    return kEntries[static_cast<std::size_t>(code)];
}

}  // namespace

const char* code_name(ErrorCode code) {
    return entry(code).name;
}
ErrorClass error_class(ErrorCode code) {
    return entry(code).kind;
}
const char* class_name(ErrorClass kind) {
    switch (kind) {
        case ErrorClass::malformed:
            return "malformed";
        case ErrorClass::invalid:
            return "invalid";
        case ErrorClass::unsupported:
            return "unsupported";
        case ErrorClass::io:
            return "io";
    }
    return "";
}
const char* error_text(ErrorCode code) {
    return entry(code).text;
}

}  // namespace bendy
