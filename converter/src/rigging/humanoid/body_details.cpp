#include "body_details.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace bendy::converter {
namespace {

enum class Finger : std::uint8_t { thumb, index, middle, ring, little };

struct FingerWord {
    std::string_view word;
    Finger finger;
};
constexpr std::array kFingerWords{
    FingerWord{"thumb", Finger::thumb},   FingerWord{"index", Finger::index},   FingerWord{"pointer", Finger::index},
    FingerWord{"middle", Finger::middle}, FingerWord{"mid", Finger::middle},    FingerWord{"ring", Finger::ring},
    FingerWord{"pinky", Finger::little},  FingerWord{"pinkie", Finger::little}, FingerWord{"little", Finger::little},
};

/// Biped numbers its fingers: `Finger0` is the thumb's first joint, `Finger12` the third of the index finger.
std::optional<Finger> finger_of_biped(const NameWords& name) {
    if (!name.has("bip")) return std::nullopt;
    const std::string_view number = name.after("finger");
    if (number.empty() || number.size() > 2 || number.front() < '0' || number.front() > '4') return std::nullopt;
    return static_cast<Finger>(number.front() - '0');
}

std::optional<Finger> finger_of(const NameWords& name) {
    if (name.is_helper()) return std::nullopt;
    const auto* const found = std::find_if(kFingerWords.begin(), kFingerWords.end(),
                                           [&](const FingerWord& each) { return name.has(each.word); });
    if (found == kFingerWords.end()) return finger_of_biped(name);
    const bool is_in_palm = name.has("metacarpal") || name.has("carpal") || name.has("meta") || name.has("palm");
    if (is_in_palm && found->finger != Finger::thumb) return std::nullopt;
    return found->finger;
}

void add_fingers(const Scene& scene, const RestFrames& rest, BodySide side, Humanoid& bones) {
    const bool is_left = side == BodySide::left;
    const std::uint32_t forearm = bones[is_left ? Role::left_lower_arm : Role::right_lower_arm];
    if (forearm == kNone) return;
    constexpr std::size_t kJoints = 3;  // of a finger
    const auto first = static_cast<std::size_t>(is_left ? Role::left_thumb_metacarpal : Role::right_thumb_metacarpal);
    std::array<std::size_t, 5> counts{};
    std::array<std::uint32_t, 5> last{};
    for (std::uint32_t joint = forearm + 1; joint < scene.joints.size() && rest.is_below(joint, forearm); ++joint) {
        const std::optional<Finger> finger = finger_of(NameWords(scene.joints[joint].name));
        if (!finger) continue;
        const auto number = static_cast<std::size_t>(*finger);
        std::size_t& count = counts[number];
        if (count == kJoints || (count > 0 && !rest.is_below(joint, last[number]))) continue;
        bones[static_cast<Role>(first + number * kJoints + count)] = joint;
        last[number] = joint;
        ++count;
    }
}

/// `LeftEye`, `eye_R`, not eyelids and eyebrows.
bool is_eye(const NameWords& name) {
    constexpr std::array<std::string_view, 6> kOthers{"lid", "brow", "lash", "look", "lids", "corner"};
    return (name.has("eye") || name.has("eyeball")) && !name.is_helper() &&
           std::none_of(kOthers.begin(), kOthers.end(), [&](std::string_view word) { return name.has(word); });
}

void add_face(const Scene& scene, const RestFrames& rest, Humanoid& bones) {
    const std::uint32_t head = bones[Role::head];
    if (head == kNone) return;
    std::uint32_t left = kNone;
    std::uint32_t right = kNone;
    for (std::uint32_t joint = head + 1; joint < scene.joints.size() && rest.is_below(joint, head); ++joint) {
        const NameWords name(scene.joints[joint].name);
        const BodySide side = name.side();
        if (side == BodySide::none && name.has("jaw") && !name.has("upper") && !name.is_helper() &&
            !bones.has(Role::jaw))
            bones[Role::jaw] = joint;
        if (side == BodySide::none || !is_eye(name)) continue;
        std::uint32_t& eye = side == BodySide::left ? left : right;
        if (eye == kNone) eye = joint;
    }
    if (left == kNone || right == kNone) return;
    bones[Role::left_eye] = left;
    bones[Role::right_eye] = right;
}

/// The joint, and from each the first child that fits. Children follow their parent in the joints' order.
template <class Fits>
std::vector<std::uint32_t> follow_names(const Scene& scene, std::uint32_t first, const Fits& fits) {
    std::vector<std::uint32_t> joints{first};
    for (std::uint32_t joint = first + 1; joint < scene.joints.size(); ++joint) {
        if (scene.joints[joint].parent == joints.back() && fits(joint)) joints.push_back(joint);
    }
    return joints;
}

}  // namespace

void add_details(const Scene& scene, const RestFrames& rest, Humanoid& bones) {
    add_fingers(scene, rest, BodySide::left, bones);
    add_fingers(scene, rest, BodySide::right, bones);
    add_face(scene, rest, bones);
}

bool is_finger(const std::string& name) {
    return finger_of(NameWords(name)).has_value();
}

std::uint32_t find_split_hand(const Scene& scene, const RestFrames& rest, std::uint32_t forearm) {
    constexpr std::array<std::uint32_t, 5> kNobody{kNone, kNone, kNone, kNone, kNone};
    std::array<std::uint32_t, 5> palms = kNobody, fingers = kNobody;  // by the finger that they carry, or are
    std::uint32_t branch = kNone;
    for (std::uint32_t joint = forearm + 1; joint < scene.joints.size() && rest.is_below(joint, forearm); ++joint) {
        if (scene.joints[joint].parent == forearm) branch = joint;
        const std::optional<Finger> finger = finger_of(NameWords(scene.joints[joint].name));
        if (!finger) continue;
        auto& found = is_finger(scene.joints[branch].name) ? fingers : palms;
        if (found[static_cast<std::size_t>(*finger)] == kNone) found[static_cast<std::size_t>(*finger)] = branch;
    }
    for (const auto& found : {palms, fingers}) {
        for (const Finger finger : {Finger::middle, Finger::ring, Finger::index}) {
            if (found[static_cast<std::size_t>(finger)] != kNone) return found[static_cast<std::size_t>(finger)];
        }
    }
    return kNone;
}

std::vector<std::uint32_t> find_tail(const Scene& scene, const std::vector<std::uint32_t>& bases) {
    const auto is_tail = [&](std::uint32_t joint) {
        const NameWords name(scene.joints[joint].name);
        return name.has("tail") && name.side() == BodySide::none && !name.is_helper();
    };
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        if (std::find(bases.begin(), bases.end(), parent) != bases.end() && is_tail(joint))
            return follow_names(scene, joint, is_tail);
    }
    return {};
}

std::vector<std::uint32_t> find_wing(const Scene& scene, BodySide side) {
    const auto is_wing = [&](std::uint32_t joint) {
        const NameWords name(scene.joints[joint].name);
        return name.has("wing") && !name.has("feather") && name.side() == side && !name.is_helper();
    };
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        if (is_wing(joint)) return follow_names(scene, joint, is_wing);
    }
    return {};
}

}  // namespace bendy::converter
