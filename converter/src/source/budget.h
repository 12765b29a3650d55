#pragma once

#include "failure.h"

#include <cstdint>
#include <string>

namespace bendy::converter {

/// How many bytes the decoded scene may take. A small hostile file can ask for any amount: one accessor used by every
/// primitive, one mesh by every node, compressed or implied zeros. So whatever grows the result is charged here first.
class Budget {
public:
    static constexpr std::uint64_t kFloor = std::uint64_t{1} << 30;  ///< bytes that any file may decode to
    static constexpr std::uint64_t kPerSourceByte = 64;              ///< beyond the floor, for each byte of the source

    void add_source(std::uint64_t bytes) {
        const std::uint64_t room = UINT64_MAX - left_;
        left_ += bytes <= room / kPerSourceByte ? bytes * kPerSourceByte : room;
    }

    /// Charges `count` elements of `size` bytes, or fails at `place`.
    void take(std::uint64_t count, std::uint64_t size, const std::string& place) {
        if (size != 0 && count > left_ / size) fail(place, "the decoded data would be implausibly large");
        left_ -= count * size;
    }

private:
    std::uint64_t left_ = kFloor;
};

}  // namespace bendy::converter
