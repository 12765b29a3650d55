#include <bendy/runtime/transform.h>

namespace bendy {

glm::dmat4 to_matrix(const JointTransform& transform, const glm::vec3& shear) {
    const glm::dmat3 rotation = glm::mat3_cast(glm::dquat(transform.rotation));
    const glm::dvec3 scale(transform.scale);
    const glm::dvec3 above(shear);
    return {glm::dvec4(rotation[0] * scale.x, 0.0), glm::dvec4(rotation[0] * above.x + rotation[1] * scale.y, 0.0),
            glm::dvec4(rotation[0] * above.y + rotation[1] * above.z + rotation[2] * scale.z, 0.0),
            glm::dvec4(glm::dvec3(transform.translation), 1.0)};
}

}  // namespace bendy
