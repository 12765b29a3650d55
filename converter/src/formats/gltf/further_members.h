#pragma once

#include "check_json.h"

#include <bendy/converter/report.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter::gltf {

/// Collects losses, and reports each kind in one warning: the first few of them, and how many there are.
class Losses {
public:
    /// \param kind   plural, as `meshes that no node draws`
    /// \param which  one line, as `'helmet'` or `meshes[3]`
    void add(const std::string& kind, std::string which, const std::string& place);
    void report(Report& report) const;

private:
    struct Kind {
        std::string name;
        std::vector<std::string> shown;
        std::string first_place;
        std::uint64_t count = 0;
    };
    std::vector<Kind> kinds_;                     ///< in order of occurrence
    std::map<std::string, std::size_t> kind_of_;  ///< by name, into kinds_
};

// Members of glTF's objects without a field in the Scene: extras and names of objects for which it holds none, and
// members that the specification does not define.

/// The object types of glTF 2.0, which have further members in 2.1, a draft.
enum class Element : std::uint8_t {
    root,
    scene,
    node,
    material,
    texture,
    image,
    sampler,
    skin,
    camera,
    mesh,
    primitive,
    animation,
    channel,
    animation_sampler,
    accessor,
    buffer_view,
    buffer,
    asset,
};

/// The members of `object` that the Scene does not hold, in the object's structure; an empty object if there are none.
/// The object's extensions are skipped, except for members that an interpreted extension does not define.
Json further_members(const Json& object, Element element);

/// The names of the members that the specification of 2.0 defines for an object, separated by spaces.
std::string_view known_members(Element element);

/// Removes the members that only glTF 2.1 has from an object, and returns their names.
std::vector<std::string> take_drafts(Json& object, Element element);

/// Adds the result of further_members to the losses: `nouns` as `accessors`.
void lose_members(const Json& object, Element element, std::string_view nouns, const std::string& place,
                  Losses& losses);

/// The name of an element of a root array for messages: its own name, or `nodes[3]`.
std::string call(const Json& element, std::string_view array, std::size_t index);

}  // namespace bendy::converter::gltf
