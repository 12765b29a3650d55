#pragma once

#include <bendy/converter/scene.h>

#include <functional>
#include <vector>

namespace bendy::converter {

/// Calls visit(locals) with the pose, by joint relative to its parent, of frames of all clips: a few of each, spread
/// over it, and not more than a reader waits for.
void visit_frames(const Scene& scene, const std::function<void(std::vector<Transform>)>& visit);

}  // namespace bendy::converter
