#include <bendy/converter/write_rig.h>

#include "clips.h"
#include "joint_key.h"
#include "record_lines.h"
#include "scene/failure.h"
#include "scene/json_text.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <vector>

namespace bendy::converter {
namespace {

/// Extras of other writers may not be JSON; such text is written as a string.
std::string write_extras(std::string_view extras) {
    try {
        Report unheard;
        return parse_json_text<OrderedJson>(extras, unheard).dump();
    } catch (const Failure&) {
        return json_text(extras);
    }
}

class Writer {
public:
    explicit Writer(const ObjectView& object)
        : object_(object), weights_(object.chains.size(), RecordLine(Notation::rig_file)) {
        for (const JointView& joint : object.skeleton.joints) ++count_[joint.name];
        for (const ChainWeightView& chain_weight : object.skeleton.chain_weights)
            weights_[chain_weight.chain].add(key_of(chain_weight.joint), json_text(chain_weight.weight));
    }

    /// \param with_markers  also writes the roles of joints, and the markers and curves of all clips
    std::string write(bool with_markers) const {
        std::string text = "{\n  \"bendy_rig\": 1,\n  \"complete\": true";
        const std::vector<ConstraintView>& records = object_.skeleton.constraints;  // ordered by joint
        std::string entries;
        for (std::size_t i = 0; i < records.size();) {
            const std::uint32_t joint = records[i].joint;
            std::vector<std::string> constraints;
            for (; i < records.size() && records[i].joint == joint; ++i)
                constraints.push_back(write_constraint(records[i].record, Notation::rig_file));
            entries += (entries.empty() ? "\n    " : ",\n    ") + json_text(key_of(joint)) + ": ";
            entries += constraints.size() == 1 ? constraints.front() : '[' + joined(constraints) + "\n    ]";
        }
        if (!entries.empty()) text += ",\n  \"joints\": {" + entries + "\n  }";
        std::string chains;
        for (std::size_t i = 0; i < object_.chains.size(); ++i)
            chains += (chains.empty() ? "\n    " : ",\n    ") + write_chain(i);
        if (!chains.empty()) text += ",\n  \"chains\": [" + chains + "\n  ]";
        const std::string roles = with_markers ? write_roles() : std::string();
        if (!roles.empty()) text += ",\n  \"roles\": {" + roles + "\n  }";
        if (with_markers && object_.standing_pose) text += ",\n  \"standing_pose\": " + write_standing_pose();
        const std::string markers = with_markers ? write_markers() : std::string();
        if (!markers.empty()) text += ",\n  \"markers\": {" + markers + "\n  }";
        const std::string curves = with_markers ? write_curves() : std::string();
        if (!curves.empty()) text += ",\n  \"curves\": [" + curves + "\n  ]";
        return text + "\n}\n";
    }

private:
    static std::string joined(const std::vector<std::string>& lines) {
        std::string text;
        for (const std::string& line : lines) text += (text.empty() ? "\n      " : ",\n      ") + line;
        return text;
    }

    [[nodiscard]] bool is_named(std::uint32_t joint) const {
        const std::string_view name = object_.skeleton.joints[joint].name;
        return !name.empty() && count_.at(name) == 1;
    }

    /// The key of a joint in objects of joints and weights.
    [[nodiscard]] std::string key_of(std::uint32_t joint) const {
        return is_named(joint) ? escape_joint_name(object_.skeleton.joints[joint].name) : '#' + std::to_string(joint);
    }

    /// The name of a joint as a chain's start, effector, target or pole, where nothing is escaped.
    [[nodiscard]] std::string name_of(std::uint32_t joint) const {
        const std::string_view name = object_.skeleton.joints[joint].name;
        return is_named(joint) && means_itself(name) ? std::string(name) : '#' + std::to_string(joint);
    }

    /// The joint of each role; for a chain, the joints from the body outwards.
    [[nodiscard]] std::string write_roles() const {
        std::vector<RoleRecord> records(object_.roles.begin(), object_.roles.end());
        std::sort(records.begin(), records.end(), [](const RoleRecord& a, const RoleRecord& b) {
            return std::tie(a.role, a.place) < std::tie(b.role, b.place);
        });
        std::string text;
        for (std::size_t i = 0; i < records.size();) {
            const std::uint16_t role = records[i].role;
            std::string joints;
            for (; i < records.size() && records[i].role == role; ++i)
                joints += (joints.empty() ? "" : ", ") + json_text(name_of(records[i].joint));
            const bool is_list = role >= static_cast<std::uint16_t>(kFirstChainRole);
            text += (text.empty() ? "\n    " : ",\n    ") + json_text(kValueNames<Role>[role]) + ": ";
            text += is_list ? "[" : "";
            text += joints;
            text += is_list ? "]" : "";
        }
        return text;
    }

