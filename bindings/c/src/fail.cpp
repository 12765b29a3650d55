#include "fail.h"

#include <bendy/format/diagnostics.h>

#include <algorithm>
#include <array>

namespace bendy::capi {
namespace {

constexpr std::array<const char*, 8> kStatusNames{"OK", "BAD_ARGUMENT", "NOT_FOUND", "OUT_OF_MEMORY",
                                                  "IO", "MALFORMED",    "INVALID",   "UNSUPPORTED"};

/// Copies as much of the text as fits, cut between characters and zero-terminated.
void put_text(std::string_view text, std::span<char> out) {
    std::size_t size = std::min(text.size(), out.size() - 1);
    constexpr unsigned kContinues = 0x80;  // 10xxxxxx: a byte inside a character of UTF-8
    constexpr unsigned kMask = 0xc0;
    while (size < text.size() && size > 0 && (static_cast<unsigned char>(text[size]) & kMask) == kContinues) --size;
    std::copy_n(text.begin(), size, out.begin());
    out[size] = '\0';
}

bendy_status fill(bendy_error* error, bendy_status status, std::uint64_t offset, std::string_view code,
                  std::string_view message) {
    if (error == nullptr) return status;
    error->status = status;
    error->reserved = 0;
    error->offset = offset;
    put_text(code, error->code);
    put_text(message, error->message);
    return status;
}

bendy_status status_of(ErrorCode code) {
    if (code == ErrorCode::kUnalignedBuffer) return BENDY_BAD_ARGUMENT;
    switch (error_class(code)) {
        case ErrorClass::malformed:
            return BENDY_MALFORMED;
        case ErrorClass::invalid:
            return BENDY_INVALID;
        case ErrorClass::unsupported:
            return BENDY_UNSUPPORTED;
        case ErrorClass::io:
            break;
    }
    return BENDY_IO;
}

/// "3 joints", "no joints", "1 joint".
std::string counted(std::size_t count, const char* kind) {
    const std::string number = count == 0 ? "no" : std::to_string(count);
    const bool has_es = std::string_view(kind).ends_with("sh");
    return number + ' ' + kind + (count == 1 ? "" : has_es ? "es" : "s");
}

}  // namespace

bendy_status fail(bendy_error* error, bendy_status status, std::string_view message) {
    return fill(error, status, 0, kStatusNames[status], message);
}

bendy_status out_of_memory(bendy_error* error) {
    return fail(error, BENDY_OUT_OF_MEMORY, "there is not enough memory");
}

bendy_status fail(bendy_error* error, const Error& fault, Bytes file) {
    const bendy_status status = status_of(fault.code);
    if (error == nullptr) return status;
    const bool has_place = error_class(fault.code) != ErrorClass::io;
    return fill(error, status, fault.offset, code_name(fault.code),
                has_place ? describe_with_place(fault, file) : describe(fault));
}

bendy_status from_call(const Result<void, CallError>& result, bendy_error* error) {
    return result ? BENDY_OK : fail(error, BENDY_BAD_ARGUMENT, error_text(result.error()));
}

bendy_status check_pointer(const void* pointer, const char* name, bendy_error* error) {
    if (pointer != nullptr) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + " is NULL");
}

bendy_status check_index(std::uint32_t index, std::size_t count, const char* kind, bendy_error* error,
                         const char* owner) {
    if (index < count) return BENDY_OK;
    if (index == BENDY_NONE) {
        return fail(error, BENDY_BAD_ARGUMENT,
                    std::string(kind) + " is BENDY_NONE: there is none of the name that was looked for");
    }
    return fail(
        error, BENDY_BAD_ARGUMENT,
        std::string(kind) + ' ' + std::to_string(index) + " does not exist: " + owner + " has " + counted(count, kind));
}

bendy_status check_range(std::uint32_t first, std::uint32_t count, std::size_t all, const char* kind,
                         bendy_error* error) {
    if (first <= all && count <= all - first) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT,
                "the model has " + counted(all, kind) + "; asked for " + std::to_string(count) + " from number " +
                    std::to_string(first));
}

bendy_status check_room(std::uint64_t room, std::uint64_t needed, const char* name, bendy_error* error) {
    if (room >= needed) return BENDY_OK;
    return fail(
        error, BENDY_BAD_ARGUMENT,
        std::string(name) + " has room for " + std::to_string(room) + ", " + std::to_string(needed) + " are needed");
}

bendy_status check_value(std::uint32_t value, std::uint32_t count, const char* name, const char* kind,
                         bendy_error* error) {
    if (value < count) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + ' ' + std::to_string(value) + " is not a " + kind);
}

namespace {

template <class Number>
bendy_status check_numbers(std::span<const Number> numbers, const char* name, bendy_error* error) {
    if (std::all_of(numbers.begin(), numbers.end(), [](Number number) { return std::isfinite(number); }))
        return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + " holds a number that is not finite");
}

template <class Number>
bendy_status check_unit(const Number* rotation, bendy_error* error) {
    const std::span<const Number> numbers(rotation, 4);
    if (const bendy_status status = check_numbers(numbers, "rotation", error)) return status;
    double squares = 0.0;
    for (const Number number : numbers) squares += static_cast<double>(number) * number;
    constexpr double kTolerance = 0.01;
    if (std::abs(std::sqrt(squares) - 1.0) <= kTolerance) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, "rotation is not a unit quaternion (x, y, z, w)");
}

}  // namespace

bendy_status check_finite(std::span<const float> numbers, const char* name, bendy_error* error) {
    return check_numbers(numbers, name, error);
}

bendy_status check_finite(std::span<const double> numbers, const char* name, bendy_error* error) {
    return check_numbers(numbers, name, error);
}

bendy_status check_number(double number, const char* name, bendy_error* error) {
    return std::isnan(number) ? fail(error, BENDY_BAD_ARGUMENT, std::string(name) + " is not a number") : BENDY_OK;
}

bendy_status check_fraction(double number, const char* name, bendy_error* error) {
    if (number >= 0.0 && number <= 1.0) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + " must lie between 0 and 1");
}

bendy_status check_rotation(const float* rotation, bendy_error* error) {
    return check_unit(rotation, error);
}

bendy_status check_rotation(const double* rotation, bendy_error* error) {
    return check_unit(rotation, error);
}

}  // namespace bendy::capi
