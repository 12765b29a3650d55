#pragma once

#include <bendy/format/error.h>

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <utility>

namespace bendy {

/// The error that errno holds.
inline Error system_error(ErrorCode code) {
    return {code, 0, static_cast<std::uint64_t>(errno)};
}

/// A file descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    Descriptor(Descriptor&&) = delete;
    Descriptor& operator=(Descriptor&&) = delete;
    [[nodiscard]] int number() const { return number_; }
    [[nodiscard]] int release() { return std::exchange(number_, -1); }
    [[nodiscard]] bool close() { return ::close(release()) == 0; }

private:
    int number_;
};

}  // namespace bendy
