#pragma once

#include <bendy/runtime/model.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

// Models that are made for measuring, of any size.
namespace bendy::bench {

struct MadeModel {
    std::vector<std::byte> bytes;  // in which the model lies
    Model model;
};

/// The bytes of a character with one clip: chains of ten joints on one root, each with a rotation track of 31 keys; on
/// them a sheet of vertices, four influences of bones that are near, sixty-four neighbours the same. On a 16-byte
/// boundary, as vectors of bytes are on all machines that we build for.
std::vector<std::byte> make_character(std::uint32_t joints, std::uint32_t vertices);

/// A mesh with four influences among 64 joints, near ones together, as characters have them.
std::unique_ptr<const MadeModel> make_mesh(std::uint32_t vertices);

/// A face of morph targets without a skin: each target displaces positions and normals of `touched` vertices, in runs
/// of eight at random places. \param is_packed  displacements are 16-bit integers in boxes, as --compact stores them;
/// otherwise floats
std::unique_ptr<const MadeModel> make_face(std::uint32_t vertices, std::uint32_t targets, std::uint32_t touched,
                                           bool is_packed);

/// A chain with a pole: two bones, or for Solver::aim one joint.
/// \param is_limited  the middle joint is a hinge
std::unique_ptr<const MadeModel> make_chain(Solver solver, bool is_limited);

}  // namespace bendy::bench
