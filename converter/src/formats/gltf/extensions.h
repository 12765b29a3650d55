#pragma once

#include "check_json.h"

#include <bendy/converter/report.h>

#include <string_view>

namespace bendy::converter::gltf {

/// A node that draws its mesh several times: kept as data, or made joints (GltfOptions::instances).
inline constexpr std::string_view kInstancing = "EXT_mesh_gpu_instancing";

/// Our own, of nodes and of the root: the joints' limits and roles, IK chains, and the pose in which the body stands
/// (spec/gltf.md).
inline constexpr std::string_view kJointLimits = "BENDY_joint_limits";
inline constexpr std::string_view kJointRole = "BENDY_joint_role";
inline constexpr std::string_view kIkChains = "BENDY_ik_chains";
inline constexpr std::string_view kStandingPose = "BENDY_standing_pose";

/// A motion without a character: what bones and expressions its nodes are.
inline constexpr std::string_view kVrmAnimation = "VRMC_vrm_animation";

/// Whether a file that requires this extension can be imported: it is decoded, or cannot affect shape or motion.
bool is_known_extension(std::string_view name);

/// Whether a material extension maps to fields of Material; others are kept there as JSON.
bool is_interpreted_material_extension(std::string_view name);

/// Whether tools/viewer draws everything that a material extension says. It is kept as JSON all the same.
bool is_drawn_material_extension(std::string_view name, const Json& extension);

/// Warns of all extensions in the file that the Scene cannot hold: by name, each with its count.
void report_extensions(const Json& root, Report& report);

}  // namespace bendy::converter::gltf
