#pragma once

#include <bendy/format/records.h>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter::x {

// What the reader finds in an X-file, numbers as they stand there: left-handed, Z into the screen. A `place` says where
// in the file. Matrices lie as in glTF: X-files write them row by row for row vectors, which is the same order.

using Matrix = std::array<double, 16>;
inline constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

struct Named {
    std::string identifier;  ///< by which the file refers to it; may be empty
    std::string name;        ///< what BendyName says, else the identifier
    std::string place;
};

struct Frame : Named {
    std::uint32_t parent = kNone;  ///< smaller than its own number
    Matrix matrix = kIdentity;
};

struct Skin {  ///< SkinWeights: one bone of a mesh
    std::string frame;
    std::vector<std::uint32_t> vertices;
    std::vector<float> weights;
    Matrix offset = kIdentity;
    std::string place;
};

struct Material : Named {
    glm::vec4 colour{1.0f};
    float power = 0.0f;
    glm::vec3 specular{0.0f};
    glm::vec3 emissive{0.0f};
    std::string texture;  ///< a file name, or empty
};

struct MaterialSlot {
    std::uint32_t material = kNone;  ///< number in XFile::materials; kNone: by its identifier
    std::string identifier;
    std::string place;
};

struct Mesh : Named {
    std::uint32_t frame = kNone;
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> face_sizes;  ///< corners of each face, 1 or more
    std::vector<std::uint32_t> corners;     ///< positions, face after face
    std::vector<glm::vec3> normals;
    std::vector<std::uint32_t> normal_corners;  ///< as many as corners, or none
    std::vector<glm::vec2> coords;              ///< one for each position, or none
    std::vector<glm::vec4> colours;             ///< one for each position, or none
    std::vector<MaterialSlot> slots;
    std::vector<std::uint32_t> face_slots;  ///< one for each face, or none
    std::vector<Skin> skins;
};

struct Keys {
    std::vector<double> times;  ///< ticks
    std::vector<float> values;  ///< 4 (w x y z), 3, 3 or 16 for each key
};

struct Animation {
    std::string frame;
    /// By type: rotation, scale, position, matrix.
    std::array<Keys, 4> keys;
    std::string place;
};

struct AnimationSet : Named {
    bool loops = false;
    std::vector<Animation> animations;
};

struct Constraint {
    std::uint32_t frame = 0;
    ConstraintRecord record;
    std::string place;
};

struct IkChain {
    std::string name;
    std::string start, effector, target, pole;  ///< frames' identifiers, or empty
    ChainRecord record;                         ///< but for its joints
    std::vector<std::pair<std::string, float>> weights;
    std::string extras;
    std::string place;
};

struct XFile {
    std::vector<Frame> frames;  ///< parents first, each followed by all below it
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<AnimationSet> sets;
    std::vector<Constraint> constraints;
    std::vector<IkChain> chains;
    double ticks_per_second = 0.0;                                ///< 0: the file does not say
    std::vector<std::pair<std::string, std::string>> clip_names;  ///< of sets: identifier, name
};

}  // namespace bendy::converter::x
