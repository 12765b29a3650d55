#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/error.h>
#include <bendy/format/public.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

// MARK: named times of a clip.
namespace BENDY_PUBLIC bendy {

/// An event at a time of a clip: a footstep, a hit, a sound to play.
struct Marker {
    float seconds = 0.0f;   ///< on the clip's time line, between its start and end
    std::string_view name;  ///< UTF-8; may be empty, need not be unique
};

/// Reads the payload of a MARK. The names refer to it; times may be any numbers. If it is not valid, adds a fault at
/// `offset` and returns nothing. The memory that the markers take is bounded by the payload's size.
std::optional<std::vector<Marker>> read_markers(Bytes payload, std::uint64_t offset, Faults& faults);

/// Returns the payload for these markers; the total length of their names must be less than 4 GiB.
std::vector<std::byte> write_markers(std::span<const Marker> markers);

}  // namespace bendy
