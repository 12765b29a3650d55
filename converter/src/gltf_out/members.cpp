#include "gltf_out/members.h"

#include "failure.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace bendy::converter::gltf_out {
namespace {

/// Objects that mean something by being there: made by others, or not at all.
bool has_meaning(std::string_view member) {
    constexpr std::array<std::string_view, 9> kSuch{
        "baseColorTexture",    "metallicRoughnessTexture", "normalTexture",    "occlusionTexture", "emissiveTexture",
        "KHR_materials_unlit", "KHR_texture_basisu",       "EXT_texture_avif", "EXT_texture_webp"};
    return std::find(kSuch.begin(), kSuch.end(), member) != kSuch.end();
}

// NOLINTNEXTLINE(misc-no-recursion): parsed JSON is at most 128 levels deep
void merge(Json& object, const Json& more, const std::string& place, Report& report) {
    for (auto member = more.begin(); member != more.end(); ++member) {
        const std::string here = place + '.' + key(member.key());
        const auto known = object.find(member.key());
        const bool is_inner = member->is_object() && member.key() != "extras";
        if (known != object.end() && known->is_object() && is_inner) {
            merge(*known, *member, here, report);
        } else if (known == object.end() && is_inner && has_meaning(member.key())) {
            report.warn("data of a texture or extension that is not used any more left out", here);
        } else if (known == object.end() && is_inner &&
                   (member.key() == "extensions" || member.key() == "pbrMetallicRoughness")) {
            Json made = Json::object();
            merge(made, *member, here, report);
            if (!made.empty()) object[member.key()] = std::move(made);
        } else if (known == object.end() && (member.key() != "name" || member->is_string())) {
            object[member.key()] = *member;
        }
    }
}

}  // namespace

Json read_members(const std::string& more, const std::string& place, Report& report) {
    if (more.empty()) return Json::object();
    constexpr std::size_t kLevelsAround = 8;  // of the document, which may not be deeper than other JSON
    try {
        Json members = parse_json_text<Json>(more, report, kMostJsonLevels - kLevelsAround);
        if (members.is_object()) return members;
        report.warn("further members left out, they are no JSON object", place);
    } catch (const Failure& failure) {
        report.warn("further members left out: " + failure.error.message, place);
    }
    return Json::object();
}

void add_members(Json& object, const Json& more, gltf::Element element, const std::string& place, Report& report) {
    merge(object, gltf::further_members(more, element), place, report);
}

}  // namespace bendy::converter::gltf_out
