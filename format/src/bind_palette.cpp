#include <bendy/format/bind_palette.h>

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/matrix_double4x4.hpp>
#include <glm/matrix.hpp>

namespace bendy {
namespace {

/// T R U, see spec/tree.md.
glm::dmat4 local_matrix(const RestRecord& rest) {
    const double x = rest.rotation[0];
    const double y = rest.rotation[1];
    const double z = rest.rotation[2];
    const double w = rest.rotation[3];
    const glm::dmat3 rotation(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w),
                              2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w),
                              2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y));
    const glm::dmat3 upper(rest.scale[0], 0.0, 0.0, rest.shear[0], rest.scale[1], 0.0, rest.shear[1], rest.shear[2],
                           rest.scale[2]);
    glm::dmat4 matrix(rotation * upper);
    matrix[3] = glm::dvec4(rest.translation[0], rest.translation[1], rest.translation[2], 1.0);
    return matrix;
}

}  // namespace

std::vector<glm::dmat4> rest_matrices(std::span<const RestRecord> rests, std::span<const std::uint32_t> parents) {
    std::vector<glm::dmat4> matrices(rests.size());
    for (std::size_t joint = 0; joint < rests.size(); ++joint) {
        const glm::dmat4 local = local_matrix(rests[joint]);
        matrices[joint] = parents[joint] == kNone ? local : matrices[parents[joint]] * local;
    }
    return matrices;
}

glm::mat4 derive_inverse_bind(const glm::dmat4& rest, const glm::mat4& base) {
    // The matrices are affine: invert the linear part by cofactors, and apply it to the negated translation.
    const glm::dmat3 inverse = glm::inverse(glm::dmat3(rest));
    glm::dmat4 whole(inverse);
    whole[3] = glm::dvec4(-(inverse * glm::dvec3(rest[3])), 1.0);
    const glm::mat4 derived(whole * glm::dmat4(base));
    return derived;
}

}  // namespace bendy
