#include "convert_input.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace bendy::fuzz {
namespace {

/// The bits of the tail's first two bytes.
enum Switch : unsigned {
    kCompact = 1u << 0,
    kLod = 1u << 1,
    kAutoRig = 1u << 2,
    kAutoSkin = 1u << 3,
    kMergeClips = 1u << 4,
    kInstances = 1u << 5,
    kKeepOrder = 1u << 6,
    kWithRig = 1u << 7,
    kSkeleton = 1u << 8,
    kScene = 1u << 9,
    kTicks = 1u << 10,
    kLeaveImages = 1u << 11,
    kDropUnused = 1u << 12
};

}  // namespace

ConvertInput ConvertInput::split(std::span<const std::uint8_t> bytes) {
    static constexpr std::string_view kNoOptions("\0\0\0\0\0\0\0\0", kTail);
    const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (all.size() < kTail) return {all, {}, kNoOptions};
    const std::string_view tail = all.substr(all.size() - kTail);
    const std::string_view rest = all.substr(0, all.size() - kTail);
    std::uint32_t length = 0;
    std::memcpy(&length, tail.data() + kOptions, sizeof length);
    const std::size_t rig = std::min<std::size_t>(length, rest.size());
    return {rest.substr(0, rest.size() - rig), rest.substr(rest.size() - rig), tail};
}

converter::ConvertOptions ConvertInput::options() const {
    const auto byte = [&](std::size_t at) -> unsigned { return static_cast<unsigned char>(tail[at]); };
    const unsigned switches = byte(0) | byte(1) << 8u;
    const auto is_on = [&](Switch one) { return (switches & one) != 0; };
    const std::string number = std::to_string(byte(3) / 16);
    constexpr std::array<converter::ErrorBound, 8> kBounds{{{5e-5, true},
                                                            {1e-4, false},
                                                            {1e-9, false},
                                                            {1.0, true},
                                                            {10.0, true},
                                                            {1e-30, false},
                                                            {1e30, false},
                                                            {0.01, true}}};
    converter::ConvertOptions options;
    options.auto_rig = is_on(kAutoRig);
    options.auto_skin = is_on(kAutoSkin);
    options.merge_clips = is_on(kMergeClips);
    options.lod = is_on(kLod);
    options.keep_order = is_on(kKeepOrder);
    options.drop_unused = is_on(kDropUnused);
    options.gltf.instances = is_on(kInstances);
    options.gltf.embed_images = !is_on(kLeaveImages);
    if (is_on(kCompact)) options.compact = kBounds[byte(2) % kBounds.size()];
    if (is_on(kAutoSkin) && is_on(kSkeleton)) options.skeleton = "#" + number;
    if (is_on(kScene)) options.gltf.scene = number;
    if (is_on(kTicks)) options.ticks_per_second = 1.0 + byte(3);
    if (is_on(kWithRig)) {
        options.rig = "rig.json";
        options.rig_text = std::string(rig);
    }
    return options;
}

unsigned ConvertInput::choice() const {
    return static_cast<unsigned char>(tail[3]);
}

std::string join(std::string_view source, std::string_view rig, std::string_view tail) {
    std::string all = std::string(source).append(rig).append(tail);
    const auto length = static_cast<std::uint32_t>(rig.size());
    std::memcpy(all.data() + all.size() - ConvertInput::kTail + ConvertInput::kOptions, &length, sizeof length);
    return all;
}

}  // namespace bendy::fuzz
