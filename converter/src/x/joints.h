#pragma once

#include "x_file.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>

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

}  // namespace bendy::converter::x
