#include "conventions.h"
#include "object_reader.h"
#include "rig_fields.h"
#include "rigging/rig/parse_rig.h"
#include "scene/failure.h"
#include "scene/source/normalise.h"
#include "scene/source/source_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>

namespace bendy::converter::x {
namespace {

/// Reads the fields that rig_fields.h visits.
class FieldReader {
public:
    explicit FieldReader(ObjectReader& in) : in_(in) {}

    void word(const char* field, std::span<const std::string_view> words, std::uint8_t& number) {
        const std::string_view text = in_.string();
        const auto found = std::find(words.begin(), words.end(), text);
        if (found == words.end()) in_.refuse(std::string(field) + ": unknown word " + quote(text));
        number = static_cast<std::uint8_t>(found - words.begin());
    }
    template <class Integer>
    void integer(const char* field, Integer& number, std::uint32_t most) {
        const std::uint32_t read = in_.integer();
        if (read > most) in_.refuse(std::string(field) + ": at most " + std::to_string(most) + " is allowed");
        number = static_cast<Integer>(read);
    }
    void number(const char* field, float& number, float low, float high) {
        number = in_.number();
        const std::string name(field);
        if (!(number >= low && number <= high)) in_.refuse(name + ": the number is out of range");
    }
    template <std::size_t N>
    void numbers(const char* field, std::array<float, N>& numbers, float low, float high) {
        for (float& component : numbers) number(field, component, low, high);
    }
    void ranges(const char* /*field*/, std::array<float, 3>& numbers) {
        for (float& number : numbers) {
            number = in_.number();
            if (std::abs(number) == kMost) number = std::copysign(ConstraintRecord::kFree, number);
        }
    }
    void text(const char* /*field*/, std::string& text) { text = decode_text(in_.string()); }
    void frame(const char* /*field*/, std::string& identifier) { identifier = in_.string(); }
    void weights(const char* field, std::vector<std::pair<std::string, float>>& weights) {
        const std::uint32_t count = in_.count(2, "weights");
        for (std::uint32_t i = 0; i < count; ++i) {
            std::string frame(in_.string());
            float weight = 0.0f;
            number(field, weight, 0.0f, 1.0f);
            weights.emplace_back(std::move(frame), weight);
        }
    }

private:
    ObjectReader& in_;
};

/// Normalises a rotation; one that is already unit keeps its bits.
void normalise(std::array<float, 4>& rotation, const std::string& place) {
    const UnitQuaternion unit = make_unit({rotation[0], rotation[1], rotation[2], rotation[3]});
    if (unit.length == 0.0) fail(place, "one of its rotations is (0, 0, 0, 0)");
    for (int i = 0; i < 4; ++i) rotation[static_cast<std::size_t>(i)] = unit.value[i];
}

}  // namespace

Constraint read_constraint(ObjectReader& in) {
    Constraint constraint;
    constraint.place = in.place();
    in.head();
    FieldReader fields(in);
    visit_constraint(fields, constraint.record);
    in.end_of("BendyConstraint");
    normalise(constraint.record.frame, constraint.place);
    check_constraint_at(constraint.record, constraint.place);
    return constraint;
}

IkChain read_chain(ObjectReader& in) {
    IkChain chain;
    chain.place = in.place();
    in.head();
    FieldReader fields(in);
    visit_chain(fields, chain);
    in.end_of("BendyIkChain");
    normalise(chain.record.tip_rotation, chain.place);
    return chain;
}

namespace {

constexpr std::array<std::uint32_t, 4> kNumbersOfType{4, 3, 3, 16};

/// Reads an AnimationKey. Types 3 and 4 both mean a matrix.
void read_keys(ObjectReader& in, Animation& animation) {
    in.head();
    const std::uint32_t type = in.integer();
    if (type > 4) in.refuse("unknown key type " + std::to_string(type));
    const std::size_t kind = type == 4 ? 3 : type;
    const std::uint32_t numbers = kNumbersOfType[kind];
    const std::uint32_t count = in.count(2 + numbers, "keys");
    Keys keys;
    keys.times.reserve(count);
    keys.values.reserve(std::size_t{count} * numbers);
    for (std::uint32_t key = 0; key < count; ++key) {
        keys.times.push_back(in.exact_number());
        if (const std::uint32_t said = in.integer(); said != numbers) {
            in.refuse("a key of type " + std::to_string(type) + " has " + std::to_string(numbers) + " numbers, not " +
                      std::to_string(said));
        }
        for (std::uint32_t i = 0; i < numbers; ++i) keys.values.push_back(in.number());
    }
    in.end_of("AnimationKey");
    if (!animation.keys[kind].times.empty())
        in.report().warn("second AnimationKey of its type in an animation: the last is taken", in.place());
    animation.keys[kind] = std::move(keys);
}

Animation read_animation(ObjectReader& in, AnimationSet& set) {
    Animation animation;
    animation.place = in.place();
    in.head();
    std::string_view type;
    while (in.inner(type, "Animation")) {
        if (type == "AnimationKey") {
            read_keys(in, animation);
        } else if (type == "{") {
            animation.frame = in.reference();
        } else if (type == "AnimationOptions") {
            in.head();
            set.loops = in.integer() == 0 || set.loops;  // 0: closed
            in.integer();                                // spline or linear positions: always linear
            in.end_of("AnimationOptions");
        } else {
            in.skip_unknown(type);
        }
    }
    return animation;
}

}  // namespace

AnimationSet read_animation_set(ObjectReader& in) {
    AnimationSet set;
    set.place = in.place();
    set.identifier = in.head();
    set.name = to_utf8(set.identifier, set.place, in.report());
    std::string_view type;
    while (in.inner(type, "AnimationSet")) {
        if (type == "Animation") {
            set.animations.push_back(read_animation(in, set));
        } else {
            in.skip_unknown(type);
        }
    }
    return set;
}

namespace {

class Reader {
public:
    Reader(std::string_view file, Report& report) : in_(file, report) {}

