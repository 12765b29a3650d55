#pragma once

#include <bendy/format/document.h>

#include <string>

namespace bendy::converter {

/// The constraints and chains of an object, and the markers and curves of its clips, as a rig file (spec/rig.md),
/// "complete": convert --rig makes the same records of it, to the bit. Only ranges that a constraint's model has no use
/// for are left out. \param object  passes check_values \param with_markers  and with curves
std::string write_rig(const ObjectView& object, bool with_markers = true);

}  // namespace bendy::converter
