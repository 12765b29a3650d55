#pragma once

#include <bendy/format/readable_folders.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/pose.h>
#include <bendy/viewer/picture.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

// Rendering pictures of a character without a display.
namespace bendy::viewer {

/// Receives a line about something that cannot be shown correctly.
using Warn = std::function<void(const std::string& what)>;

/// Selects what is drawn.
struct DrawOptions {
    bool surface = true;  ///< the character itself
    bool wireframe = false;
    bool bones = false;
    bool thin_bones = false;  ///< each as a line, which takes an eighth of the triangles
    bool axes = false;        ///< of the joints: X red, Y green, Z blue
    bool constraints = false;
    bool targets = false;                              ///< of IK chains
    std::uint32_t marked_joint = kNone;                ///< highlighted, with its axes
    glm::vec4 background{0.086f, 0.1f, 0.122f, 1.0f};  ///< linear; alpha 0: transparent
};

struct CameraOptions {
    float yaw = 0.6f;       ///< radians about Y; 0 looks along -Z, at the front of a character that faces +Z
    float pitch = 0.2f;     ///< radians above the horizon
    float distance = 1.0f;  ///< 1: the character fills the picture
};

/// The target of a reach. It is always in the picture, with a line from the chain's tip.
struct DrawnTarget {
    const Chain* chain = nullptr;  ///< of the model
    glm::vec3 position{0.0f};      ///< metres, model space
};

/// What the textures of a picture take at most, with their mipmaps. Larger ones are scaled down, with a warning.
inline constexpr std::uint64_t kMostTextureBytes = std::uint64_t{256} << 20u;

struct RenderOptions {
    std::uint32_t width = 1024;  ///< pixels, 1 to kMostPixels
    std::uint32_t height = 768;  ///< likewise
    const Clip* clip = nullptr;  ///< null: the rest pose
    float lod = 1.0f;            ///< fraction of the triangles
    CameraOptions camera;
    DrawOptions draw;
    ReadableFolders folders;  ///< of the images that the file links to
    std::uint64_t texture_bytes = kMostTextureBytes;
    /// Changes every pose after sampling, to apply constraints or IK. May be empty.
    std::function<void(Pose&)> adjust;
    std::vector<DrawnTarget> targets;
};

inline constexpr std::uint32_t kMostPixels = 8192;  ///< along a side

/// Draws a character, or its skeleton if it has no surface. The camera is fitted to the whole clip and does not move.
/// The model must outlive it.
class PictureMaker {
public:
    /// Throws ViewerError without OpenGL 3.3 or enough memory.
    PictureMaker(const Model& model, const RenderOptions& options, const Warn& warn);
    PictureMaker(const PictureMaker&) = delete;
    PictureMaker& operator=(const PictureMaker&) = delete;
    PictureMaker(PictureMaker&&) = delete;
    PictureMaker& operator=(PictureMaker&&) = delete;
    ~PictureMaker();

    /// Draws with other options from now on; `folders` and the textures stay, which are as large as the first picture
    /// of a surface needs. Faster than another PictureMaker, which compiles all shaders again.
    void change(const RenderOptions& options);
    /// Draws the character at a time of the clip, in seconds.
    Picture draw(float time);
    /// Draws the background alone.
    Picture draw_nothing();
    /// Describes the OpenGL driver.
    [[nodiscard]] const std::string& context() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace bendy::viewer
