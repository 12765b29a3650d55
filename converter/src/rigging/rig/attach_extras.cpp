#include "attach_rig.h"
#include "blender.h"
#include "fields.h"
#include "parse_rig.h"
#include "scene/failure.h"
#include "scene/rest_frames.h"

#include <bendy/format/trig.h>

#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <unordered_map>

namespace bendy::converter {
namespace {

/// A member of a joint's or the scene's extras.
struct Extra {
    std::uint32_t joint = kNone;  ///< kNone: the scene's
    std::string place;
    OrderedJson value;
};

struct NamedChain {
    Chain chain;
    std::string place;
};

class Attacher {
public:
    Attacher(Scene& scene, const JointIndex& index, Claims& claims, Report& report)
        : scene_(scene),
          claims_(claims),
          report_(report),
          rest_(scene),
          rig_{scene, index, rest_, {}, std::vector<float>(scene.joints.size())} {
        for (std::uint32_t joint = 0; joint < index.size(); ++joint) rig_.axes.push_back(rest_.turn(joint));
    }

    void attach() {
        for (std::uint32_t joint = 0; joint < scene_.joints.size(); ++joint)
            gather(scene_.joints[joint].extras, joint, "nodes." + name_of(joint) + ".extras");
        gather(scene_.extras, kNone, "scene.extras");
        find_armatures();
        std::erase_if(joints_, [&](const Extra& extra) {
            return !guard("constraints left out", extra.place, [&] { read_bone(extra); });
        });
        for (const Extra& extra : joints_) guard("constraints left out", extra.place, [&] { read_constraints(extra); });
        for (const Extra& extra : chains_) guard("chains left out", extra.place, [&] { read_chains(extra); });
        tell_apart();
        for (NamedChain& named : found_) {
            if (!claims_.chains.insert(named.chain.name).second) continue;
            scene_.chains.push_back(std::move(named.chain));
        }
    }

private:
    [[nodiscard]] std::string name_of(std::uint32_t joint) const {
        const std::string& name = scene_.joints[joint].name;
        return name.empty() ? '#' + std::to_string(joint) : key(name);
    }

    /// Runs `work`. On failure, reports the error, returns false, and the import continues.
    template <class Work>
    bool guard(const char* left_out, const std::string& place, Work work) {
        try {
            work();
            return true;
        } catch (const Failure& failure) {
            report_.warn(std::string(left_out) + ": " + failure.error.message,
                         failure.error.place.empty() ? place : failure.error.place);
            return false;
        }
    }

    void gather(const std::string& extras, std::uint32_t joint, const std::string& place) {
        if (extras.find("rig_") == std::string::npos) return;
        const auto value = parse_json_text<OrderedJson>(extras, report_);
        if (!value.is_object()) return;
        for (auto member = value.begin(); member != value.end(); ++member) {
            const bool is_joint = member.key() == "rig_joint" && joint != kNone;
            if (!is_joint && member.key() != "rig_ik") continue;
            Extra extra{joint, place, *member};
            extra.place.append(".").append(member.key());
            guard("extras left out", extra.place, [&] {
                if (member->is_string()) extra.value = parse_json_text<OrderedJson>(member->text(), report_);
                (is_joint ? joints_ : chains_).push_back(extra);
            });
        }
    }

    void read_bone(const Extra& extra) {
        Fields fields(extra.value, extra.place, Notation::extras);
        read_notes(fields);
        fields.read("stretch", rig_.stretch[extra.joint], 0.0f);
        if (fields.find("rest_orientation") == nullptr) return;
        std::array<float, 4> written{};
        fields.read_rotation("rest_orientation", written);
        const Rotation then = to_rotation(written);
        if (!is_turned(then, rest_.turn(extra.joint))) return;
        rig_.axes[extra.joint] = then;
        report_.warn("the joint's axes are others than when its limits were written; the limits are turned back",
                     extra.place + ".rest_orientation");
    }

    static bool is_turned(const Rotation& then, const Rotation& now) {
        constexpr double kTurned = 1e-3;  // radians
        const Rotation between = glm::conjugate(now) * then;
        return 2.0 * trig::atan2(glm::length(glm::dvec3(between.x, between.y, between.z)), std::abs(between.w)) >
               kTurned;
    }

