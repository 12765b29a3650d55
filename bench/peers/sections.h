#pragma once

#include "character.h"
#include "peer_timing.h"

#include <bendy/runtime.h>

#include <string>

// What is measured, each function into rows of its own.
namespace bendy::bench {

/// All clips by turns, each with times of its own.
void measure_sampling(Table& table, const Character& character);
/// The same with the clips of a compact file of the character on our side, and optimised ones on ozz's.
void measure_packed(Table& table, const Character& character, const Model& packed);
void measure_matrices(Table& table, const Character& character);
void measure_blending(Table& table, const Character& character);
/// The character's meshes, with a normal and a tangent for every vertex.
void measure_skinning(Table& table, const Character& character);
/// Meshes of a million vertices.
void measure_large(Table& table);
/// A frame in which the character's two-bone chains reach a little away from where they are.
void measure_reaching(Table& table, const Character& character);
/// A chain of two bones, or the aim of one joint, alone.
void measure_chain(Table& table, Solver solver);
/// A crowd of the character, on one thread and on two: palettes, then vertices.
void measure_crowds(Table& table, const Character& character);
/// From the file to the first pose, beside cgltf with the glTF file that it was made from.
void measure_opening(Table& table, const std::string& path, const std::string& source);

}  // namespace bendy::bench
