#include "humanoid.h"

#include "scene/json_text.h"

#include <algorithm>
#include <string>
#include <utility>

namespace bendy::converter {
namespace {

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
bool is_upper(char c) {
    return c >= 'A' && c <= 'Z';
}
bool is_lower(char c) {
    return c >= 'a' && c <= 'z';
}

/// Splits a name into words, with a space before, between and after them.
std::string words_of(std::string_view name) {
    if (const std::size_t space = name.find_last_of(":|"); space != std::string_view::npos)
        name.remove_prefix(space + 1);
    std::string words = " ";
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        if (!is_digit(c) && !is_upper(c) && !is_lower(c)) {
            if (words.back() != ' ') words += ' ';
            continue;
        }
        const char last = i > 0 ? name[i - 1] : ' ';
        const bool next_is_lower = i + 1 < name.size() && is_lower(name[i + 1]);
        const bool starts =
            (is_upper(c) && (is_lower(last) || (is_upper(last) && next_is_lower))) || is_digit(c) != is_digit(last);
        if (starts && words.back() != ' ') words += ' ';
        words += is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
    }
    if (words.back() != ' ') words += ' ';
    return words;
}

template <std::size_t N>
bool has_any(const NameWords& name, const std::array<std::string_view, N>& list) {
    return std::any_of(list.begin(), list.end(), [&](std::string_view word) { return name.has(word); });
}

/// Words that mark joints without a limb of their own.
constexpr std::array<std::string_view, 34> kHelpers{
    "ctl",    "ctrl", "control", "controller", "ik",         "fk",      "pole", "poletarget", "target",
    "orient", "mch",  "org",     "vis",        "tweak",      "socket",  "nub",  "end",        "leaf",
    "twist",  "roll", "helper",  "wgt",        "master",     "virtual", "root", "gizmo",      "attach",
    "weapon", "prop", "dummy",   "tip",        "corrective", "share",   "sec"};
constexpr std::array<std::string_view, 12> kFingers{"index",  "pointer", "middle", "ring",    "pinky",      "pinkie",
                                                    "little", "finger",  "mid",    "fingers", "metacarpal", "carpal"};
/// Words in a part's name that carry no meaning.
constexpr std::array<std::string_view, 20> kNoise{"left", "right",  "l",    "r",         "c",         "def",     "b",
                                                  "bip",  "j",      "jnt",  "joint",     "bone",      "bind",    "skel",
                                                  "sk",   "deform", "char", "mixamorig", "character", "armature"};

struct Spelling {
    std::string_view words;
    BodyPart part;
    std::uint8_t rank = 0;
};
/// The first entry found in the name wins, so longer names come before their parts.
constexpr std::array kSpellings{
    Spelling{"thumb", BodyPart::thumb},
    Spelling{"toe", BodyPart::toes},
    Spelling{"toes", BodyPart::toes},
    Spelling{"toebase", BodyPart::toes},
    Spelling{"ball", BodyPart::toes},
    Spelling{"foot", BodyPart::foot},
    Spelling{"feet", BodyPart::foot},
    Spelling{"ankle", BodyPart::foot},
    Spelling{"lower leg", BodyPart::lower_leg},
    Spelling{"lowerleg", BodyPart::lower_leg},
    Spelling{"leg lower", BodyPart::lower_leg},
    Spelling{"low leg", BodyPart::lower_leg},
    Spelling{"shin", BodyPart::lower_leg},
    Spelling{"calf", BodyPart::lower_leg},
    Spelling{"knee", BodyPart::lower_leg},
    Spelling{"leg 02", BodyPart::lower_leg},
    Spelling{"leg 2", BodyPart::lower_leg},
    Spelling{"up leg", BodyPart::upper_leg},
    Spelling{"upleg", BodyPart::upper_leg},
    Spelling{"upper leg", BodyPart::upper_leg},
    Spelling{"upperleg", BodyPart::upper_leg},
    Spelling{"leg upper", BodyPart::upper_leg},
    Spelling{"thigh", BodyPart::upper_leg},
    Spelling{"leg 01", BodyPart::upper_leg},
    Spelling{"leg 1", BodyPart::upper_leg},
    Spelling{"forearm", BodyPart::lower_arm},
    Spelling{"fore arm", BodyPart::lower_arm},
    Spelling{"lower arm", BodyPart::lower_arm},
    Spelling{"lowerarm", BodyPart::lower_arm},
    Spelling{"arm lower", BodyPart::lower_arm},
    Spelling{"low arm", BodyPart::lower_arm},
    Spelling{"elbow", BodyPart::lower_arm},
    Spelling{"upper arm", BodyPart::upper_arm},
    Spelling{"upperarm", BodyPart::upper_arm},
    Spelling{"up arm", BodyPart::upper_arm},
    Spelling{"uparm", BodyPart::upper_arm},
    Spelling{"arm upper", BodyPart::upper_arm},
    Spelling{"shldr", BodyPart::upper_arm},
    Spelling{"hand", BodyPart::hand},
    Spelling{"wrist", BodyPart::hand},
    Spelling{"palm", BodyPart::hand, 1},
    Spelling{"shoulder", BodyPart::shoulder},
    Spelling{"clavicle", BodyPart::shoulder},
    Spelling{"collar", BodyPart::shoulder},
    Spelling{"collarbone", BodyPart::shoulder},
    Spelling{"hips", BodyPart::hips},
    Spelling{"hip", BodyPart::hips},
    Spelling{"pelvis", BodyPart::hips},
    Spelling{"head", BodyPart::head},
    Spelling{"neck", BodyPart::neck},
    Spelling{"chest", BodyPart::chest},
    Spelling{"upperchest", BodyPart::chest},
    Spelling{"torso", BodyPart::chest},
    Spelling{"spine", BodyPart::spine},
    Spelling{"abdomen", BodyPart::spine},
    Spelling{"waist", BodyPart::spine},
};

bool is_of_a_limb(BodyPart part) {
    return part >= BodyPart::shoulder;
}

/// VRM 0.x names the bones of the thumb as those of the other fingers.
std::string name_in_vrm_1(const std::string& name) {
    if (name == "leftThumbProximal" || name == "rightThumbProximal")
        return name.substr(0, name.find("Proximal")) + "Metacarpal";
    if (name == "leftThumbIntermediate" || name == "rightThumbIntermediate")
        return name.substr(0, name.find("Intermediate")) + "Proximal";
    return name;
}

/// Fills a humanoid from JSON, bone by bone.
class Reader {
public:
    Reader(const Scene& scene, Report& report) : scene_(scene), report_(report) {}

