#pragma once

#include "gltf/further_members.h"
#include "json_text.h"

#include <bendy/converter/report.h>

#include <string>

// What Scene::more and its like say, back in glTF's objects.
namespace bendy::converter::gltf_out {

/// The JSON object of `more`; an empty one, which is said, if it is none.
Json read_members(const std::string& more, const std::string& place, Report& report);

/// Adds the further members of an object: those that the specification does not define and extras, also deeper inside
/// it. What is there already stays; a texture that is not used any more, or an interpreted extension, is not made.
void add_members(Json& object, const Json& more, gltf::Element element, const std::string& place, Report& report);

}  // namespace bendy::converter::gltf_out
