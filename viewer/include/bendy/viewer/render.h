#pragma once

#include <bendy/runtime/model.h>
#include <bendy/runtime/pose.h>
#include <bendy/viewer/picture.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Pictures of a character, without a display.
namespace bendy::viewer {

/// Takes a line about something that cannot be shown as it should be.
using Warn = std::function<void(const std::string& what)>;

/// What is drawn, and how.
struct DrawOptions {
    bool surface = true;  ///< the character itself
    bool wireframe = false;
    bool bones = false;
    bool axes = false;  ///< the joints' axes: X red, Y green, Z blue
    bool constraints = false;
    bool targets = false;                              ///< what the IK chains are to reach
    std::uint32_t marked_joint = kNone;                ///< drawn so that it stands out, with its axes
    glm::vec4 background{0.086f, 0.1f, 0.122f, 1.0f};  ///< linear; alpha 0: transparent
};

struct CameraOptions {
    float yaw = 0.6f;       ///< radians about Y; 0 looks along -Z, at the front of a character that faces +Z
    float pitch = 0.2f;     ///< radians, over the horizon
    float distance = 1.0f;  ///< 1: the character fills the picture
};

/// A point that an IK chain was to reach: drawn, with a line from the chain's tip, and always in the picture.
struct DrawnTarget {
    const Chain* chain = nullptr;  ///< of the model
    glm::vec3 position{0.0f};      ///< metres, model space
};

struct RenderOptions {
    std::uint32_t width = 1024;  ///< pixels, 1 to kMostPixels
    std::uint32_t height = 768;  ///< likewise
    const Clip* clip = nullptr;  ///< null: the rest pose
    float lod = 1.0f;            ///< share of the triangles
    CameraOptions camera;
    DrawOptions draw;
    std::filesystem::path folder;  ///< of images that the file only names
    /// Changes every pose after the clip: limits, IK. May be empty.
    std::function<void(Pose&)> adjust;
    std::vector<DrawnTarget> targets;
};

/// The file that an image's URI names inside `folder`, where pictures are drawn from; nothing for what leads elsewhere.
std::optional<std::filesystem::path> linked_file(const std::filesystem::path& folder, std::string_view uri);

inline constexpr std::uint32_t kMostPixels = 8192;  ///< along a side

/// Draws one character, or the skeleton of one without a surface; the camera is fitted to the whole clip and stays.
/// The model must outlive it.
class PictureMaker {
public:
    /// Throws ViewerError if there is no OpenGL 3.3 or too little memory.
    PictureMaker(const Model& model, const RenderOptions& options, const Warn& warn);
    PictureMaker(const PictureMaker&) = delete;
    PictureMaker& operator=(const PictureMaker&) = delete;
    PictureMaker(PictureMaker&&) = delete;
    PictureMaker& operator=(PictureMaker&&) = delete;
    ~PictureMaker();

    /// The character at a time of the clip, seconds.
    Picture draw(float time);
    /// The background alone.
    Picture draw_nothing();
    /// Which OpenGL draws.
    [[nodiscard]] const std::string& context() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace bendy::viewer
