#include "too_deep.h"

#include <bendy/extensions/rename_materials.h>

#include <bendy/json/json.h>

namespace bendy::extensions {
namespace {

using Names = std::map<std::string, std::string, std::less<>>;

/// Calls visit(element) for the elements of a list that an object may have.
template <class Visit>
void for_each(Json& object, const char* list, const Visit& visit) {
    const auto found = object.is_object() ? object.find(list) : object.end();
    if (!object.is_object() || found == object.end() || !found->is_array()) return;
    for (Json& element : *found) visit(element);
}

class Renamer {
public:
    explicit Renamer(const Names& names) : names_(names) {}

    void rename(Json& object, const char* member) {
        const auto found = object.is_object() ? object.find(member) : object.end();
        if (!object.is_object() || found == object.end() || !found->is_string()) return;
        const auto name = names_.find(found->text());
        if (name == names_.end()) return;
        *found = name->second;
        has_changed_ = true;
    }

    [[nodiscard]] bool has_changed() const { return has_changed_; }

private:
    const Names& names_;
    bool has_changed_ = false;
};

}  // namespace

std::optional<std::string> rename_materials(std::string_view json, const Names& names) {
    if (names.empty() || is_too_deep(json)) return std::nullopt;
    Json all = Json::parse(json).value_or(Json());
    const auto vrm = all.is_object() ? all.find("VRM") : all.end();
    if (!all.is_object() || vrm == all.end() || !vrm->is_object()) return std::nullopt;
    Renamer renamer(names);
    for_each(*vrm, "materialProperties", [&](Json& properties) { renamer.rename(properties, "name"); });
    if (const auto expressions = vrm->find("blendShapeMaster"); expressions != vrm->end()) {
        for_each(*expressions, "blendShapeGroups", [&](Json& group) {
            for_each(group, "materialValues", [&](Json& value) { renamer.rename(value, "materialName"); });
        });
    }
    return renamer.has_changed() ? std::optional(all.dump()) : std::nullopt;
}

}  // namespace bendy::extensions
