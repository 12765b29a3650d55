#include <bendy/converter/export.h>
#include <bendy/format/charconv.h>

#include "clips.h"
#include "fields.h"
#include "joint_key.h"
#include "scene/failure.h"
#include "scene/json_text.h"

#include <bendy/format/constraint.h>

#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace bendy::converter {
namespace {

bool is_same(float a, float b) {
    return bit_cast<std::uint32_t>(a) == bit_cast<std::uint32_t>(b);
}

/// The shortest text of a double. A zero keeps its sign, which JSON integers would lose.
std::string shortest(double number) {
    if (number == 0.0) return std::signbit(number) ? "-0.0" : "0";
    const bool is_handy = std::abs(number) >= 1e-6 && std::abs(number) < 1e15;
    std::array<char, 40> text{};
    char* const end = text.data() + text.size();
    const auto written =
        is_handy ? to_chars(text.data(), end, number, std::chars_format::fixed) : to_chars(text.data(), end, number);
    return {text.data(), written.ptr};
}

double rounded(double number, int digits) {
    std::array<char, 40> text{};
    const auto written =
        to_chars(text.data(), text.data() + text.size(), number, std::chars_format::scientific, digits - 1);
    double back = 0.0;
    from_chars(text.data(), written.ptr, back);
    return back;
}

/// The fewest digits that convert back to the same float.
template <class Back>
std::string fewest_digits(double number, float wanted, Back back) {
    constexpr int kAlwaysEnough = 17;
    int digits = 1;
    while (digits < kAlwaysEnough && !is_same(static_cast<float>(back(rounded(number, digits))), wanted)) ++digits;
    return shortest(rounded(number, digits));
}

std::string plain(float number) {
    if (std::isinf(number)) return "null";
    return fewest_digits(number, number, [](double read) { return read; });
}

std::string degrees(float radians) {
    if (std::isinf(radians)) return "null";
    return fewest_digits(radians / kRadiansPerDegree, radians, to_radians);
}

std::string json_string(std::string_view text) {
    return OrderedJson(text).dump();
}

template <class Number>
std::string list(std::span<const float> numbers, Number number) {
    std::string text;
    for (const float value : numbers) text += (text.empty() ? "" : ", ") + number(value);
    return '[' + text + ']';
}

/// An object on one line; members with default values are omitted.
class Line {
public:
    void add(std::string_view key, const std::string& value) {
        text_ += (text_.empty() ? "" : ", ") + json_string(key) + ": " + value;
    }
    void add_word(std::string_view key, std::span<const std::string_view> words, std::uint8_t number) {
        if (number != 0) add(key, json_string(words[number]));
    }
    void add_count(std::string_view key, unsigned number) {
        if (number != 0) add(key, std::to_string(number));
    }
    void add_number(std::string_view key, float number, float usual = 0.0f) {
        if (!is_same(number, usual)) add(key, plain(number));
    }
    void add_angle(std::string_view key, float angle, float usual = 0.0f) {
        if (!is_same(angle, usual)) add(key, degrees(angle));
    }
    template <std::size_t N, class Number>
    void add_list(std::string_view key, const std::array<float, N>& numbers, const std::array<float, N>& usual,
                  Number number) {
        for (std::size_t i = 0; i < N; ++i) {
            if (is_same(numbers[i], usual[i])) continue;
            add(key, list(numbers, number));
            return;
        }
    }
    template <class Number>
    void add_range(std::string_view key, float low, float high, Number number) {
        if (low == -ConstraintRecord::kFree && high == ConstraintRecord::kFree) return;
        add(key, list(std::array{low, high}, number));
    }
    void add_flag(std::string_view key, std::uint8_t flags, std::uint8_t flag) {
        if ((flags & flag) != 0) add(key, "true");
    }

    [[nodiscard]] bool empty() const { return text_.empty(); }
    [[nodiscard]] std::string text() const { return '{' + text_ + '}'; }

private:
    std::string text_;
};

std::string write_constraint(const ConstraintRecord& constraint) {
    const ConstraintRecord usual;
    const auto model = static_cast<ConstraintModel>(constraint.model);
    Line line;
    line.add("model", json_string(kValueNames<ConstraintModel>[constraint.model]));
    if (model == ConstraintModel::euler_box) line.add_word("order", kOrderNames, constraint.euler_order);
    line.add_word("scope", kValueNames<ConstraintScope>, constraint.scope);
    line.add_list("frame", constraint.frame, usual.frame, plain);
    if (model == ConstraintModel::largest_angle) {
        line.add_angle("angle", constraint.rotation_max[0], usual.rotation_max[0]);
    } else {
        for (std::size_t axis = 0; axis < limited_axes(model); ++axis)
            line.add_range(kAxisNames[axis], constraint.rotation_min[axis], constraint.rotation_max[axis], degrees);
    }
    Line translation;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        translation.add_range(kAxisNames[axis], constraint.translation_min[axis], constraint.translation_max[axis],
                              plain);
    }
    if (!translation.empty()) line.add("translation", translation.text());
    line.add_list("stiffness", constraint.stiffness, usual.stiffness, plain);
    line.add_list("preferred", constraint.preferred, usual.preferred, degrees);
    line.add_angle("soft_zone", constraint.soft_zone);
    line.add_flag("approximated", constraint.flags, kApproximated);
    line.add_flag("proposed", constraint.flags, kProposed);
    line.add_flag("rest_outside", constraint.flags, kRestOutside);
    return line.text();
}

