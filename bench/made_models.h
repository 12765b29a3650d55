#pragma once

#include <bendy/format/chunk_writer.h>
#include <bendy/format/records.h>
#include <bendy/runtime/model.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

// Synthetic models of any size, for measurements.
namespace bendy::bench {

struct MadeModel {
    std::vector<std::byte> bytes;  // that the model is mapped to
    Model model;
};

/// Returns the bytes of a character with one clip: chains of ten joints on one root, a rotation track of 31 keys for
/// each joint, and a sheet of vertices with four influences of near bones, the same for sixty-four neighbours. The
/// bytes are aligned to 16, as vectors of bytes are on all machines that we build for.
std::vector<std::byte> make_character(std::uint32_t joints, std::uint32_t vertices);

/// Makes a mesh with four influences per vertex from 64 joints; near vertices follow near joints, as in characters.
std::unique_ptr<const MadeModel> make_mesh(std::uint32_t vertices);

/// Makes a face without a skin: each morph target displaces positions and normals of `touched` vertices, in runs of
/// eight at random positions in the mesh. \param is_packed  displacements are boxed 16-bit integers, as --compact
/// stores them; otherwise floats
std::unique_ptr<const MadeModel> make_face(std::uint32_t vertices, std::uint32_t targets, std::uint32_t touched,
                                           bool is_packed);

/// Makes a chain with a pole: two bones, or for Solver::aim one joint.
/// \param is_limited  the middle joint is a hinge
std::unique_ptr<const MadeModel> make_chain(Solver solver, bool is_limited);

/// Writes a plain stream: a StreamRecord and the numbers.
template <class T>
void put_stream(ChunkWriter& out, FourCC id, ComponentType type, std::uint32_t components,
                const std::vector<T>& numbers) {
    StreamRecord record;
    record.component_type = static_cast<std::uint8_t>(type);
    record.components = static_cast<std::uint16_t>(components);
    record.elements = static_cast<std::uint32_t>(numbers.size() / components);
    const Bytes pieces[] = {bytes_of(record), std::as_bytes(std::span(numbers))};
    out.leaf(id, pieces);
}

}  // namespace bendy::bench
