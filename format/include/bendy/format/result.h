#pragma once

#include <bendy/format/error.h>
#include <bendy/format/public.h>

#include <cassert>
#include <optional>
#include <utility>

namespace BENDY_PUBLIC bendy {

/// A value of type T, or the reason why there is none. The spelling is that of std::expected, which our compilers lack;
/// it neither throws nor needs RTTI. Reading the absent side is the caller's bug and is asserted.
template <class T, class E = Error>
class [[nodiscard]] Result {
public:
    // NOLINTNEXTLINE(google-explicit-constructor): `return value;` is the point of the type
    Result(T value) : value_(std::move(value)) {}
    // NOLINTNEXTLINE(google-explicit-constructor): `return error;` likewise
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

/// Success, or the reason why not: Result<void> as std::expected<void, E> would be.
template <class E>
class [[nodiscard]] Result<void, E> {
public:
    Result() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): `return error;` is the point of the type
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
