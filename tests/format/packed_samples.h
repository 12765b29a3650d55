#pragma once

#include <bendy/format/packed_clip.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bendy::test {

/// Numbers that look random and are the same everywhere.
class Noise {
public:
    explicit Noise(std::uint32_t seed) : state_(seed) {}
    std::int32_t next(std::int32_t below) {
        state_ = state_ * 1664525u + 1013904223u;
        return static_cast<std::int32_t>((state_ >> 8) % static_cast<std::uint32_t>(below));
    }

private:
    std::uint32_t state_;
};

/// Tracks in all lists, for `joints` joints: more than a group where that is many; walks of random steps.
inline PackedSamples make_samples(std::uint32_t joints, std::uint32_t frames, std::uint32_t segment_frames) {
    PackedSamples samples;
    samples.frames = frames;
    samples.start = 0.5f;
    samples.frame_rate = 24.0f;
    samples.joints = joints;
    samples.segment_frames = segment_frames;
    Noise noise(frames * 31 + joints);
    for (const PackedKind& kind : kPackedKinds) {
        for (std::uint32_t joint = 0; joint < joints; ++joint) {
            const bool animated = joint % 3 != 0;
            const bool even = joint % 2 == 0;
            if (kind.animated != animated) continue;
            if (kind.path == TrackPath::scale && (kind.components == 1) != even) continue;
            PackedTrack track;
            track.path = kind.path;
            track.joint = joint;
            track.components = kind.components;
            track.animated = animated;
            for (std::uint32_t c = 0; c < 3; ++c)
                track.steps[c] = static_cast<std::uint8_t>(c < kind.components ? 112 + noise.next(12) : 160);
            for (std::uint32_t c = 0; c < kind.components; ++c) {
                std::int32_t at = noise.next(2000) - 1000;
                for (std::uint32_t f = 0; f < (animated ? frames : 1); ++f) {
                    track.numbers.push_back(at);
                    at += noise.next(2 << (joint % 7)) - (1 << (joint % 7));
                }
            }
            samples.tracks.push_back(track);
        }
    }
    return samples;
}

}  // namespace bendy::test
