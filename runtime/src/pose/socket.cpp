#include <bendy/runtime/socket.h>

#include "math/rigid_part.h"

namespace bendy {

Socket make_socket(const Model& model, std::string_view joint, const glm::mat4& offset) {
    Socket socket;
    socket.joint = model.joint(joint);
    socket.offset = offset;
    return socket;
}

Result<glm::mat4, CallError> socket_matrix(Pose& pose, const Socket& socket, const glm::mat4& model_to_world) {
    glm::dmat4 joint(1.0);
    if (socket.joint != kNone) {
        if (socket.joint >= pose.model().joints().size()) return CallError::out_of_range;
        joint = glm::dmat4(pose.model_space()[socket.joint]);
        if (socket.keeps_size) joint = rigid_part(joint);
    }
    return glm::mat4(glm::dmat4(model_to_world) * joint * glm::dmat4(socket.offset));
}

}  // namespace bendy
