#include "too_deep.h"

#include <bendy/extensions/renumber_extensions.h>
#include <bendy/json/json.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>

namespace bendy::extensions {
namespace {

/// How much to remove together with a number.
enum class Gone : std::uint8_t { entry, entry_or_list, member, all, minus_one };

struct Reference {
    std::string_view extension;
    Host host = Host::root;
    std::string_view path;
    Thing thing = Thing::joint;
    std::string_view beside;
    Gone gone = Gone::entry;
};

constexpr std::array kReferences{
#define BENDY_REFERENCE(extension, host, path, thing, beside, gone) \
    Reference{extension, Host::host, path, Thing::thing, beside, Gone::gone},
#include <bendy/extensions/references.def>
};

/// Extensions whose numbers are quantities, or indices within the extension itself.
constexpr std::array<std::string_view, 9> kWithoutReferences{
    "AGI_articulations",      "AGI_stk_metadata",      "EXT_mesh_gpu_instancing",
    "KHR_lights_punctual",    "KHR_node_visibility",   "KHR_node_hoverability",
    "KHR_node_selectability", "KHR_texture_transform", "KHR_xmp_json_ld"};
/// Material extensions: their numbers are factors and texture infos.
constexpr std::array<std::string_view, 2> kMaterials{"KHR_materials_", "VRMC_materials_"};

/// Returns a whole number that can be the index of a thing.
std::optional<std::uint32_t> number_in(const Json& value) {
    if (!value.is_number()) return std::nullopt;
    const auto number = value.get<double>();
    if (!(number >= 0.0 && number < 4294967295.0)) return std::nullopt;
    const auto whole = static_cast<std::uint32_t>(number);
    return static_cast<double>(whole) == number ? std::optional(whole) : std::nullopt;
}

bool is_minus_one(const Json& value) {
    return value.is_number() && value.get<double>() == -1.0;
}

// NOLINTNEXTLINE(misc-no-recursion): the nesting is bounded
bool has_whole_number(const Json& value) {
    if (!value.is_structured()) return number_in(value).has_value();
    for (const Json& each : value) {
        if (has_whole_number(each)) return true;
    }
    return false;
}

/// Renumbers one extension.
class Renumberer {
public:
    Renumberer(Host host, const NewNumber& now, Renumbered& told) : host_(host), now_(now), told_(told) {}

    /// Returns false if the extension itself is removed.
    bool renumber(const std::string& name, Json& extension) {
        lists_.clear();
        place_ = name;
        for (const Reference& reference : kReferences) {
            if (reference.extension != name || reference.host != host_) continue;
            reference_ = &reference;
            if (walk(extension, reference.path, {}) != Fate::stays) return false;
        }
        if (host_ == Host::material) renumber_textures(extension);
        return true;
    }

    [[nodiscard]] bool has_changed() const { return has_changed_; }

private:
    /// The consequence for a value of the numbers found in it.
    enum class Fate : std::uint8_t { stays, member_goes, entry_goes, all_goes };

    // NOLINTNEXTLINE(misc-no-recursion): as deep as the path is long
    Fate walk(Json& value, std::string_view path, std::string_view way) {
        if (path.empty()) return replace(value, 0);
        if (path.starts_with("[]")) return walk_array(value, path.substr(2), way);
        if (path.starts_with("{}")) return walk_members(value, path.substr(2));
        if (path.front() == '.') path.remove_prefix(1);
        const std::size_t end = std::min(path.find_first_of(".[{"), path.size());
        const std::string name(path.substr(0, end));
        const auto member = value.is_object() ? value.find(name) : value.end();
        if (!value.is_object() || member == value.end()) return Fate::stays;
        const std::size_t length = place_.size();
        place_ += '.' + name;
        const std::string_view whole = reference_->path;
        const auto at = static_cast<std::size_t>(path.data() - whole.data()) + end;
        const Fate fate = end == path.size() ? replace(*member, owner_of(value))
                                             : walk(*member, path.substr(end), whole.substr(0, at));
        place_.resize(length);
        if (fate != Fate::member_goes) return fate;
        value.erase(name);
        return Fate::stays;
    }

    /// \param way  the path of the array
    // NOLINTNEXTLINE(misc-no-recursion): as deep as the path is long
    Fate walk_array(Json& array, std::string_view rest, std::string_view way) {
        if (!array.is_array()) return Fate::stays;
        const std::size_t length = place_.size();
        std::vector<std::uint32_t> numbers;  // the new number of each element
        Json stay = Json::array();
        for (std::size_t i = 0; i < array.size(); ++i) {
            place_ += '[' + std::to_string(i) + ']';
            const bool is_row = rest.empty() && reference_->thing == Thing::rows_of_materials;
            const Fate fate = is_row ? row_of_material(i) : walk(array[i], rest, {});
            place_.resize(length);
            if (fate == Fate::all_goes) return fate;
            numbers.push_back(fate == Fate::stays ? static_cast<std::uint32_t>(stay.size()) : kGone);
            if (fate == Fate::stays) stay.push_back(std::move(array[i]));
        }
        const bool is_innermost = rest.find_first_of("[{") == std::string_view::npos;
        const bool is_emptied = is_innermost && stay.empty() && !array.empty();
        array = std::move(stay);
        lists_[std::string(way)] = std::move(numbers);
        return is_emptied && reference_->gone == Gone::entry_or_list ? Fate::entry_goes : Fate::stays;
    }

