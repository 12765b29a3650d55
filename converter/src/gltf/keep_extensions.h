#pragma once

#include "document.h"
#include "skeleton.h"

#include <bendy/converter/scene.h>

namespace bendy::converter::gltf {

/// Keeps the extensions of the root and of the nodes that became joints, as JSON, in Scene::extensions and
/// Joint::extensions. Where an extension is known to hold node numbers they become joint numbers; null stands for a
/// node that has no joint, with a warning. What is only kept is named in the report.
void keep_extensions(const Document& document, const Skeleton& skeleton, Scene& scene);

}  // namespace bendy::converter::gltf
