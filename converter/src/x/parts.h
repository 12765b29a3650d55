#pragma once

#include "source/source_file.h"
#include "x_file.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>

// The parts of an import, in the order in which import_x calls them.

namespace bendy::converter::x {

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
void import_materials(const XFile& source, const std::filesystem::path& file, bool embed_images, Scene& scene,
                      Report& report);

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