class Writer {
public:
    explicit Writer(const ObjectView& object) : object_(object), weights_(object.chains.size()) {
        for (const JointView& joint : object.skeleton.joints) ++count_[joint.name];
        for (const ChainWeightView& chain_weight : object.skeleton.chain_weights)
            weights_[chain_weight.chain].add(key_of(chain_weight.joint), plain(chain_weight.weight));
    }

    /// \param with_markers  also writes the markers and curves of all clips
    std::string write(bool with_markers) const {
        std::string text = "{\n  \"bendy_rig\": 1,\n  \"complete\": true";
        const std::vector<ConstraintView>& records = object_.skeleton.constraints;  // ordered by joint
        std::string entries;
        for (std::size_t i = 0; i < records.size();) {
            const std::uint32_t joint = records[i].joint;
            std::vector<std::string> constraints;
            for (; i < records.size() && records[i].joint == joint; ++i)
                constraints.push_back(write_constraint(records[i].record));
            entries += (entries.empty() ? "\n    " : ",\n    ") + json_string(key_of(joint)) + ": ";
            entries += constraints.size() == 1 ? constraints.front() : '[' + joined(constraints) + "\n    ]";
        }
        if (!entries.empty()) text += ",\n  \"joints\": {" + entries + "\n  }";
        std::string chains;
        for (std::size_t i = 0; i < object_.chains.size(); ++i)
            chains += (chains.empty() ? "\n    " : ",\n    ") + write_chain(i);
        if (!chains.empty()) text += ",\n  \"chains\": [" + chains + "\n  ]";
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
                Line line;
                line.add("time", plain(marker.seconds));
                line.add("name", json_string(marker.name));
                entries.push_back(line.text());
            }
            text += (text.empty() ? "\n    " : ",\n    ") + json_string(key) + ": [" + joined(entries) + "\n    ]";
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
        Line line;
        line.add("clip", json_string(clip));
        if (!curve.name.empty()) line.add("name", json_string(curve.name));
        line.add("path", json_string(curve.path));
        if (curve.kind != CurveTarget::nothing) {
            const bool is_joint = curve.kind == CurveTarget::joint;
            Line target;
            target.add(kValueNames<CurveTarget>[static_cast<std::size_t>(curve.kind)],
                       json_string(is_joint ? name_of(curve.target) : '#' + std::to_string(curve.target)));
            line.add("target", target.text());
        }
        if (curve.interpolation != Interpolation::linear) {
            line.add("interpolation",
                     json_string(kValueNames<Interpolation>[static_cast<std::size_t>(curve.interpolation)]));
        }
        std::vector<float> values;
        values.reserve(curve.value_count());
        for (std::size_t k = 0; k < curve.value_count(); ++k) values.push_back(curve.value(k));
        line.add("times", list(curve.times, plain));
        line.add("values", list(values, plain));
        return line.text();
    }

    [[nodiscard]] std::string write_chain(std::size_t number) const {
        const ChainView& chain = object_.chains[number];
        const ChainRecord& record = chain.record;
        const ChainRecord usual;
        Line line;
        line.add("name", json_string(chain.name));
        line.add("start", json_string(name_of(record.start)));
        line.add("effector", json_string(name_of(record.effector)));
        if (record.target != kNone) line.add("target", json_string(name_of(record.target)));
        if (record.pole != kNone) line.add("pole", json_string(name_of(record.pole)));
        line.add_word("solver", kValueNames<Solver>, record.solver);
        line.add_count("iterations", record.iterations);
        line.add_count("priority", record.priority);
        line.add_number("tolerance", record.tolerance);
        line.add_list("pole_vector", record.pole_vector, usual.pole_vector, plain);
        line.add_angle("pole_angle", record.pole_angle);
        line.add_list("tip_offset", record.tip_offset, usual.tip_offset, plain);
        line.add_list("tip_rotation", record.tip_rotation, usual.tip_rotation, plain);
        line.add_number("position_weight", record.position_weight, usual.position_weight);
        line.add_number("rotation_weight", record.rotation_weight);
        line.add_number("influence", record.influence, usual.influence);
        line.add_number("stretch", record.stretch);
        line.add_number("compress", record.compress);
        if (!weights_[number].empty()) line.add("weights", weights_[number].text());
        line.add_flag("approximated", record.flags, kApproximated);
        line.add_flag("proposed", record.flags, kProposed);
        if (!chain.extras.empty()) line.add("extras", write_extras(chain.extras));
        return line.text();
    }

    /// Extras of other writers may not be JSON; such text is written as a string.
    static std::string write_extras(std::string_view extras) {
        try {
            Report unheard;
            return parse_json_text<OrderedJson>(extras, unheard).dump();
        } catch (const Failure&) {
            return json_string(extras);
        }
    }

    const ObjectView& object_;
    std::unordered_map<std::string_view, std::size_t> count_;  ///< joints by name
    std::vector<Line> weights_;                                ///< by chain
};

}  // namespace

std::string write_rig(const ObjectView& object, bool with_markers) {
    return Writer(object).write(with_markers);
}

}  // namespace bendy::converter
