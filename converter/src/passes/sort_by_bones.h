#pragma once

#include <bendy/converter/scene.h>

namespace bendy::converter {

/// Puts vertices that follow the same bones beside one another, so that skinning eight neighbours takes few matrices:
/// by the sorted list of their bones, those that follow the same ones in the order in which they were. A rigid mesh,
/// and one whose vertices are in the order of a collapse sequence, stay as they are.
void sort_by_bones(Mesh& mesh);

}  // namespace bendy::converter
