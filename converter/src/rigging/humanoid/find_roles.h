#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

// Finds which joint is which part of the body: Scene::roles. A converter without BENDY_AUTO_RIG finds none.
namespace bendy::converter {

/// Finds the roles of a scene that has none: those of its VRM humanoid; otherwise those of a human (find_body), of a
/// four-legged animal, or of a bird. Finds none if the joints do not have the shape of such a body: a wrong role does
/// more harm than a missing one.
///
/// If a scene has several characters, one of them gets the roles, and a warning names all.
/// \param hips  those of the character that gets the roles, even if another one has some; kNone: the character that
///              has roles, or else the first
#ifdef BENDY_AUTO_RIG
void find_roles(Scene& scene, std::uint32_t hips, Report& report);
#else
inline void find_roles(Scene& /*scene*/, std::uint32_t /*hips*/, Report& /*report*/) {}
#endif

/// Warns if the scene has roles other than find_roles would find: an X-file has no place for them.
inline void warn_of_lost_roles(Scene& scene, Report& report) {
    if (scene.roles.empty()) return;
    std::vector<RoleRecord> kept = std::exchange(scene.roles, {});
    Report unheard;
    find_roles(scene, kNone, unheard);
    const bool are_found = std::equal(kept.begin(), kept.end(), scene.roles.begin(), scene.roles.end(),
                                      [](const RoleRecord& a, const RoleRecord& b) {
                                          return a.joint == b.joint && a.role == b.role && a.place == b.place;
                                      });
    scene.roles = std::move(kept);
    if (are_found) return;
    report.warn("roles of joints left out: an X-file has no place for them (`bendy rig` writes them to a rig file)");
}

}  // namespace bendy::converter
