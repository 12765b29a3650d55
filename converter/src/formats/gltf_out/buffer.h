#pragma once

#include "scene/json_text.h"

#include <bendy/format/byte_reader.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace bendy::converter::gltf_out {

/// The single buffer of a glTF file, with its views and accessors. Equal accessors are stored once.
class Buffer {
public:
    /// The purpose of an accessor's view.
    enum class Use : std::uint8_t { data, vertices, indices };

    /// Adds `values`, `components` per element, as 32-bit floats.
    /// \return the accessor's number
    std::uint32_t add_floats(std::span<const float> values, std::uint32_t components, Use use, bool with_bounds);

    /// Adds numbers from 0 to 1 for vertices, as normalised bytes or words if that is lossless.
    std::uint32_t add_fractions(std::span<const float> values, std::uint32_t components);

    /// Adds unsigned integers as bytes (not for indices), words or, if the largest needs it, 32 bits.
    std::uint32_t add_integers(std::span<const std::uint32_t> values, std::uint32_t components, Use use);

    /// Adds vectors of three that are mostly zero: as a sparse accessor, if that is smaller.
    std::uint32_t add_displacements(std::span<const float> values);

    /// Adds an image's bytes.
    /// \return the view's number
    std::uint32_t add_bytes(Bytes bytes);

    [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }
    /// Moves the bytes out of the buffer.
    std::vector<std::byte> take() && { return std::move(bytes_); }
    [[nodiscard]] const Json& views() const { return views_; }
    [[nodiscard]] const Json& accessors() const { return accessors_; }

private:
    /// Adds elements of `element` bytes each, padded to four for vertices.
    std::uint32_t add_view(Bytes bytes, std::size_t element, Use use);
    std::uint32_t add_accessor(Json accessor);

    std::vector<std::byte> bytes_;
    Json views_ = Json::array();
    Json accessors_ = Json::array();
    std::unordered_multimap<std::size_t, std::uint32_t> known_views_;  ///< by hash of content
    std::unordered_map<std::string, std::uint32_t> known_accessors_;   ///< by their text
};

}  // namespace bendy::converter::gltf_out
