#pragma once

#include <draco/core/status_or.h>
#include <draco/mesh/mesh.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace bendy::converter::gltf {

/// Decodes a mesh like draco::Decoder, without transforming attributes to floats, but rejects data with counts that
/// exceed what it describes: Draco 1.5.5 trusts some counts, and spends seconds on a few bytes.
/// \param method       draco::MeshEncoderMethod of the data's header
/// \param most_values  limit over all attributes of all points
draco::StatusOr<std::unique_ptr<draco::Mesh>> decode_draco_mesh(std::span<const std::byte> data, std::uint8_t method,
                                                                std::uint64_t most_values);

}  // namespace bendy::converter::gltf
