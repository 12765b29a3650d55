#pragma once

// What an embedding program needs, in the order in which it needs it:
//
//     auto model = bendy::Model::open("fox.bendy");                    // maps and checks the file
//     bendy::Pose pose(*model);                                        // all the memory that posing needs
//     if (!bendy::sample(pose, model->clip("Run"), seconds)) ...      // joints and morph target weights at a time
//     if (!bendy::blend(pose, other, 0.5f)) ...                        // half of another pose of the model
//     if (!bendy::reach(pose, model->chain("LeftArm"), target)) ...    // IK, inside the joints' constraints
//     if (!bendy::skin(pose, {.out = {.positions = positions}})) ...   // vertices into the caller's memory
//
// Over time: Playback (a clip's clock), Crossfade, markers.h, curve.h (named curves), RootPath (root motion), Binding
// (clips of another file). Of a pose: Bounds, Socket.
//
// Parameters have one order: what the call acts on, what it is given, options, outputs. A function that can fail
// returns a Result, which must be checked: with an Error if a file is at fault, with a CallError if an argument is.
//
// Nothing here throws or logs. A frame allocates nothing: what needs memory takes it when it is made. After a Model has
// loaded, no call on it can read or write out of bounds, whatever the file held. A Model is immutable: any number of
// threads may share it, a Pose each. Whatever is made from a Model shares what it holds, so a Model may be moved.

#include <bendy/runtime/binding.h>
#include <bendy/runtime/blend.h>
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
#include <bendy/runtime/root_motion.h>
#include <bendy/runtime/sample.h>
#include <bendy/runtime/skin.h>
#include <bendy/runtime/socket.h>
