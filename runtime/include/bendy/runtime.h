#pragma once

// The header for embedding programs. Typical use, in order:
//
//     auto model = bendy::Model::open("fox.bendy");                    // maps and checks the file
//     bendy::Pose pose(*model);                                        // allocates all memory that posing needs
//     if (!bendy::sample(pose, model->clip("Run"), seconds)) ...       // joints and morph target weights at a time
//     if (!bendy::blend(pose, other, 0.5f)) ...                        // half of another pose of the model
//     if (!bendy::reach(pose, model->chain("LeftArm"), target)) ...    // IK, within the joints' constraints
//     if (!bendy::skin(pose, {.out = {.positions = positions}})) ...   // vertices into the caller's memory
//
// For playback over time: Playback (the clock of a clip), Crossfade, markers.h, curve.h (named curves), RootPath (root
// motion), Binding (clips of another file). Derived from a pose: Bounds, Socket.
//
// Parameter order: the object that the call acts on, inputs, options, outputs. A function that can fail returns a
// Result, which must be checked: with an Error for a fault in a file, with a CallError for a bad argument.
//
// Nothing here throws or logs. No memory is allocated per frame: objects allocate what they need when they are
// made. Once a Model has loaded, no call on it reads or writes out of bounds, whatever the file contained. A Model is
// immutable: any number of threads may share it, with a Pose each. Objects made from a Model share its data, so the
// Model may be moved.

// Nothing is declared for an older language: this one error instead of hundreds.
#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) <= 201703L
#error "bendy needs C++20: compile with -std=c++20 (Visual C++: /std:c++20)"
#else

#include <bendy/runtime/binding.h>
#include <bendy/runtime/blend.h>
#include <bendy/runtime/body_reach.h>
#include <bendy/runtime/bounds.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/constrain.h>
#include <bendy/runtime/crossfade.h>
#include <bendy/runtime/crowd.h>
#include <bendy/runtime/curve.h>
#include <bendy/runtime/ik.h>
#include <bendy/runtime/kernels.h>
#include <bendy/runtime/lod.h>
#include <bendy/runtime/markers.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/morph_targets.h>
#include <bendy/runtime/playback.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/reach_state.h>
#include <bendy/runtime/retarget.h>
#include <bendy/runtime/root_motion.h>
#include <bendy/runtime/sample.h>
#include <bendy/runtime/skin.h>
#include <bendy/runtime/socket.h>
#include <bendy/runtime/turn.h>

#endif
