#include "optimise/sample_limits.h"

#include "scene/frame_shapes.h"

#include <algorithm>
#include <limits>

namespace bendy::converter {
namespace {

constexpr double kFreeSamples = 1 << 20;    // joints and vertices posed, for any file
constexpr double kSamplesPerUnit = 128.0;   // additional ones per number of the clips and per byte of the meshes
constexpr double kMostKeys = 8.0;           // the work for keys may be this many times that for samples
constexpr double kFreeFrames = 1 << 18;     // joints held at once, for any file: 35 MB
constexpr double kFramesPerNumber = 3.0;    // additional ones per number of the clip
constexpr double kFramesPerByte = 0.5;      // additional ones per byte of the meshes
constexpr double kFreePoseBytes = 1 << 24;  // for any file
constexpr double kMostPoseBytes = 1 << 26;  // upper limit
constexpr double kPoseBytesPerUnit = 16.0;  // additional ones per number of the clips and per byte of the meshes

/// Total bytes of the meshes' positions, influences and targets.
double size_of_meshes(const Scene& scene) {
    std::size_t bytes = 0;
    for (const Mesh& mesh : scene.meshes) {
        bytes += mesh.positions.size() * sizeof(glm::vec3) + mesh.weights.size() * sizeof(float);
        for (const MorphTarget& target : mesh.targets) bytes += target.positions.size() * sizeof(glm::vec3);
    }
    return static_cast<double>(bytes);
}

double numbers_of(const Clip& clip) {
    std::size_t numbers = 0;
    for (const Track& track : clip.tracks) numbers += track.times.size() + track.values.size();
    return static_cast<double>(numbers);
}

/// The number of distinct key times.
double keys_of(const Clip& clip) {
    std::vector<float> times;
    const std::vector<float>* before = nullptr;
    for (const Track& track : clip.tracks) {
        if (before == nullptr || *before != track.times)
            times.insert(times.end(), track.times.begin(), track.times.end());
        before = &track.times;
    }
    std::sort(times.begin(), times.end());
    return static_cast<double>(std::unique(times.begin(), times.end()) - times.begin());
}

/// The cost of one pose in a clip: joints, tracks, and the vertices that targets may move.
double cost_of(const Scene& scene, const Clip& clip) {
    const double cost = static_cast<double>(std::max({scene.joints.size(), clip.tracks.size(), std::size_t{1}}));
    const bool has_weights =
        !clip.plays.empty() || std::any_of(clip.tracks.begin(), clip.tracks.end(),
                                           [](const Track& track) { return track.path == TrackPath::weights; });
    std::size_t vertices = 0;
    for (const Mesh& mesh : scene.meshes) {
        if (has_weights && !mesh.targets.empty()) vertices += mesh.positions.size();
    }
    return cost + static_cast<double>(vertices);
}

}  // namespace

WorkLimits find_limits(const Scene& scene) {
    const double bytes = size_of_meshes(scene);
    double numbers = 0.0;
    double samples = 0.0;
    double keys = 0.0;
    for (const Clip& clip : scene.clips) {
        const ClipSpan span = span_of(clip);
        const double cost = cost_of(scene, clip);
        numbers += numbers_of(clip);
        samples += (double{span.end} - span.start) * kSamplesPerSecond * cost;
        keys += keys_of(clip) * cost;
    }
    const double free = kFreeSamples + kSamplesPerUnit * bytes;
    const double allowed = free + kSamplesPerUnit * numbers;
    WorkLimits limits;
    limits.can_be_measured = keys <= kMostKeys * allowed;
    limits.pose_bytes =
        static_cast<std::size_t>(std::min(kFreePoseBytes + kPoseBytesPerUnit * (numbers + bytes), kMostPoseBytes));
    for (const Clip& clip : scene.clips) {
        const double own = numbers_of(clip);
        ClipLimits& limit = limits.clips.emplace_back();
        limit.samples = std::numeric_limits<std::size_t>::max();
        if (!(samples <= allowed)) {
            const double share = free / static_cast<double>(scene.clips.size()) + kSamplesPerUnit * own;
            limit.samples = static_cast<std::size_t>(share / cost_of(scene, clip)) + 1;
        }
        const double held = static_cast<double>(std::max({scene.joints.size(), clip.tracks.size(), std::size_t{1}}));
        limit.frames = static_cast<std::size_t>((kFreeFrames + kFramesPerNumber * own + kFramesPerByte * bytes) / held);
    }
    return limits;
}

}  // namespace bendy::converter