    [[nodiscard]] std::string write_standing_pose() const {
        RecordLine line(Notation::rig_file);
        add_standing_settings(line, object_.standing_pose->pose);
        std::string rotations;
        for (const StandingRotationRecord& record : object_.standing_pose->rotations) {
            rotations += (rotations.empty() ? "\n    " : ",\n    ") + json_text(name_of(record.joint)) + ": " +
                         json_list(record.rotation);
        }
        line.add("rotations", '{' + rotations + "\n  }");
        return line.text();
    }

    /// The entries of all clips that have markers.
    [[nodiscard]] std::string write_markers() const {
        const NameCounts count = count_clips();
        std::string text;
        for (std::size_t i = 0; i < object_.clips.size(); ++i) {
            const ClipView& clip = object_.clips[i];
            if (clip.markers.empty()) continue;
            const std::string key = clip_key(i, count);
            std::vector<std::string> entries;
            for (const bendy::Marker& marker : clip.markers) {
                RecordLine line(Notation::rig_file);
                line.add("time", json_text(marker.seconds));
                line.add("name", json_text(marker.name));
                entries.push_back(line.text());
            }
            text += (text.empty() ? "\n    " : ",\n    ") + json_text(key) + ": [" + joined(entries) + "\n    ]";
        }
        return text;
    }

    using NameCounts = std::unordered_map<std::string_view, std::size_t>;

    [[nodiscard]] NameCounts count_clips() const {
        NameCounts count;
        for (const ClipView& clip : object_.clips) ++count[clip.name];
        return count;
    }

    [[nodiscard]] std::string clip_key(std::size_t number, const NameCounts& count) const {
        const std::string_view name = object_.clips[number].name;
        const bool is_clear = !name.empty() && count.at(name) == 1 && means_itself(name);
        return is_clear ? std::string(name) : '#' + std::to_string(number);
    }

    /// The curves of all clips.
    [[nodiscard]] std::string write_curves() const {
        const NameCounts count = count_clips();
        std::string text;
        for (std::size_t i = 0; i < object_.clips.size(); ++i) {
            for (const CurveView& curve : object_.clips[i].curves)
                text += (text.empty() ? "\n    " : ",\n    ") + write_curve_entry(curve, clip_key(i, count));
        }
        return text;
    }

    [[nodiscard]] std::string write_curve_entry(const CurveView& curve, const std::string& clip) const {
        RecordLine line(Notation::rig_file);
        line.add("clip", json_text(clip));
        if (!curve.name.empty()) line.add("name", json_text(curve.name));
        line.add("path", json_text(curve.path));
        if (curve.kind != CurveTarget::nothing) {
            const bool is_joint = curve.kind == CurveTarget::joint;
            RecordLine target(Notation::rig_file);
            target.add(kValueNames<CurveTarget>[static_cast<std::size_t>(curve.kind)],
                       json_text(is_joint ? name_of(curve.target) : '#' + std::to_string(curve.target)));
            line.add("target", target.text());
        }
        if (curve.interpolation != Interpolation::linear) {
            line.add("interpolation",
                     json_text(kValueNames<Interpolation>[static_cast<std::size_t>(curve.interpolation)]));
        }
        std::vector<float> values;
        values.reserve(curve.value_count());
        for (std::size_t k = 0; k < curve.value_count(); ++k) values.push_back(curve.value(k));
        line.add("times", json_list(curve.times));
        line.add("values", json_list(values));
        return line.text();
    }

    [[nodiscard]] std::string write_chain(std::size_t number) const {
        const ChainView& chain = object_.chains[number];
        const ChainRecord& record = chain.record;
        RecordLine line(Notation::rig_file);
        line.add("name", json_text(chain.name));
        line.add("start", json_text(name_of(record.start)));
        line.add("effector", json_text(name_of(record.effector)));
        if (record.target != kNone) line.add("target", json_text(name_of(record.target)));
        if (record.pole != kNone) line.add("pole", json_text(name_of(record.pole)));
        add_chain_settings(line, record);
        if (!weights_[number].empty()) line.add("weights", weights_[number].text());
        if (!chain.extras.empty()) line.add("extras", write_extras(chain.extras));
        return line.text();
    }

    const ObjectView& object_;
    std::unordered_map<std::string_view, std::size_t> count_;  ///< joints by name
    std::vector<RecordLine> weights_;                          ///< by chain
};

}  // namespace

std::string write_rig(const ObjectView& object, bool with_markers) {
    return Writer(object).write(with_markers);
}

}  // namespace bendy::converter
