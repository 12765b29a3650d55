#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/pose.h>

namespace BENDY_PUBLIC bendy {

/// Fills Pose::model_space from the local transforms, parents before children. `skin` does it by itself when the pose
/// is stale; call it to read joint matrices without skinning.
void local_to_model(Pose& pose);

}  // namespace bendy