    /// Expects {"node": joint} in `entry`.
    void add(const std::string& name, const Json& entry, const std::string& place) {
        if (!entry.is_object()) return warn("a VRM bone is not an object, left out", place);
        const auto node = entry.find("node");
        if (node == entry.end()) return warn("a VRM bone without a node is left out", place);
        if (node->is_null()) return;  // reported when the extension was kept
        if (!node->is_number_unsigned() || node->get<std::uint64_t>() >= scene_.joints.size())
            return warn("the node of a VRM bone is not a node index, left out", place + ".node");
        const std::optional<HumanBone> bone = bone_of_vrm_name(name);
        if (!bone) return;
        if (humanoid.has(*bone)) return warn("a VRM bone is named twice, the first counts", place);
        humanoid[*bone] = node->get<std::uint32_t>();
    }

    void warn(const char* message, const std::string& place) { report_.warn(message, place); }

    Humanoid humanoid;

private:
    const Scene& scene_;
    Report& report_;
};

/// The member of an object that must be an object or array; null if it is missing or has another type.
const Json* member(const Json& object, const char* name, bool is_array, const std::string& place, Reader& reader) {
    const auto found = object.find(name);
    if (found != object.end() && (is_array ? found->is_array() : found->is_object())) return &*found;
    reader.warn(is_array ? "a VRM humanoid's bones must be an array, left out"
                         : "a VRM extension without this object has no humanoid, left out",
                place + '.' + name);
    return nullptr;
}

void read_bones_1(const Json& vrm, const std::string& place, Reader& reader) {
    const Json* humanoid = member(vrm, "humanoid", false, place, reader);
    if (humanoid == nullptr) return;
    const std::string here = place + ".humanoid";
    const Json* bones = member(*humanoid, "humanBones", false, here, reader);
    if (bones == nullptr) return;
    for (auto bone = bones->begin(); bone != bones->end(); ++bone)
        reader.add(bone.key(), bone.value(), here + ".humanBones." + bone.key());
}

void read_bones_0(const Json& vrm, const std::string& place, Reader& reader, Report& report) {
    const Json* humanoid = member(vrm, "humanoid", false, place, reader);
    if (humanoid == nullptr) return;
    const std::string here = place + ".humanoid";
    const Json* bones = member(*humanoid, "humanBones", true, here, reader);
    if (bones == nullptr) return;
    std::uint64_t own_constraints = 0;
    std::string first_constraint;
    for (std::size_t i = 0; i < bones->size(); ++i) {
        const Json& entry = (*bones)[i];
        const std::string at = here + ".humanBones[" + std::to_string(i) + ']';
        const bool is_named = entry.is_object() && entry.contains("bone") && entry["bone"].is_string();
        if (!is_named) {
            reader.warn("a VRM bone without a name is left out", at);
            continue;
        }
        reader.add(name_in_vrm_1(entry["bone"].get<std::string>()), entry, at);
        if (const auto defaults = entry.find("useDefaultValues"); defaults != entry.end() && *defaults == false) {
            if (own_constraints++ == 0) first_constraint = at;
        }
    }
    if (own_constraints > 0) {
        report.warn("limits of VRM 0.x bones are kept as JSON, not interpreted: they are about Unity's muscle axes",
                    first_constraint, own_constraints);
    }
}

}  // namespace

