#pragma once

#include <bendy/format/error.h>
#include <bendy/format/public.h>

#include <cassert>
#include <optional>
#include <utility>

namespace BENDY_PUBLIC bendy {

/// A value of type T, or the reason why there is none. The interface follows std::expected, which the supported
/// compilers lack; it does not throw and needs no RTTI. Accessing the absent side is a bug of the caller and is
/// asserted.
template <class T, class E = Error>
class [[nodiscard]] Result {
public:
    // NOLINTNEXTLINE(google-explicit-constructor): allows `return value;`
    Result(T value) : value_(std::move(value)) {}
    // NOLINTNEXTLINE(google-explicit-constructor): allows `return error;`
    Result(E error) : error_(std::move(error)) {}

    [[nodiscard]] bool has_value() const { return value_.has_value(); }
    explicit operator bool() const { return has_value(); }

    T& operator*() & {
        assert(has_value());
        return *value_;
    }
    const T& operator*() const& {
        assert(has_value());
        return *value_;
    }
    T&& operator*() && {
        assert(has_value());
        return std::move(*value_);
    }
    T* operator->() {
        assert(has_value());
        return &*value_;
    }
    const T* operator->() const {
        assert(has_value());
        return &*value_;
    }
    [[nodiscard]] const E& error() const {
        assert(!has_value());
        return error_;
    }

private:
    std::optional<T> value_;
    E error_{};
};

/// Success, or the reason for failure: Result<void>, as std::expected<void, E>.
template <class E>
class [[nodiscard]] Result<void, E> {
public:
    Result() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): allows `return error;`
    Result(E error) : error_(std::move(error)) {}

    [[nodiscard]] bool has_value() const { return !error_.has_value(); }
    explicit operator bool() const { return has_value(); }
    [[nodiscard]] const E& error() const {
        assert(!has_value());
        return *error_;
    }

private:
    std::optional<E> error_;
};

}  // namespace bendy