    // NOLINTNEXTLINE(misc-no-recursion): as deep as the path is long
    Fate walk_members(Json& object, std::string_view rest) {
        if (!object.is_object()) return Fate::stays;
        const std::size_t length = place_.size();
        std::vector<std::string> gone;
        for (auto member = object.begin(); member != object.end(); ++member) {
            place_ += '.' + member.key();
            const Fate fate = walk(member.value(), rest, {});
            place_.resize(length);
            if (fate == Fate::all_goes) return fate;
            if (fate != Fate::stays) gone.push_back(member.key());
        }
        object.erase_members(gone);
        return Fate::stays;
    }

    [[nodiscard]] std::uint32_t owner_of(const Json& object) const {
        const bool is_target =
            reference_->thing == Thing::target_of_joint || reference_->thing == Thing::target_of_mesh;
        const auto owner = is_target ? object.find(std::string(reference_->beside)) : object.end();
        return owner == object.end() ? kGone : number_in(*owner).value_or(kGone);
    }

    Fate row_of_material(std::size_t row) {
        if (now_(Thing::material, static_cast<std::uint32_t>(row), 0)) return Fate::stays;
        has_changed_ = true;
        return Fate::entry_goes;
    }

    [[nodiscard]] std::optional<std::uint32_t> new_number(std::uint32_t number, std::uint32_t owner) const {
        if (reference_->thing != Thing::element) return now_(reference_->thing, number, owner);
        const auto list = lists_.find(std::string(reference_->beside));
        if (list == lists_.end()) return number;  // nothing can be removed from the array
        if (number >= list->second.size() || list->second[number] == kGone) return std::nullopt;
        return list->second[number];
    }

    Fate replace(Json& value, std::uint32_t owner) {
        if (is_minus_one(value)) return Fate::stays;  // VRM 0.x: none
        const auto before = number_in(value);
        const auto after = before ? new_number(*before, owner) : std::nullopt;
        if (after) {
            has_changed_ = has_changed_ || *after != *before;
            value = *after;
            return Fate::stays;
        }
        has_changed_ = true;
        told_.gone.push_back(place_);
        switch (reference_->gone) {
            case Gone::member:
                return Fate::member_goes;
            case Gone::all:
                return Fate::all_goes;
            case Gone::minus_one:
                value = -1;
                return Fate::stays;
            default:
                return Fate::entry_goes;
        }
    }

    // NOLINTNEXTLINE(misc-no-recursion): the nesting is bounded
    void renumber_textures(Json& value) {
        const std::size_t length = place_.size();
        std::vector<std::string> gone;
        for (auto member = value.begin(); value.is_object() && member != value.end(); ++member) {
            place_ += '.' + member.key();
            if (member.key().ends_with("Texture") && member->is_object() && member->contains("index")) {
                if (!renumber_texture((*member)["index"])) gone.push_back(member.key());
            }
            if (member->is_structured()) renumber_textures(*member);
            place_.resize(length);
        }
        if (!gone.empty()) value.erase_members(gone);
        for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) {
            if (value[i].is_structured()) renumber_textures(value[i]);
        }
    }

    bool renumber_texture(Json& index) {
        const auto before = number_in(index);
        const auto after = before ? now_(Thing::texture, *before, 0) : std::nullopt;
        has_changed_ = has_changed_ || after != before;
        if (!after && before) told_.gone.push_back(place_);
        if (after) index = *after;
        return after || !before;
    }

    static constexpr std::uint32_t kGone = 0xffffffff;

    const Host host_;
    const NewNumber& now_;
    Renumbered& told_;
    const Reference* reference_ = nullptr;
    std::string place_;
    std::map<std::string, std::vector<std::uint32_t>> lists_;  ///< by the path of an array: its elements' new numbers
    bool has_changed_ = false;
};

}  // namespace

bool is_too_deep(std::string_view text) {
    std::size_t depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > kMostLevels) return true;
        } else if ((c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
    return false;
}

std::optional<Renumbered> renumber_extensions(std::string_view json, Host host, const NewNumber& now) {
    if (is_too_deep(json)) return std::nullopt;
    Json all = Json::parse(json).value_or(Json());
    if (!all.is_object()) return std::nullopt;
    Renumbered renumbered;
    Renumberer renumberer(host, now, renumbered);
    std::vector<std::string> gone;
    for (auto extension = all.begin(); extension != all.end(); ++extension) {
        if (!renumberer.renumber(extension.key(), extension.value())) gone.push_back(extension.key());
        if (host != Host::material && !is_known(extension.key()) && has_whole_number(*extension))
            renumbered.unknown.push_back(extension.key());
    }
    all.erase_members(gone);
    if (!renumberer.has_changed()) {
        renumbered.json = json;
    } else if (!all.empty()) {
        renumbered.json = all.dump();
    }
    return renumbered;
}

bool is_known(std::string_view name) {
    const auto starts = [&](std::string_view start) { return name.starts_with(start); };
    return std::find(kWithoutReferences.begin(), kWithoutReferences.end(), name) != kWithoutReferences.end() ||
           std::any_of(kMaterials.begin(), kMaterials.end(), starts) ||
           std::any_of(kReferences.begin(), kReferences.end(),
                       [&](const Reference& known) { return known.extension == name; });
}

}  // namespace bendy::extensions
