#pragma once

#include <bendy/converter/scene.h>

// What the joints of a scene are in the body: Scene::roles.
namespace bendy::converter {

/// Finds the roles of a scene that has none: those of its VRM humanoid; otherwise those of a human (find_body), of a
/// four-legged animal, or of a bird. Leaves them empty if the joints do not have the shape of such a body: a wrong role
/// would do more harm than none.
void find_roles(Scene& scene);

}  // namespace bendy::converter
