#pragma once

// What an embedding program needs, in the order in which it needs it:
//
//     auto model = bendy::Model::open("fox.bendy");           // maps and checks the file
//     bendy::Pose pose(*model);                               // all the memory that posing needs
//     bendy::sample(model->cycle("Run"), seconds, pose);      // joints and target weights at a time
//     bendy::blend(pose, other, 0.5f);                        // half of another pose of the model
//     bendy::reach(model->chain("LeftArm"), target, pose);    // IK, inside the joints' constraints
//     bendy::skin(*model, pose, vertices);                    // vertices into the caller's memory
//
// What plays over time: Playback (a cycle's clock), Crossfade, markers.h, curve.h (named curves), RootPath (root
// motion), Binding (cycles of another file). What a posed character is asked: Bounds, Socket. DualSkinning: skinning
// that keeps volume.
//
// Nothing here throws or logs. A frame allocates nothing: what needs memory takes it when it is made. After a Model has
// loaded, no call on it can read or write out of bounds, whatever the file held. A Model is immutable: any number of
// threads may share it, a Pose each.

#include <bendy/runtime/binding.h>
#include <bendy/runtime/blend.h>
#include <bendy/runtime/bounds.h>
#include <bendy/runtime/constrain.h>
#include <bendy/runtime/crossfade.h>
#include <bendy/runtime/crowd.h>
#include <bendy/runtime/curve.h>
#include <bendy/runtime/dual_skin.h>
#include <bendy/runtime/ik.h>
#include <bendy/runtime/inbetween.h>
#include <bendy/runtime/local_to_model.h>
#include <bendy/runtime/lod.h>
#include <bendy/runtime/markers.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/playback.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/root_motion.h>
#include <bendy/runtime/sample.h>
#include <bendy/runtime/skin.h>
#include <bendy/runtime/socket.h>
