#pragma once

#include "find_humanoid.h"
#include "limb_chains.h"
#include "rest_frames.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

struct ProposedLimit {
    std::uint32_t joint = 0;
    LimitRecord limit;
    /// Of an elbow or knee: the hinge with the little that such a joint turns about other axes, where rigs have no
    /// joint for it.
    std::optional<LimitRecord> looser = std::nullopt;
    bool is_widened = false;  ///< by fit_to_clips
};

/// Limits of a human's joints, turned to this character's rest pose; flagged kProposed. Hinges for elbows, knees and
/// toes, swing and twist for the others; spec/rig.md has the ranges. The rest pose is inside. Where the rest pose lies
/// more than 10 degrees outside what a human can do there is no limit, and a warning.
std::vector<ProposedLimit> propose_limits(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found,
                                          const Stance& stance, Report& report);

}  // namespace bendy::converter