std::string vrm_name(HumanBone bone) {
    std::string name;
    for (const char c : kValueNames<Role>[static_cast<std::size_t>(bone)]) {
        const bool starts = !name.empty() && name.back() == '_';
        if (starts) name.pop_back();
        name += starts ? static_cast<char>(c - 'a' + 'A') : c;
    }
    return name;
}

std::optional<HumanBone> bone_of_vrm_name(std::string_view name) {
    for (std::size_t bone = 1; bone < kHumanBones; ++bone) {
        if (vrm_name(static_cast<HumanBone>(bone)) == name) return static_cast<HumanBone>(bone);
    }
    return std::nullopt;
}

NameWords::NameWords(std::string_view name) {
    constexpr std::size_t kMaxBytes = 200;
    words_ = name.size() > kMaxBytes ? " " : words_of(name);
}

std::size_t NameWords::find(std::string_view word) const {
    for (std::size_t at = words_.find(word); at != std::string::npos; at = words_.find(word, at + 1)) {
        if (at > 0 && words_[at - 1] == ' ' && words_[at + word.size()] == ' ') return at;
    }
    return std::string::npos;
}

std::string_view NameWords::after(std::string_view word) const {
    const std::size_t at = find(word);
    if (at == std::string::npos) return {};
    const std::string_view rest = std::string_view(words_).substr(at + word.size() + 1);
    return rest.substr(0, rest.find(' '));
}

BodySide NameWords::side() const {
    if (has("left") || has("l")) return BodySide::left;
    if (has("right") || has("r")) return BodySide::right;
    return BodySide::none;
}

bool NameWords::is_helper() const {
    return has_any(*this, kHelpers);
}