    XFile read() {
        for (;;) {
            const Token& token = in_.next();
            switch (token.kind) {
                case Token::Kind::end:
                    if (!open_.empty()) in_.refuse("the file ends inside a Frame");
                    return std::move(out_);
                case Token::Kind::close:
                    if (open_.empty()) in_.refuse("there is a '}' without a '{'");
                    open_.pop_back();
                    break;
                case Token::Kind::open:
                    if (open_.empty()) in_.refuse("there is a '{' without a data object's type");
                    in_.skip_unknown("{");
                    break;
                case Token::Kind::uuid:
                    break;
                case Token::Kind::word:
                    read_object(token.text);
                    break;
                default:
                    in_.refuse("expected a data object");
            }
        }
    }

private:
    void read_object(std::string_view type) {
        const bool is_top = open_.empty();
        if (type == "Frame") {
            begin_frame();
        } else if (type == "Mesh") {
            out_.meshes.push_back(read_mesh(in_, out_.materials));
            out_.meshes.back().frame = is_top ? kNone : open_.back();
        } else if (!is_top && type == "FrameTransformMatrix") {
            in_.head();
            for (double& number : out_.frames[open_.back()].matrix) number = in_.exact_number();
            in_.end_of("FrameTransformMatrix");
        } else if (!is_top && type == "BendyName") {
            out_.frames[open_.back()].name = read_name(in_);
        } else if (!is_top && type == "BendyConstraint") {
            out_.constraints.push_back(read_constraint(in_));
            out_.constraints.back().frame = open_.back();
        } else if (is_top) {
            read_global(type);
        } else {
            in_.skip_unknown(type);
        }
    }

    void read_global(std::string_view type) {
        if (type == "template" || type == "Header") {
            in_.skip(type);
        } else if (type == "Material") {
            out_.materials.push_back(read_material(in_));
        } else if (type == "AnimTicksPerSecond") {
            in_.head();
            out_.ticks_per_second = in_.exact_number();
            // A binary file's integers have no sign.
            if (out_.ticks_per_second >= 0x1p31) out_.ticks_per_second -= 0x1p32;
            out_.ticks_place = in_.place();
            in_.end_of("AnimTicksPerSecond");
        } else if (type == "AnimationSet") {
            out_.sets.push_back(read_animation_set(in_));
        } else if (type == "BendyIkChain") {
            out_.chains.push_back(read_chain(in_));
        } else if (type == "BendyClip") {
            in_.head();
            std::string set(in_.string());
            out_.clip_names.emplace_back(std::move(set), decode_text(in_.string()));
            in_.end_of("BendyClip");
        } else {
            in_.skip_unknown(type);
        }
    }

    void begin_frame() {
        if (out_.frames.size() == kMaxJoints)
            in_.refuse("there are more than " + std::to_string(kMaxJoints) + " frames");
        Frame frame;
        frame.place = in_.place();
        frame.identifier = in_.head();
        frame.name = to_utf8(frame.identifier, frame.place, in_.report());
        frame.parent = open_.empty() ? kNone : open_.back();
        open_.push_back(static_cast<std::uint32_t>(out_.frames.size()));
        out_.frames.push_back(std::move(frame));
    }

    ObjectReader in_;
    XFile out_;
    std::vector<std::uint32_t> open_;  ///< stack of frames, the innermost last
};

}  // namespace

XFile read_x_file(std::string_view file, Report& report) {
    return Reader(file, report).read();
}

}  // namespace bendy::converter::x
