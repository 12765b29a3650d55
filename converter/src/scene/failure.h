#pragma once

#include <bendy/converter/report.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <utility>

namespace bendy::converter {

inline constexpr std::string_view kNotEnoughMemory = "not enough memory";
/// The warning of exports to formats in which a joint cannot have a material of its own.
inline constexpr std::string_view kOwnMaterialShared = "a joint's own material is written as the file's";

/// Thrown by the readers inside this folder on bad input; the public functions catch it and return the error.
struct Failure {
    ImportError error;
};

[[noreturn]] inline void fail(std::string place, std::string message) {
    throw Failure{{std::move(place), std::move(message)}};
}

/// "nodes" and 3 make "nodes[3]".
inline std::string at(std::string_view array, std::size_t index) {
    return std::string(array) + '[' + std::to_string(index) + ']';
}

/// A member's name as part of a place; names with special characters are quoted.
std::string key(const std::string& name);

/// Makes a name from the source safe for a one-line message: control characters escaped, long names truncated.
std::string quote(std::string_view name);

/// Calls `work`, which returns a T or a Result of it, and converts exceptions to the error. For public functions, which
/// throw nothing.
template <class T, class Work>
Result<T, ImportError> without_throwing(const Work& work) {
    try {
        return work();
    } catch (const Failure& failure) {
        return failure.error;
    } catch (const std::bad_alloc&) {
        return ImportError{{}, std::string(kNotEnoughMemory)};
    } catch (const std::exception& error) {
        return ImportError{{}, std::string("unexpected: ") + error.what()};
    }
}

}  // namespace bendy::converter
