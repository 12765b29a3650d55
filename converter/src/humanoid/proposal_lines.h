#pragma once

#include "fit_to_clips.h"
#include "limb_chains.h"

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace bendy::converter {

/// The joint's name; its number where it has none.
std::string name_of(const Scene& scene, std::uint32_t joint);

/// Which way a limb's middle joint points, and how many clips say so; 0: the rest pose, or a human's way.
struct ProposedBend {
    glm::dvec3 way{0.0};  ///< in model space at rest
    std::uint32_t clips = 0;
};

/// What was proposed, for people: one line.
std::string line_of(const Scene& scene, const Chain& chain, const std::optional<ProposedBend>& bend,
                    const Stance& stance);
std::string line_of(const Scene& scene, const ProposedLimit& proposed);

}  // namespace bendy::converter