    void read_constraints(const Extra& extra) {
        if (claims_.joints[extra.joint]) return;
        Fields fields(extra.value, extra.place, Notation::extras);
        std::vector<ConstraintRecord> constraints;
        if (const OrderedJson* own = fields.find("limits"); own != nullptr) {
            constraints = parse_constraints(*own, fields.place_of("limits"), Notation::extras);
        } else {
            constraints = read_blender_limits(fields, axes_of_bone(extra.joint), report_);
            if (constraints.empty()) return;
        }
        const Rotation& then = rig_.axes[extra.joint];
        const Rotation& now = rest_.turn(extra.joint);
        for (ConstraintRecord& constraint : constraints) {
            if (is_turned(then, now))
                constraint.frame = to_record(glm::conjugate(now) * then * to_rotation(constraint.frame));
            check_constraint_at(constraint, extra.place);
            flag_rest_outside(constraint, scene_.joints[extra.joint].name, extra.place, report_);
        }
        claims_.joints[extra.joint] = true;
        scene_.joints[extra.joint].constraints = std::move(constraints);
    }

    /// Reads the notes of the tool that wrote the rig.
    void read_notes(Fields& fields) {
        const OrderedJson* notes = fields.find("notes");
        if (notes == nullptr) return;
        for (const OrderedJson& note : need_list(*notes, fields.place_of("notes"))) {
            if (!note.is_string()) continue;
            std::string text = note.text();
            std::replace_if(
                text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
            report_.warn(std::move(text), fields.place());
        }
    }

    [[nodiscard]] BoneAxes axes_of_bone(std::uint32_t joint) const {
        const Rotation& axes = rig_.axes[joint];
        const std::uint32_t armature = armature_of_[joint];
        return {axes, armature == kNone ? axes : glm::conjugate(rest_.turn(armature)) * axes};
    }

    /// Finds the node above the bones: above the topmost joint of a skin.
    void find_armatures() {
        std::vector<bool> is_bound(scene_.joints.size());
        for (const Mesh& mesh : scene_.meshes) {
            for (const std::uint32_t joint : mesh.palette.joints) is_bound[joint] = true;
        }
        std::vector<bool> is_bone(scene_.joints.size());
        armature_of_.assign(scene_.joints.size(), kNone);
        for (std::uint32_t joint = 0; joint < scene_.joints.size(); ++joint) {
            const std::uint32_t parent = scene_.joints[joint].parent;
            const bool is_below = parent != kNone && is_bone[parent];
            is_bone[joint] = is_below || is_bound[joint];
            if (is_bone[joint]) armature_of_[joint] = is_below ? armature_of_[parent] : parent;
        }
    }

    void read_chains(const Extra& extra) {
        Fields fields(extra.value, extra.place, Notation::extras);
        const OrderedJson& list = need_list(fields.need("chains"), fields.place_of("chains"));
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string place = at(fields.place_of("chains"), i);
            guard("chain left out", place, [&] {
                Fields chain(list[i], place, Notation::extras);
                const bool is_blenders = chain.find("joints") != nullptr;
                if (is_blenders) read_notes(chain);
                found_.push_back({is_blenders ? read_blender_chain(chain, extra.joint, rig_, budget_, report_)
                                              : resolve_chain(parse_chain(list[i], place, Notation::extras), scene_,
                                                              rig_.index, budget_),
                                  place});
            });
        }
    }

    /// Blender calls every chain "IK" by default: appends the effector's name to duplicates.
    void tell_apart() {
        std::unordered_map<std::string, std::size_t> count;
        for (const NamedChain& named : found_) ++count[named.chain.name];
        for (NamedChain& named : found_) {
            if (count[named.chain.name] == 1) continue;
            report_.warn("several chains are called " + quote(named.chain.name) + ": their effectors' names are added",
                         named.place);
            named.chain.name += '.' + scene_.joints[named.chain.record.effector].name;
        }
        std::unordered_map<std::string, std::size_t> met;
        for (NamedChain& named : found_) {
            const std::size_t before = met[named.chain.name]++;
            if (before > 0) named.chain.name += '.' + std::to_string(before + 1);
        }
    }

    Scene& scene_;
    Claims& claims_;
    Report& report_;
    RestFrames rest_;
    BlenderRig rig_;
    WorkBudget budget_;
    std::vector<std::uint32_t> armature_of_;  ///< by joint: the node above the bones; kNone: the joint is not a bone
    std::vector<Extra> joints_;
    std::vector<Extra> chains_;
    std::vector<NamedChain> found_;
};

}  // namespace

void attach_extras(Scene& scene, const JointIndex& index, Claims& claims, Report& report) {
    Attacher(scene, index, claims, report).attach();
}

}  // namespace bendy::converter
