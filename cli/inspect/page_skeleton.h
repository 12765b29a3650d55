#pragma once

#include "inspect/describe_rig.h"

#include <bendy/format/document.h>

#include <nlohmann/json.hpp>

namespace bendy::cli {

/// The joints of an object for the page, as columns: parents, names, rest values, places in the rest pose, limits.
nlohmann::ordered_json page_joints(const ObjectView& object);

/// The IK chains of an object for the page: names, texts, links.
nlohmann::ordered_json page_chains(const ObjectView& object, const RigIndex& rigs);

}  // namespace bendy::cli
