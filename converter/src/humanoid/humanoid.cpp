#include "humanoid.h"

#include <algorithm>
#include <string>

namespace bendy::converter {
namespace {

constexpr std::array<std::string_view, kHumanBones> kVrmNames{"hips",
                                                              "spine",
                                                              "chest",
                                                              "upperChest",
                                                              "neck",
                                                              "head",
                                                              "leftShoulder",
                                                              "leftUpperArm",
                                                              "leftLowerArm",
                                                              "leftHand",
                                                              "leftThumbProximal",
                                                              "leftUpperLeg",
                                                              "leftLowerLeg",
                                                              "leftFoot",
                                                              "leftToes",
                                                              "rightShoulder",
                                                              "rightUpperArm",
                                                              "rightLowerArm",
                                                              "rightHand",
                                                              "rightThumbProximal",
                                                              "rightUpperLeg",
                                                              "rightLowerLeg",
                                                              "rightFoot",
                                                              "rightToes"};

}  // namespace

std::string_view vrm_name(HumanBone bone) {
    return kVrmNames[static_cast<std::size_t>(bone)];
}

std::optional<HumanBone> bone_of_vrm_name(std::string_view name) {
    const auto* const found = std::find(kVrmNames.begin(), kVrmNames.end(), name);
    if (found == kVrmNames.end()) return std::nullopt;
    return static_cast<HumanBone>(found - kVrmNames.begin());
}

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

/// Words in lower case, numbers apart, one space before, between and after: `mixamorig:LeftForeArm_010` gives
/// " left fore arm 010 ".
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

bool has_word(std::string_view words, std::string_view word) {
    return words.find(' ' + std::string(word) + ' ') != std::string_view::npos;
}

template <std::size_t N>
bool has_any(std::string_view words, const std::array<std::string_view, N>& list) {
    return std::any_of(list.begin(), list.end(), [&](std::string_view word) { return has_word(words, word); });
}

/// Words of joints that carry no limb of their own.
constexpr std::array<std::string_view, 34> kHelpers{
    "ctl",    "ctrl", "control", "controller", "ik",         "fk",      "pole", "poletarget", "target",
    "orient", "mch",  "org",     "vis",        "tweak",      "socket",  "nub",  "end",        "leaf",
    "twist",  "roll", "helper",  "wgt",        "master",     "virtual", "root", "gizmo",      "attach",
    "weapon", "prop", "dummy",   "tip",        "corrective", "share",   "sec"};
constexpr std::array<std::string_view, 12> kFingers{"index",  "pointer", "middle", "ring",    "pinky",      "pinkie",
                                                    "little", "finger",  "mid",    "fingers", "metacarpal", "carpal"};
/// What stands beside the part's name and says nothing of it.
constexpr std::array<std::string_view, 20> kNoise{"left", "right",  "l",    "r",         "c",         "def",     "b",
                                                  "bip",  "j",      "jnt",  "joint",     "bone",      "bind",    "skel",
                                                  "sk",   "deform", "char", "mixamorig", "character", "armature"};

struct Spelling {
    std::string_view words;
    BodyPart part;
    std::uint8_t rank = 0;
};
/// The first entry found in the name is used, so longer names come before their parts.
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

BodySide side_of(std::string_view words) {
    if (has_word(words, "left") || has_word(words, "l")) return BodySide::left;
    if (has_word(words, "right") || has_word(words, "r")) return BodySide::right;
    return BodySide::none;
}

bool is_of_a_limb(BodyPart part) {
    return part >= BodyPart::shoulder;
}

/// The word that is left when sides, prefixes and numbers are taken away; empty if there are several.
std::string_view only_word(std::string_view words) {
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

}  // namespace

std::optional<BoneName> read_bone_name(std::string_view name) {
    constexpr std::size_t kMaxBytes = 200;
    if (name.size() > kMaxBytes) return std::nullopt;
    const std::string words = words_of(name);
    if (has_any(words, kHelpers) || has_any(words, kFingers)) return std::nullopt;
    BoneName result;
    result.side = side_of(words);
    const auto* const spelling =
        std::find_if(kSpellings.begin(), kSpellings.end(), [&](const Spelling& s) { return has_word(words, s.words); });
    if (spelling != kSpellings.end()) {
        result.part = spelling->part;
        result.rank = spelling->rank;
        if (has_word(words, "hip") && result.side != BodySide::none) result.part = BodyPart::upper_leg;
        if (is_of_a_limb(result.part) == (result.side == BodySide::none)) return std::nullopt;
        return result;
    }
    const std::string_view only = only_word(words);
    if (result.side == BodySide::none || (only != "arm" && only != "leg")) return std::nullopt;
    result.part = only == "arm" ? BodyPart::arm : BodyPart::leg;
    return result;
}

}  // namespace bendy::converter
