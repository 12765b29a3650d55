#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

namespace bendy::converter {

/// Warns of joints of a human between two of a limb that have roles, which have none although the clips swing them,
/// where one of the two hardly moves: its role is theirs. What only twists is a part of the bone, and a leg of three
/// bones that all move has no third role to give.
#ifdef BENDY_AUTO_RIG
void warn_of_missing_roles(const Scene& scene, Report& report);
#else
inline void warn_of_missing_roles(const Scene& /*scene*/, Report& /*report*/) {}
#endif

}  // namespace bendy::converter
