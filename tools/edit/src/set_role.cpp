#include <bendy/edit/edit.h>

#include "rewrite.h"

#include <bendy/format/role.h>
#include <bendy/format/standing_pose.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <utility>

namespace bendy::edit {
namespace {

/// Adds, replaces or removes a leaf of an object that says what its joints are. A new one follows the joints.
void put_after_joints(const Source& source, std::uint32_t object, FourCC id, Bytes payload, Rewrite& rewrite) {
    const std::uint32_t before = source.tree.find(object, id);
    if (before != kNone && payload.empty()) return rewrite.remove(before);
    if (before != kNone) return rewrite.replace(before, payload);
    constexpr std::array kFirst{FourCC("NAME"), FourCC("EXTR"), FourCC("MORE"), FourCC("SKIN"),
                                FourCC("JNTS"), FourCC("JNAM"), FourCC("ROLE")};
    std::uint32_t last = kNone;
    for (const std::uint32_t child : source.tree.children(object)) {
        if (std::find(kFirst.begin(), kFirst.end(), source.tree[child].id) != kFirst.end()) last = child;
    }
    Buffer leaf = whole_leaf(id, payload);
    if (last == kNone) return rewrite.prepend(object, std::move(leaf));
    rewrite.insert_after(last, std::move(leaf));
}

}  // namespace

Result<SetRole, Problem> parse_role(std::string_view text) {
    const std::size_t sign = text.find('=');
    if (sign == std::string_view::npos) return Problem{'"' + std::string(text) + "\" is not ROLE=JOINT"};
    const std::string_view key = text.substr(0, sign);
    const std::string_view word = key.substr(0, key.find(':'));
    const auto& words = kValueNames<Role>;
    const auto* const found = std::find(words.begin() + 1, words.end(), word);
    if (found == words.end()) {
        const std::string_view near = nearest_name(std::span(words).subspan(1), word);
        return Problem{"there is no role \"" + std::string(word) + '"' +
                       (near.empty() ? std::string() : "; did you mean \"" + std::string(near) + "\"?")};
    }
    SetRole role;
    role.role = static_cast<Role>(found - words.begin());
    role.joint = text.substr(sign + 1);
    if (word.size() == key.size()) return role;
    const std::string_view place = key.substr(word.size() + 1);
    const auto [end, error] = std::from_chars(place.data(), place.data() + place.size(), role.place);
    if (error != std::errc() || end != place.data() + place.size())
        return Problem{'"' + std::string(place) + "\" is not a place in a chain, 0 to 65535"};
    if (role.role < kFirstChainRole) return Problem{'"' + std::string(word) + "\" is one joint and has no places"};
    return role;
}

Edited set_role(Bytes file, const SetRole& what, Log& log) {
    const auto source = open_source(file);
    if (!source) return source.error();
    if (source->document.objects.empty()) return Problem{"the file has no object"};
    const ObjectView& object = source->document.objects.front();
    const std::vector<std::string_view> names = names_of(object.skeleton.joints);
    RoleRecord record{kNone, static_cast<std::uint16_t>(what.role), what.place};
    if (!what.joint.empty()) {
        const auto joints = find_named(names, what.joint, "joint");
        if (!joints) return joints.error();
        if (joints->size() > 1) {
            return Problem{std::to_string(joints->size()) + " joints are called \"" + what.joint +
                           "\"; say which by its number, as in #" + std::to_string(joints->front())};
        }
        record.joint = static_cast<std::uint32_t>(joints->front());
    }
    std::vector<RoleRecord> roles;
    for (const RoleRecord& other : object.roles) {
        const bool is_taken = other.role == record.role && other.place == record.place;
        if (!is_taken && other.joint != record.joint) {
            roles.push_back(other);
        } else if (other.joint != record.joint || !is_taken) {
            log.done.push_back("joint \"" + std::string(names[other.joint]) + "\" is no longer " + role_text(other));
        }
    }
    if (record.joint != kNone) {
        roles.push_back(record);
        log.done.push_back("joint \"" + std::string(names[record.joint]) + "\" is " + role_text(record));
    }
    std::sort(roles.begin(), roles.end(), [](const RoleRecord& a, const RoleRecord& b) { return a.joint < b.joint; });
    Rewrite rewrite(source->tree);
    put_after_joints(*source, object.chunk, FourCC("ROLE"), std::as_bytes(std::span(roles)), rewrite);
    return finish(rewrite);
}

Edited set_standing_pose(Bytes file, const StandingPoseRecord& pose,
                         std::span<const StandingRotationRecord> rotations) {
    const auto source = open_source(file);
    if (!source) return source.error();
    if (source->document.objects.empty()) return Problem{"the file has no object"};
    Rewrite rewrite(source->tree);
    put_after_joints(*source, source->document.objects.front().chunk, FourCC("STND"),
                     write_standing_pose(pose, rotations), rewrite);
    return finish(rewrite);
}

}  // namespace bendy::edit
