#pragma once

#include <bendy/runtime.h>

namespace bendy::fuzz {

/// Does all that a game does with a model: reads every view, plays every clip at sensible and senseless times, blends,
/// constrains, reaches with every solver, skins whole and in levels of detail.
/// \param choice  any number: which kernel does the arithmetic, and which of the times
void use_model(const Model& model, unsigned choice);

}  // namespace bendy::fuzz
