#include "formats/x/conventions.h"
#include "parts.h"
#include "scene/evaluate.h"
#include "scene/failure.h"
#include "scene/frame_shapes.h"

#include <bendy/converter/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace bendy::converter::x_out {
namespace {

/// Key times in X-files are integers; a file has a single tick rate.
class Ticks {
public:
    /// Longer clips are left out.
    static constexpr float kLongest = 1e6f;  ///< seconds

    /// Chooses a frame rate that reproduces every key time of the scene exactly, if there is one; otherwise the largest
    /// power of two with which the longest clip fits in 31 bits, which rounds only times that are small in comparison.
    explicit Ticks(const Scene& scene);

    [[nodiscard]] std::uint32_t per_second() const { return per_second_; }
    [[nodiscard]] double seconds(std::uint64_t tick) const { return static_cast<double>(tick) / per_second_; }
    /// Converts ascending times from 0 on to strictly ascending ticks.
    /// \param rounded  counts the times that are not exact
    [[nodiscard]] std::vector<std::uint64_t> of(const std::vector<float>& times, float shift,
                                                std::uint64_t& rounded) const;

private:
    [[nodiscard]] bool is_exact(const Scene& scene) const;

    std::uint32_t per_second_ = 4800;
};

/// Frame rates that animators use, and common tick rates of X-files.
constexpr std::array<std::uint32_t, 14> kRates{24,  25,    30,    50,    60,    100,   120,
                                               240, 1'000, 3'000, 4'800, 6'000, 9'600, 48'000};
constexpr double kMostTicks = 2147483647.0;

/// The delay of a clip's times, in seconds, so that none is below 0.
float shift_of(const Clip& clip) {
    const float start = span_of(clip).start;
    return start < 0.0f ? -start : 0.0f;
}

bool is_left_out(const Clip& clip) {
    const ClipSpan span = span_of(clip);
    return !(span.end + shift_of(clip) <= Ticks::kLongest);
}

/// The nearest tick, clamped: inexact times may be negative or too large for the type.
std::uint64_t nearest(double time, std::uint32_t per_second) {
    return static_cast<std::uint64_t>(std::llround(std::clamp(time * per_second, 0.0, kMostTicks)));
}

Ticks::Ticks(const Scene& scene) {
    for (const std::uint32_t rate : kRates) {
        per_second_ = rate;
        if (is_exact(scene)) return;
    }
    double longest = 1.0;
    for (const Clip& clip : scene.clips) {
        if (!is_left_out(clip)) longest = std::max(longest, double{span_of(clip).end + shift_of(clip)});
    }
    per_second_ = 1;
    while (longest * per_second_ * 2 < kMostTicks / 2) per_second_ *= 2;
}

bool Ticks::is_exact(const Scene& scene) const {
    std::uint64_t rounded = 0;
    for (const Clip& clip : scene.clips) {
        if (is_left_out(clip)) continue;
        const float shift = shift_of(clip);
        if (double{span_of(clip).end + shift} * per_second_ > kMostTicks / 2) return false;
        for (const Track& track : clip.tracks) {
            if (track.path == TrackPath::weights) continue;
            static_cast<void>(of(track.times, shift, rounded));
            if (rounded != 0) return false;
        }
    }
    return true;
}

std::vector<std::uint64_t> Ticks::of(const std::vector<float>& times, float shift, std::uint64_t& rounded) const {
    std::vector<std::uint64_t> ticks;
    ticks.reserve(times.size());
    for (const float time : times) {
        std::uint64_t tick = nearest(double{time} + shift, per_second_);
        if (!ticks.empty()) tick = std::max(tick, ticks.back() + 1);
        ticks.push_back(tick);
        if (static_cast<float>(seconds(tick)) != time + shift) ++rounded;
    }
    return ticks;
}

constexpr double kSamplesPerSecond = 60.0;  ///< for a cubic track
constexpr double kMostSamples = 64.0;       ///< between two of its keys

/// Linear keys, ready to be written.
struct Keys {
    std::vector<std::uint64_t> ticks;
    std::vector<float> values;
};

/// The number of a key type in X-files.
int type_of(TrackPath path) {
    return path == TrackPath::rotation ? 0 : path == TrackPath::scale ? 1 : 2;
}

class AnimationExporter {
public:
    AnimationExporter(const Scene& scene, const Names& names, Text& text, Report& report)
        : scene_(scene), names_(names), text_(text), report_(report), ticks_(scene) {}

