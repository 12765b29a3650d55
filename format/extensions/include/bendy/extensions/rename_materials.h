#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace bendy::extensions {

/// Puts new names of materials into the extensions of HEAD that say names: VRM 0.x, in materialProperties and in the
/// materialValues of expressions. \param json  an object of extensions by name. \param names  the new names by the old
/// ones. Returns the new text, or nothing if no name has changed
std::optional<std::string> rename_materials(std::string_view json,
                                            const std::map<std::string, std::string, std::less<>>& names);

}  // namespace bendy::extensions
