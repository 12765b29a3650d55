#include <bendy/edit/edit.h>

#include "rewrite.h"

#include <bendy/format/charconv.h>
#include <bendy/format/record_table.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

namespace bendy::edit {
namespace {

/// A field of SurfaceRecord that holds numbers.
struct Place {
    std::string path;  ///< "roughness", "normal_texture.scale"
    const RecordField* field = nullptr;
    std::size_t offset = 0;  ///< in SurfaceRecord
};

// NOLINTNEXTLINE(misc-no-recursion): records are nested once
void add_places(std::string_view record, const std::string& before, std::size_t offset, std::vector<Place>& places) {
    for (const RecordField& field : find_layout(record)->fields) {
        const std::size_t at = offset + static_cast<std::size_t>(field.offset);
        const std::string path = before + std::string(field.name);
        if (field.type == FieldType::record) {
            add_places(field.type_name, path + '.', at, places);
        } else if (!field.is_reserved()) {
            places.push_back({path, &field, at});
        }
    }
}

const std::vector<Place>& all_places() {
    static const std::vector<Place> all = [] {
        std::vector<Place> places;
        add_places("SurfaceRecord", "", 0, places);
        return places;
    }();
    return all;
}

/// "base_colour, ..., unlit; of base_colour_texture, ...: texture, coords, ..."
std::string list_paths() {
    std::array<std::vector<std::string>, 3> lists;  // fields, textures, fields of each texture
    for (const Place& place : all_places()) {
        const std::size_t dot = place.path.find('.');
        const auto add = [](std::vector<std::string>& list, std::string name) {
            if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(std::move(name));
        };
        add(lists[dot == std::string::npos ? 0 : 1], place.path.substr(0, dot));
        if (dot != std::string::npos) add(lists[2], place.path.substr(dot + 1));
    }
    std::string text;
    const std::array<std::string_view, 3> before{"", "; of ", ": "};
    for (std::size_t k = 0; k < lists.size(); ++k) {
        text += before[k];
        for (const std::string& name : lists[k]) text += (&name == lists[k].data() ? "" : ", ") + name;
    }
    return text;
}

/// The numbers that a field may have, as glTF limits them.
struct Range {
    double low = std::numeric_limits<double>::lowest(), high = std::numeric_limits<double>::max();
    std::string_view text = {};
};

Range range_of(const Place& place) {
    constexpr std::array<std::string_view, 4> kShares{"base_colour", "metallic", "roughness", "occlusion_strength"};
    constexpr std::array<std::string_view, 2> kSwitches{"double_sided", "unlit"};
    constexpr std::array<std::string_view, 2> kNotNegative{"emissive", "alpha_cutoff"};
    const auto is_in = [&](const auto& list) { return std::find(list.begin(), list.end(), place.path) != list.end(); };
    if (is_in(kShares)) return {0.0, 1.0, "from 0 to 1"};
    if (is_in(kSwitches)) return {0.0, 1.0, "0 or 1"};
    if (is_in(kNotNegative)) return {.low = 0.0, .text = "0 or more"};
    if (place.field->type == FieldType::u32) return {0.0, std::numeric_limits<std::uint32_t>::max(), "0 or more"};
    return {};
}

/// Appends a number as the field stores it. \return false if the text is no number in the range
bool append_number(const Place& place, std::string_view text, Buffer& bytes) {
    double number = 0.0;
    const auto [end, problem] = from_chars(text.data(), text.data() + text.size(), number);
    const Range range = range_of(place);
    if (problem != std::errc() || end != text.data() + text.size() || !(number >= range.low && number <= range.high))
        return false;
    if (place.field->type == FieldType::f32) {
        append(bytes, static_cast<float>(number));
        return std::isfinite(static_cast<float>(number));
    }
    if (number != std::floor(number)) return false;
    const auto whole = static_cast<std::uint32_t>(number);
    const Bytes its = bytes_of(whole).first(size_of(number_type(place.field->type)));  // little-endian
    bytes.insert(bytes.end(), its.begin(), its.end());
    return true;
}

Result<std::uint32_t, Problem> find_texture(std::span<const std::string_view> textures, std::string_view wanted) {
    if (wanted == "none") return kNone;
    const auto found = find_named(textures, wanted, "texture");
    if (!found) return found.error();
    if (found->size() > 1) {
        return Problem{std::to_string(found->size()) + " textures are called \"" + std::string(wanted) +
                       "\"; say which by its number, as in #" + std::to_string(found->front())};
    }
    return static_cast<std::uint32_t>(found->front());
}

/// The bytes of a field for a text.
Result<Buffer, Problem> read_value(const Place& place, std::string_view text,
                                   std::span<const std::string_view> textures) {
    const RecordField& field = *place.field;
    Buffer bytes;
    if (field.reference.is_any()) {
        const auto texture = find_texture(textures, text);
        if (!texture) return texture.error();
        append(bytes, *texture);
        return bytes;
    }
    if (!field.values.empty()) {
        for (std::uint8_t value = 0; !field.value_name(value).empty(); ++value) {
            if (field.value_name(value) == text) return Buffer{std::byte{value}};
        }
        return Problem{place.path + " is one word of \"" + std::string(field.values) + "\", not \"" +
                       std::string(text) + '"'};
    }
    std::string_view rest = text;
    for (std::uint32_t k = 0; k < field.count; ++k) {
        const std::size_t comma = k + 1 == field.count ? rest.size() : rest.find(',');
        if (comma == std::string_view::npos || !append_number(place, rest.substr(0, comma), bytes)) {
            const std::string_view range = range_of(place).text;
            return Problem{place.path + " takes " +
                           (field.count == 1 ? "a number" : std::to_string(field.count) + " numbers with commas") +
                           (range.empty() ? "" : ", ") + std::string(range) + ", not \"" + std::string(text) + '"'};
        }
        rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    return bytes;
}

}  // namespace

Result<SetMaterial, Problem> parse_set(std::string_view text) {
    constexpr std::string_view kKind = "material:";
    if (!text.starts_with(kKind) || text.find('=') == std::string_view::npos)
        return Problem{'"' + std::string(text) + "\" is not material:NAME.FIELD=VALUE"};
    const std::string_view whole = text;
    text.remove_prefix(kKind.size());
    // Names of materials and textures may have dots and signs of equality: the first field decides.
    for (std::size_t sign = text.find('='); sign != std::string_view::npos; sign = text.find('=', sign + 1)) {
        const std::string_view before = text.substr(0, sign);
        const Place* found = nullptr;
        for (const Place& place : all_places()) {
            if (before.size() > place.path.size() + 1 && before.ends_with('.' + place.path) &&
                (found == nullptr || place.path.size() > found->path.size()))
                found = &place;
        }
        if (found != nullptr) {
            return SetMaterial{std::string(before.substr(0, before.size() - found->path.size() - 1)), found->path,
                               std::string(text.substr(sign + 1))};
        }
    }
    return Problem{'"' + std::string(whole) +
                   "\" names no field of a material, as in material:Wood.roughness=0.4; these are " + list_paths()};
}

Edited set_material(Bytes file, const SetMaterial& what, Log& log) {
    const auto place = std::find_if(all_places().begin(), all_places().end(),
                                    [&](const Place& each) { return each.path == what.field; });
    if (place == all_places().end())
        return Problem{"a material has no field \"" + what.field + "\"; it has " + list_paths()};
    const auto source = open_source(file);
    if (!source) return source.error();
    const std::vector<std::string_view> names = names_of(source->document.materials);
    const auto materials = find_named(names, what.material, "material");
    if (!materials) return materials.error();
    const auto value = read_value(*place, what.value, names_of(source->document.textures));
    if (!value) return value.error();
    Rewrite rewrite(source->tree);
    for (const std::size_t number : *materials) {
        const std::uint32_t surface = source->tree.find(source->document.materials[number].chunk, FourCC("SURF"));
        rewrite.overwrite(surface, place->offset, *value);
        const std::array one{number};
        log.done.push_back("material " + list_names(names, one) + ": " + what.field + " is " + what.value);
    }
    return finish(rewrite);
}

}  // namespace bendy::edit