    void run() {
        if (scene_.clips.empty()) return;
        text_.open("AnimTicksPerSecond");
        text_.line(std::to_string(ticks_.per_second()) + ';');
        text_.close();
        for (std::size_t i = 0; i < scene_.clips.size(); ++i) write(scene_.clips[i], names_.clips[i], at("clips", i));
    }

private:
    using TracksOfJoint = std::array<const Track*, 3>;  ///< by key type

    void write(const Clip& clip, const std::string& identifier, const std::string& place) {
        shift_ = shift_of(clip);
        std::map<std::uint32_t, TracksOfJoint> joints;
        std::uint64_t weights = clip.plays.size();
        for (const Track& track : clip.tracks) {
            if (track.path == TrackPath::weights) {
                ++weights;
            } else {
                joints[track.target][static_cast<std::size_t>(type_of(track.path))] = &track;
            }
        }
        if (weights != 0) report_.warn("weights of morph targets left out of a clip", place, weights);
        if (!clip.curves.empty()) {
            report_.warn("named curves left out of a clip: X-files have no place for them", place, clip.curves.size());
        }
        if (!(span_of(clip).end + shift_ <= Ticks::kLongest)) {
            report_.warn("a clip of more than a million seconds is left out", place);
            return;
        }
        if (joints.empty()) {
            report_.warn("a clip that moves no joint is left out", place);
            return;
        }
        if (span_of(clip) != span_of_tracks(clip))
            report_.warn("clip that is longer than its keys is written as long as they are", place);
        if (shift_ > 0.0f) report_.warn("clip that begins before 0 s is moved to begin there", place);
        if (!clip.extras.empty() || !clip.more.empty())
            report_.warn("extras of a clip left out: X-files have no place for it", place);
        rounded_ = 0;
        text_.open("AnimationSet", identifier);
        for (const auto& [joint, tracks] : joints) write_joint(joint, tracks, clip, place);
        text_.close();
        if (rounded_ != 0) report_.warn("key time rounded to a tick of the file", place, rounded_);
        if (identifier == clip.name) return;
        text_.open("BendyClip");
        text_.line('"' + identifier + "\";");
        text_.line('"' + x::encode_text(clip.name) + "\";");
        text_.close();
    }

    /// Writes all three kinds of keys: readers differ in how they treat a missing one.
    void write_joint(std::uint32_t joint, const TracksOfJoint& tracks, const Clip& clip, const std::string& place) {
        const Transform& rest = scene_.joints[joint].rest;
        if (rest.shear != glm::vec3(0.0f))
            report_.warn("shear of an animated joint is left out while it moves", at("joints", joint));
        text_.open("Animation");
        text_.line("{ " + names_.joints[joint] + " }");
        text_.open("AnimationOptions");
        text_.line(clip.loop ? "0;" : "1;");
        text_.line("1;");
        text_.close();
        const std::uint64_t start = ticks_.of({span_of(clip).start}, shift_, unheard_).front();
        const auto write = [&](int type, std::vector<float> resting) {
            const Track* track = tracks[static_cast<std::size_t>(type)];
            write_keys(type, track != nullptr ? keys_of(*track, place) : Keys{{start}, std::move(resting)});
        };
        write(0, {rest.rotation.x, rest.rotation.y, rest.rotation.z, rest.rotation.w});
        write(1, {rest.scale.x, rest.scale.y, rest.scale.z});
        write(2, {rest.translation.x, rest.translation.y, rest.translation.z});
        text_.close();
    }

