#pragma once

#include "scene/source/named_files.h"
#include "scene/source/source_file.h"

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

// The contents of an X-file, with unconverted numbers: left-handed, Z into the screen. A `place` is a place in the
// file. Matrices are laid out as in glTF: X-files write them row by row for row vectors, which is the same order.

using Matrix = std::array<double, 16>;
inline constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

struct Named {
    std::string identifier;  ///< the name in references; may be empty
    std::string name;        ///< from BendyName, else the identifier
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
    bool is_own = false;  ///< stands in a mesh
};

struct MaterialSlot {
    std::uint32_t material = kNone;  ///< index into XFile::materials; kNone: by its identifier
    std::string identifier;
    std::string place;
};

struct Mesh : Named {
    std::uint32_t frame = kNone;
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> face_sizes;  ///< corners per face, 1 or more
    std::vector<std::uint32_t> corners;     ///< position indices, face after face
    std::vector<glm::vec3> normals;
    std::vector<std::uint32_t> normal_corners;  ///< one per corner, or none
    std::vector<glm::vec2> coords;              ///< one per position, or none
    std::vector<glm::vec4> colours;             ///< one per position, or none
    std::vector<MaterialSlot> slots;
    std::vector<std::uint32_t> face_slots;  ///< one per face, or none
    std::vector<Skin> skins;
};

struct Keys {
    std::vector<double> times;  ///< ticks
    std::vector<float> values;  ///< 4 (w x y z), 3, 3 or 16 per key
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
    ChainRecord record;                         ///< without its joints
    std::vector<std::pair<std::string, float>> weights;
    std::string extras;
    std::string place;
};

struct XFile {
    std::vector<Frame> frames;  ///< parents first, each followed by its descendants
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<AnimationSet> sets;
    std::vector<Constraint> constraints;
    std::vector<IkChain> chains;
    double ticks_per_second = 0.0;                                ///< as it is written, also 0 and less
    std::string ticks_place;                                      ///< empty: the file does not give them
    std::vector<std::pair<std::string, std::string>> clip_names;  ///< of animation sets: identifier, name
};

// The stages of an import, in the order in which import_x calls them.

/// Finds the joints of frames by their identifiers in the file.
class FrameIndex {
public:
    explicit FrameIndex(const XFile& file);
    /// The first frame with an identifier; kNone if there is none.
    [[nodiscard]] std::uint32_t find(std::string_view identifier) const;
    /// As above; fails at `place` if there is none.
    /// \param what  the referring object, for the message
    [[nodiscard]] std::uint32_t expect(std::string_view identifier, const char* what, const std::string& place) const;

private:
    std::unordered_map<std::string_view, std::uint32_t> joint_of_;
};

/// Makes every frame the joint with the same number.
void import_joints(const XFile& file, Scene& scene, Report& report);

/// Imports constraints and chains from our own templates.
void import_rig(const XFile& file, const FrameIndex& frames, Scene& scene, Report& report);

/// Converts 16 numbers to a matrix of floats. Fails at `place` on numbers that are too large.
glm::mat4 to_floats(const Matrix& matrix, const std::string& place);

/// Fills Scene::materials, textures and images.
/// \param file  images are looked for in its folder
void import_materials(const XFile& source, NamedFiles& files, bool embed_images, Scene& scene, Report& report);

/// The share of light that a non-metal surface reflects at normal incidence.
inline constexpr float kDielectric = 0.04f;

/// Converts between Phong's exponent and the roughness, 0 to 1, with an equally wide highlight (Blinn-Phong and
/// Beckmann: n = 2 / r^4 - 2).
float roughness_of(float power);
float power_of(float roughness);

/// Fills Scene::meshes; faces become triangles, and positions with several normals several vertices. A rigid mesh
/// outside of all frames gets a joint of its own.
void import_meshes(const XFile& file, const FrameIndex& frames, Budget& budget, Scene& scene, Report& report);

/// Fills Scene::clips. Keys are linear; a single key that equals the rest pose is dropped.
void import_clips(const XFile& file, const FrameIndex& frames, Scene& scene, Report& report);

}  // namespace bendy::converter::x
