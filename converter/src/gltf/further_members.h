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

/// Gathers what is left out, and says each kind of it in one warning: which, at least the first of them, and how many.
class Losses {
public:
    /// `kind` in the plural, as `meshes that no node draws`; `which` one line, as `'helmet'` or `meshes[3]`.
    void add(const std::string& kind, std::string which, const std::string& place);
    void report(Report& report) const;

private:
    struct Kind {
        std::string name;
        std::vector<std::string> shown;
        std::string first_place;
        std::uint64_t count = 0;
    };
    std::vector<Kind> kinds_;                     ///< in the order in which they came
    std::map<std::string, std::size_t> kind_of_;  ///< by name, into kinds_
};

// Members of glTF's objects that the Scene has no field for: extras and names in places where it holds none, and
// members that the specification does not define.

/// The kinds of objects of glTF 2.0.
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
};

/// What `object` says beside the members that the Scene holds, in the shape of the object; empty object: nothing.
/// Extensions of the object itself are not looked at, but for members that an interpreted one does not define.
Json further_members(const Json& object, Element element);

/// Adds all that further_members gives of an object to what is left out: `nouns` as `accessors`.
void lose_members(const Json& object, Element element, std::string_view nouns, const std::string& place,
                  Losses& losses);

/// How a message calls an element of an array of the root: its name, or `nodes[3]`.
std::string call(const Json& element, std::string_view array, std::size_t index);

}  // namespace bendy::converter::gltf
