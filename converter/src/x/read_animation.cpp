#include "read_animation.h"

#include "encoded_text.h"

#include <array>
#include <string>
#include <utility>

namespace bendy::converter::x {
namespace {

constexpr std::array<std::uint32_t, 4> kNumbersOfType{4, 3, 3, 16};

/// AnimationKey. Types 3 and 4 both mean a matrix.
void read_keys(ObjectReader& in, Animation& animation) {
    in.head();
    const std::uint32_t type = in.integer();
    if (type > 4) in.refuse("there are no keys of type " + std::to_string(type));
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
            in.integer();                                // spline or linear positions: linear
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
    set.name = to_utf8(set.identifier);
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

}  // namespace bendy::converter::x
