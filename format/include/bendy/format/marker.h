#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/faults.h>
#include <bendy/format/public.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

// MARK: named times of a clip.
namespace BENDY_PUBLIC bendy {

/// A footstep, a hit, a sound to be played: what happens at a time of a clip.
struct Marker {
    float seconds = 0.0f;   ///< on the clip's own time, between its start and end
    std::string_view name;  ///< UTF-8; may be empty, may be doubled
};

/// Reads a MARK's payload. Names lie in it; times may be any. Nothing, and a fault at `offset`, if it is none. The
/// memory that the markers take is bounded by the payload's size.
std::optional<std::vector<Marker>> read_markers(Bytes payload, std::uint64_t offset, Faults& faults);

/// The payload for these markers; their names are less than 4 GiB together.
std::vector<std::byte> write_markers(std::span<const Marker> markers);

}  // namespace bendy
