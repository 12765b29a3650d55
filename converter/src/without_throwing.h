#pragma once

#include "failure.h"

#include <bendy/converter/report.h>
#include <bendy/format/result.h>

#include <exception>
#include <new>
#include <string>

namespace bendy::converter {

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
