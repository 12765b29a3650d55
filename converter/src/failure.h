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

/// What the readers inside this folder throw when the source is bad; the public functions catch it and return the
/// error.
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

/// A member's name as part of a place; odd ones are quoted.
std::string key(const std::string& name);

/// A name from the source, fit to stand in a one-line message: control characters escaped, long ones cut.
std::string quote(std::string_view name);

/// What `work` returns, a T or a Result of it; what it throws becomes the error. For public functions, which throw
/// nothing.
template <class T, class Work>
Result<T, ImportError> without_throwing(const Work& work) {
    try {
        return work();
    } catch (const Failure& failure) {
        return failure.error;
    } catch (const std::bad_alloc&) {
        return ImportError{{}, "not enough memory"};
    } catch (const std::exception& error) {
        return ImportError{{}, std::string("unexpected: ") + error.what()};
    }
}

}  // namespace bendy::converter
