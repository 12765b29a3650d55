#include "frames.h"

#include "failure.h"
#include "mesh.h"
#include "rig.h"
#include "x/mirror.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include <array>
#include <vector>

namespace bendy::converter::x_out {
namespace {

/// T * R * U (see Transform) in double, mirrored; R from a quaternion that is unit to the last bit of a double, so that
/// a reader who takes the matrix apart finds the scale that was put in.
std::array<double, 16> matrix_of(const Transform& rest) {
    const glm::dvec4 q(rest.rotation);
    const glm::dmat3 turn = glm::mat3_cast(glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)));
    const glm::dvec3 scale(rest.scale);
    const glm::dvec3 shear(rest.shear);
    const glm::dmat3 upper({scale.x, 0.0, 0.0}, {shear.x, scale.y, 0.0}, {shear.y, shear.z, scale.z});
    const glm::dmat3 linear = turn * upper;
    std::array<double, 16> matrix{};
    for (std::size_t column = 0; column < 3; ++column) {
        const auto axis = static_cast<int>(column);
        for (std::size_t row = 0; row < 3; ++row) matrix[4 * column + row] = linear[axis][static_cast<int>(row)];
        matrix[12 + column] = double{rest.translation[axis]};
    }
    matrix[15] = 1.0;
    return x::mirrored(matrix);
}

}  // namespace

void write_frames(const Scene& scene, const Names& names, Text& text, Report& report) {
    std::vector<std::vector<std::uint32_t>> meshes_of(scene.joints.size());
    std::vector<std::uint32_t> free_meshes;
    for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        const std::uint32_t joint = scene.meshes[mesh].joint;
        (joint == kNone ? free_meshes : meshes_of[joint]).push_back(mesh);
    }
    std::vector<std::uint32_t> open;
    for (std::uint32_t number = 0; number < scene.joints.size(); ++number) {
        const Joint& joint = scene.joints[number];
        for (; !open.empty() && open.back() != joint.parent; open.pop_back()) text.close();
        open.push_back(number);
        text.open("Frame", names.joints[number]);
        text.open("FrameTransformMatrix");
        text.matrix(matrix_of(joint.rest));
        text.close();
        write_name(names.joints[number], joint.name, text);
        write_constraints(joint, text);
        for (const std::uint32_t mesh : meshes_of[number]) write_mesh(scene, mesh, names, text, report);
        if (!joint.extras.empty() || !joint.extensions.empty() || !joint.more.empty())
            report.warn("extras or extensions of a joint left out: X-files have no place for it", at("joints", number));
    }
    for (; !open.empty(); open.pop_back()) text.close();
    for (const std::uint32_t mesh : free_meshes) write_mesh(scene, mesh, names, text, report);
}

}  // namespace bendy::converter::x_out
