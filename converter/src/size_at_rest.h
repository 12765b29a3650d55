#pragma once

#include <bendy/converter/scene.h>

namespace bendy::converter {

/// How far from a joint, as a share of the character's height, its turning and stretching are measured where no skin
/// shows them.
constexpr double kJointReach = 0.03;

/// Metres: the height of the character's skin at rest; the largest side of what is flat. Of a scene without a vertex
/// the size of its skeleton: of its joints' origins at rest or, where these lie at one point, over its clips; 1 for one
/// whose joints never leave that point.
double height_at_rest(const Scene& scene);

}  // namespace bendy::converter