std::string_view NameWords::only_word() const {
    const std::string_view words = words_;
    std::string_view only;
    for (std::size_t from = 1; from < words.size();) {
        const std::size_t end = std::min(words.find(' ', from), words.size());
        const std::string_view word = words.substr(from, end - from);
        from = end + 1;
        if (word.empty() || is_digit(word.front())) continue;
        if (std::find(kNoise.begin(), kNoise.end(), word) != kNoise.end()) continue;
        if (!only.empty()) return {};
        only = word;
    }
    return only;
}

namespace {

/// Names the parts of a front leg as those of an arm: only hind legs are legs of a body that stands on two.
void make_front_limb(const NameWords& words, BoneName& name) {
    constexpr std::array kParts{std::pair(BodyPart::upper_leg, BodyPart::upper_arm),
                                std::pair(BodyPart::lower_leg, BodyPart::lower_arm),
                                std::pair(BodyPart::foot, BodyPart::hand)};
    if (!words.has("front") && !words.has("fore")) return;
    for (const auto& [of_leg, of_arm] : kParts) {
        if (name.part != of_leg) continue;
        name.part = of_arm;
        name.is_front_leg = true;
        return;
    }
}

}  // namespace

// NOLINTNEXTLINE(misc-no-recursion): once, with a side in the name
std::optional<BoneName> read_bone_name(std::string_view name) {
    const NameWords words(name);
    if (words.is_helper() || has_any(words, kFingers)) return std::nullopt;
    BoneName result;
    result.side = words.side();
    const auto* const spelling =
        std::find_if(kSpellings.begin(), kSpellings.end(), [&](const Spelling& s) { return words.has(s.words); });
    if (spelling != kSpellings.end()) {
        result.part = spelling->part;
        result.rank = spelling->rank;
        if (words.has("hip") && result.side != BodySide::none) {
            result.part = BodyPart::upper_leg;
            result.rank = 1;  // some rigs have a joint above the thigh, as `LHipJoint` above `LeftUpLeg`
        }
        if (is_of_a_limb(result.part) == (result.side == BodySide::none)) return std::nullopt;
        make_front_limb(words, result);
        return result;
    }
    const std::string_view only = words.only_word();
    if (result.side == BodySide::none && only.size() > 1 && (only.front() == 'l' || only.front() == 'r')) {
        const std::string_view part = only.substr(1);  // `rthigh`
        const bool is_part = part == "arm" || part == "leg" ||
                             std::any_of(kSpellings.begin(), kSpellings.end(),
                                         [&](const Spelling& s) { return s.words == part && is_of_a_limb(s.part); });
        return is_part ? read_bone_name(std::string(1, only.front()) + ' ' + std::string(part)) : std::nullopt;
    }
    if (result.side == BodySide::none || (only != "arm" && only != "leg")) return std::nullopt;
    result.part = only == "arm" ? BodyPart::arm : BodyPart::leg;
    return result;
}

std::optional<VrmHumanoid> read_vrm_humanoid(const Scene& scene, Report& report) {
    if (scene.extensions.empty()) return std::nullopt;
    const Json extensions = Json::parse(scene.extensions).value_or(Json());
    if (!extensions.is_object()) return std::nullopt;
    Reader reader(scene, report);
    VrmHumanoid result;
    if (const auto vrm = extensions.find("VRMC_vrm"); vrm != extensions.end()) {
        result.place = "extensions.VRMC_vrm.humanoid";
        read_bones_1(*vrm, "extensions.VRMC_vrm", reader);
    } else if (const auto motion = extensions.find("VRMC_vrm_animation"); motion != extensions.end()) {
        result.place = "extensions.VRMC_vrm_animation.humanoid";
        read_bones_1(*motion, "extensions.VRMC_vrm_animation", reader);
    } else if (const auto old = extensions.find("VRM"); old != extensions.end()) {
        result.place = "extensions.VRM.humanoid";
        result.faces_backward = true;
        read_bones_0(*old, "extensions.VRM", reader, report);
    } else {
        return std::nullopt;
    }
    result.bones = reader.humanoid;
    return result;
}

}  // namespace bendy::converter
