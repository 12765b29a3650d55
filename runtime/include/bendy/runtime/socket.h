#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/pose.h>

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <string_view>

namespace BENDY_PUBLIC bendy {

/// A place on a character for what is not part of it: a hand that holds a sword, a camera behind a head.
struct Socket {
    std::uint32_t joint = kNone;  ///< kNone: the model's own space
    glm::mat4 offset{1.0f};       ///< from the socket to the joint's space
    /// What hangs there keeps its size though joints are scaled: skeletons in centimetres are scaled by 0.01 somewhere.
    bool keeps_size = true;
};

/// At the first joint of that name; in the model's own space if there is none, which Socket::joint says.
[[nodiscard]] Socket make_socket(const Model& model, std::string_view joint, const glm::mat4& offset = glm::mat4(1.0f));

/// Socket space to world: world = model_to_world * joint * offset. With keeps_size the joint's axes are made unit, at
/// right angles and right-handed first; an axis without length is replaced.
[[nodiscard]] glm::mat4 socket_matrix(Pose& pose, const Socket& socket,
                                      const glm::mat4& model_to_world = glm::mat4(1.0f));

}  // namespace bendy
