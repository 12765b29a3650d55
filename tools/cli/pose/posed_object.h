#pragma once

#include <bendy/runtime.h>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <vector>

// What `bendy pose` writes, and its formats.
namespace bendy::tools {

/// A mesh's posed vertices and its primitives.
struct PosedMesh {
    std::string name;
    std::vector<glm::vec3> positions;                     ///< model space
    std::vector<glm::vec3> normals;                       ///< one per vertex, or none
    std::vector<std::uint32_t> triangles, lines, points;  ///< 3, 2 and 1 vertices each
};

struct PosedJoint {
    std::string name;
    glm::mat4 world{1.0f};
};

/// An IK target, and the distance that remained.
struct PosedReach {
    std::string chain;  ///< its name, or its number
    ReachTarget target;
    float distance = 0.0f;  ///< metres that remained
    float angle = 0.0f;     ///< radians that remained, if the target has a rotation; always for an aim
    bool is_aim = false;
    bool is_reached = false;
};

/// A named curve of the clip, and its value.
struct PosedCurve {
    std::string name, path;
    std::string target_kind;  ///< joint, material, mesh or texture; empty: no target
    std::uint32_t target = 0;
    std::vector<float> value;
};

struct PosedObject {
    std::string file;
    std::string clip;  ///< empty: the rest pose
    float time = 0.0f;
    std::vector<PosedReach> reaches;  ///< empty: no chain had a target
    std::vector<PosedCurve> curves;   ///< empty: the clip has no curves
    std::vector<PosedJoint> joints;
    std::vector<PosedMesh> meshes;
};

/// Wavefront OBJ: an `o` group per mesh; numbers in the shortest form that reads back to the same float.
std::string write_obj(const PosedObject& object);

/// PLY, binary little-endian: vertices with normals, faces; edges if there are any.
std::string write_ply(const PosedObject& object);

/// {"file", "clip", "time", "joints": [{"name", "world"}], "meshes": [{"name", "positions", "normals", "indices"}]}. If
/// chains had targets, "reaches": [{"chain", "target", "distance", "reached"}] follows "time", with "rotation" if the
/// target has one, and "angle" then and for an aim. If the clip has curves, "curves": [{"name", "path", "value"}] comes
/// before "joints", with "target": {KIND: number} if the curve has one.
std::string write_json(const PosedObject& object);

}  // namespace bendy::tools
