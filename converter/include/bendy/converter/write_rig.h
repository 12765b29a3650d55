#pragma once

#include <bendy/format/document.h>

#include <string>

namespace bendy::converter {

/// The constraints and chains of an object, the roles of its joints, and the markers and curves of its clips, as a rig
/// file (spec/rig.md), marked "complete": convert --rig turns it into the same records, bit for bit. Only ranges that
/// the constraint's model does not use are left out.
/// \param object        passes check_values
/// \param with_markers  also write roles, markers and curves
std::string write_rig(const ObjectView& object, bool with_markers = true);

}  // namespace bendy::converter
