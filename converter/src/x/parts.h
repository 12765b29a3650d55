#pragma once

#include "source/named_files.h"
#include "source/source_file.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/records.h>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
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

// The parts of an import, in the order in which import_x calls them.

/// Finds the joints of frames by the identifiers that the file uses.
class FrameIndex {
public:
    explicit FrameIndex(const XFile& file);
    /// Of several frames with one identifier the first; kNone if there is none.
    [[nodiscard]] std::uint32_t find(std::string_view identifier) const;
    /// The same; fails at `place` if there is none. \param what  looks for it
    [[nodiscard]] std::uint32_t expect(std::string_view identifier, const char* what, const std::string& place) const;

private:
    std::unordered_map<std::string_view, std::uint32_t> joint_of_;
};

/// Every frame becomes the joint of its number.
void import_joints(const XFile& file, Scene& scene, Report& report);

/// The constraints and chains of our own templates.
void import_rig(const XFile& file, const FrameIndex& frames, Scene& scene, Report& report);

/// 16 numbers as a matrix of floats. Fails at `place` on numbers too large.
glm::mat4 to_floats(const Matrix& matrix, const std::string& place);

/// Fills Scene::materials, textures and images. \param file  beside which images are looked for
void import_materials(const XFile& source, NamedFiles& files, bool embed_images, Scene& scene, Report& report);

/// How much of the light a surface that is no metal throws straight back.
inline constexpr float kDielectric = 0.04f;

/// Phong's exponent and the roughness that shines as wide, 0 to 1 (Blinn-Phong and Beckmann: n = 2 / r^4 - 2).
float roughness_of(float power);
float power_of(float roughness);

/// Fills Scene::meshes; faces become triangles, and positions that have several normals several vertices. A rigid mesh
/// outside of all frames gets a joint of its own.
void import_meshes(const XFile& file, const FrameIndex& frames, Budget& budget, Scene& scene, Report& report);

/// Fills Scene::clips. Keys are linear; a single key that says no more than the rest pose is none.
void import_clips(const XFile& file, const FrameIndex& frames, Scene& scene, Report& report);

}  // namespace bendy::converter::x
