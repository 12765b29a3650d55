#include <bendy/runtime/transform.h>

#include <glm/gtc/matrix_transform.hpp>

namespace bendy {

glm::mat4 to_matrix(const JointTransform& transform, const glm::vec3& shear) {
    const glm::mat3 rotation = glm::mat3_cast(transform.rotation);
    const glm::vec3& scale = transform.scale;
    return {glm::vec4(rotation[0] * scale.x, 0.0f), glm::vec4(rotation[0] * shear.x + rotation[1] * scale.y, 0.0f),
            glm::vec4(rotation[0] * shear.y + rotation[1] * shear.z + rotation[2] * scale.z, 0.0f),
            glm::vec4(transform.translation, 1.0f)};
}

}  // namespace bendy