    Keys keys_of(const Track& track, const std::string& place) {
        const std::vector<std::uint64_t> ticks = ticks_.of(track.times, shift_, rounded_);
        if (track.interpolation == Interpolation::linear) return {ticks, track.values};
        if (track.interpolation == Interpolation::step) {
            report_.warn("track that jumps gets two keys for each jump, a tick apart", place);
            return jumping(track, ticks);
        }
        report_.warn("cubic track is sampled, 60 times a second: X-files have linear keys only", place);
        return sampled(track, ticks);
    }

    static Keys jumping(const Track& track, const std::vector<std::uint64_t>& ticks) {
        Keys keys;
        const auto add = [&](std::uint64_t tick, std::size_t key) {
            const auto first = track.values.begin() + static_cast<std::ptrdiff_t>(key * track.components);
            keys.ticks.push_back(tick);
            keys.values.insert(keys.values.end(), first, first + track.components);
        };
        for (std::size_t key = 0; key < ticks.size(); ++key) {
            if (key > 0 && ticks[key] - 1 > ticks[key - 1]) add(ticks[key] - 1, key - 1);
            add(ticks[key], key);
        }
        return keys;
    }

    /// Samples a cubic track. Where a rotation spline passes through (0, 0, 0, 0), it is the identity, as in the
    /// runtime.
    [[nodiscard]] Keys sampled(const Track& track, const std::vector<std::uint64_t>& ticks) const {
        Keys keys;
        std::vector<double> value;
        const auto add = [&](std::uint64_t tick) {
            evaluate_track(track, ticks_.seconds(tick) - shift_, value);
            if (track.path == TrackPath::rotation && value == std::vector{0.0, 0.0, 0.0, 0.0}) value[3] = 1.0;
            keys.ticks.push_back(tick);
            for (const double component : value) keys.values.push_back(static_cast<float>(component));
        };
        for (std::size_t key = 0; key + 1 < ticks.size(); ++key) {
            const std::uint64_t span = ticks[key + 1] - ticks[key];
            const double wanted = std::clamp(std::ceil(ticks_.seconds(span) * kSamplesPerSecond), 1.0, kMostSamples);
            const std::uint64_t pieces = std::min(static_cast<std::uint64_t>(wanted), span);
            for (std::uint64_t piece = 0; piece < pieces; ++piece) add(ticks[key] + span * piece / pieces);
        }
        add(ticks.back());
        return keys;
    }

    /// Writes keys; rotations as w x y z of the mirrored, inverse rotation, see add_value of the reader.
    void write_keys(int type, const Keys& keys) {
        const std::size_t components = type == 0 ? 4 : 3;
        text_.open("AnimationKey");
        text_.line(std::to_string(type) + ';');
        text_.line(std::to_string(keys.ticks.size()) + ';');
        for (std::size_t key = 0; key < keys.ticks.size(); ++key) {
            const float* const value = keys.values.data() + key * components;
            text_.begin_line();
            text_.add(keys.ticks[key]).add(";").add(std::uint64_t{components}).add(";");
            if (type == 0) {
                text_.add(value[3]).add(",").add(value[0]).add(",").add(value[1]).add(",").add(0.0f - value[2]);
            } else {
                text_.add(value[0]).add(",").add(value[1]).add(",").add(type == 2 ? 0.0f - value[2] : value[2]);
            }
            text_.add(key + 1 < keys.ticks.size() ? ";;," : ";;;");
            text_.end_line();
        }
        text_.close();
    }

    const Scene& scene_;
    const Names& names_;
    Text& text_;
    Report& report_;
    Ticks ticks_;
    float shift_ = 0.0f;         ///< seconds, of the current clip
    std::uint64_t rounded_ = 0;  ///< inexact key times in it
    std::uint64_t unheard_ = 0;
};

}  // namespace

void write_clips(const Scene& scene, const Names& names, Text& text, Report& report) {
    AnimationExporter(scene, names, text, report).run();
}

}  // namespace bendy::converter::x_out
