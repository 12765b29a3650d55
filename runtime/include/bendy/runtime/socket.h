#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/pose.h>

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <string_view>

namespace BENDY_PUBLIC bendy {

/// An attachment point on a character: a hand that holds a sword, a camera behind a head.
struct Socket {
    std::uint32_t joint = kNone;  ///< kNone: the model's own space
    glm::mat4 offset{1.0f};       ///< socket space to joint space
    /// Attached objects keep their size if joints are scaled: skeletons in centimetres contain a scale of 0.01
    /// somewhere.
    bool keeps_size = true;
};

/// Makes a socket at the first joint with that name. If there is none, Socket::joint is kNone: the model's own space.
[[nodiscard]] Socket make_socket(const Model& model, std::string_view joint, const glm::mat4& offset = glm::mat4(1.0f));

/// Returns the matrix from socket space to world space: world = model_to_world * joint * offset. With keeps_size the
/// joint's axes are first made orthonormal and right-handed; an axis of zero length is replaced. Error: out_of_range,
/// if the pose's model has no joint with that number. A socket of another model is recognised by nothing else.
[[nodiscard]] Result<glm::mat4, CallError> socket_matrix(Pose& pose, const Socket& socket,
                                                         const glm::mat4& model_to_world = glm::mat4(1.0f));

}  // namespace bendy
