#pragma once

#include <bendy/runtime.h>

#include <cstdint>
#include <string>
#include <vector>

namespace bendy::cli {

/// A mesh's posed vertices and what connects them.
struct PosedMesh {
    std::string name;
    std::vector<glm::vec3> positions;                     ///< model space
    std::vector<glm::vec3> normals;                       ///< as many, or none
    std::vector<std::uint32_t> triangles, lines, points;  ///< 3, 2 and 1 vertices each
};

struct PosedJoint {
    std::string name;
    glm::mat4 world{1.0f};
};

/// An IK target, and how near its chain came.
struct PosedReach {
    std::string chain;  ///< its name, or its number
    ReachTarget target;
    float distance = 0.0f;  ///< metres left
    float angle = 0.0f;     ///< radians left, where the target has a rotation
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
    std::vector<PosedReach> reaches;  ///< empty: no chain was to reach anything
    std::vector<PosedCurve> curves;   ///< empty: the clip has none
    std::vector<PosedJoint> joints;
    std::vector<PosedMesh> meshes;
};

/// Wavefront OBJ: an `o` group per mesh; numbers in the shortest form that reads back to the same float.
std::string write_obj(const PosedObject& object);
/// PLY, binary little-endian: vertices with normals, faces; edges if there are any.
std::string write_ply(const PosedObject& object);
/// {"file", "clip", "time", "joints": [{"name", "world"}], "meshes": [{"name", "positions", "normals", "indices"}]};
/// and where chains were to reach targets "reaches": [{"chain", "target", "distance", "reached"}] after "time", with
/// "rotation" and "angle" where the target has a rotation. Where the clip has curves, before "joints"
/// "curves": [{"name", "path", "value"}], with "target": {KIND: number} where it has one.
std::string write_json(const PosedObject& object);

}  // namespace bendy::cli
