// bendy_bench_acl [--max-error MM] [--rate HZ] FILE.bendy...: what ACL makes of the clips of exact bendy files, with
// its default settings. The error is for a shell of 3 % of the character's height around every joint, as in
// bendy_bench_compact_clips. ACL takes samples at an even rate: the one that most keys of a clip have, unless --rate
// gives another.
//
// The last two columns are the largest errors on the shell: ACL's own measure, which is from the samples and at the
// samples; and from the source, 240 times a second, which includes what the samples leave out.
#include "joint_transforms.h"

#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>

#include <acl/compression/compress.h>
#include <acl/compression/track_error.h>
#include <acl/core/ansi_allocator.h>
#include <acl/decompression/decompress.h>

#include <zstd.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace bendy;
using bench::local_of;
using bench::set_local;

constexpr float kShell = 0.03f;    // of the height
constexpr float kCheckRate = 240;  // per second, at which the source is compared
constexpr int kZstdLevel = 19;

[[noreturn]] void fail(const std::string& message) {
    std::fprintf(stderr, "bendy_bench_acl: %s\n", message.c_str());
    std::exit(1);
}

void sample_at(Pose& pose, const Clip& clip, float seconds) {
    if (!sample(pose, &clip, seconds)) fail("sample failed");
}

/// The largest extent of the rest pose's vertices along an axis.
float height_of(const Model& model) {
    Pose pose(model);
    std::vector<glm::vec3> positions(static_cast<std::size_t>(model.vertex_count()));
    if (positions.empty()) return 1.0f;
    if (!skin(pose, {.out = {.positions = positions}})) fail("skin failed");
    glm::vec3 low(1e30f), high(-1e30f);
    for (const glm::vec3& position : positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

/// The rate at which most keys follow one another.
float rate_of(const Clip& clip) {
    std::map<long, int> votes;
    for (const TrackView& track : clip.tracks) {
        if (track.path == TrackPath::weights) continue;
        if (track.times.empty()) return clip.frame_rate;
        for (std::size_t k = 1; k < track.times.size(); ++k)
            ++votes[std::lround(1.0f / (track.times[k] - track.times[k - 1]))];
    }
    const auto most =
        std::max_element(votes.begin(), votes.end(), [](auto& a, auto& b) { return a.second < b.second; });
    return votes.empty() ? 30.0f : static_cast<float>(std::max(most->first, 1L));
}

acl::track_array_qvvf make_samples(acl::ansi_allocator& allocator, const Model& model, const Clip& clip, float rate,
                                   float precision, float shell) {
    const auto samples = static_cast<std::uint32_t>(std::lround((clip.end - clip.start) * rate)) + 1;
    const auto joints = model.joints();
    acl::track_array_qvvf tracks(allocator, static_cast<std::uint32_t>(joints.size()));
    for (std::uint32_t joint = 0; joint < joints.size(); ++joint) {
        acl::track_desc_transformf description;
        description.output_index = joint;
        description.parent_index = joints[joint].parent == kNone ? acl::k_invalid_track_index : joints[joint].parent;
        description.precision = precision;
        description.shell_distance = shell;
        tracks[joint] = acl::track_qvvf::make_reserve(description, allocator, samples, rate);
    }
    Pose pose(model);
    for (std::uint32_t number = 0; number < samples; ++number) {
        sample_at(pose, clip, std::min(clip.end, clip.start + static_cast<float>(number) / rate));
        for (std::uint32_t joint = 0; joint < joints.size(); ++joint) {
            const JointTransform from = local_of(pose, joint);
            tracks[joint][number] =
                rtm::qvv_set(rtm::quat_set(from.rotation.x, from.rotation.y, from.rotation.z, from.rotation.w),
                             rtm::vector_set(from.translation.x, from.translation.y, from.translation.z),
                             rtm::vector_set(from.scale.x, from.scale.y, from.scale.z));
        }
    }
    return tracks;
}

/// Takes the transforms that ACL decompresses.
struct PoseWriter : acl::track_writer {
    explicit PoseWriter(Pose& written) : pose(written) {}
    Pose& pose;

    void RTM_SIMD_CALL write_rotation(std::uint32_t joint, rtm::quatf_arg0 q) {
        JointTransform transform = local_of(pose, joint);
        transform.rotation = glm::quat(rtm::quat_get_w(q), rtm::quat_get_x(q), rtm::quat_get_y(q), rtm::quat_get_z(q));
        set_local(pose, joint, transform);
    }
    void RTM_SIMD_CALL write_translation(std::uint32_t joint, rtm::vector4f_arg0 v) {
        JointTransform transform = local_of(pose, joint);
        transform.translation = {rtm::vector_get_x(v), rtm::vector_get_y(v), rtm::vector_get_z(v)};
        set_local(pose, joint, transform);
    }
    void RTM_SIMD_CALL write_scale(std::uint32_t joint, rtm::vector4f_arg0 v) {
        JointTransform transform = local_of(pose, joint);
        transform.scale = {rtm::vector_get_x(v), rtm::vector_get_y(v), rtm::vector_get_z(v)};
        set_local(pose, joint, transform);
    }
};

/// The largest distance of a point on the shell, in metres, between two poses of one model.
double distance_on_shell(Pose& a, Pose& b, float shell) {
    double worst = 0.0;
    for (std::size_t joint = 0; joint < a.model().joints().size(); ++joint) {
        const glm::mat4& one = a.model_space()[joint];
        const glm::mat4& other = b.model_space()[joint];
        for (int axis = 0; axis < 3; ++axis) {
            const float reach = shell / std::max(1e-9f, glm::length(glm::vec3(one[axis])));
            const glm::vec3 apart = glm::vec3(one[3] - other[3]) + reach * glm::vec3(one[axis] - other[axis]);
            worst = std::max(worst, static_cast<double>(glm::length(apart)));
        }
    }
    return worst;
}

/// Between the source and what was compressed of it.
template <class Context>
double error_of_source(const Model& model, const Clip& clip, Context& context, float shell) {
    Pose source(model), decompressed(model);
    double worst = 0.0;
    const int times = static_cast<int>(std::ceil(kCheckRate * (clip.end - clip.start)));
    for (int k = 0; k <= times; ++k) {
        const float seconds = (clip.end - clip.start) * static_cast<float>(k) / static_cast<float>(times);
        sample_at(source, clip, clip.start + seconds);
        context.seek(seconds, acl::sample_rounding_policy::none);
        PoseWriter writer(decompressed);
        context.decompress_tracks(writer);
        worst = std::max(worst, distance_on_shell(source, decompressed, shell));
    }
    return worst;
}

struct Bytes {
    std::size_t keys = 0, memory = 0, file = 0;
};

std::size_t bytes_under_zstd(const void* bytes, std::size_t size) {
    std::vector<char> packed(ZSTD_compressBound(size));
    return ZSTD_compress(packed.data(), packed.size(), bytes, size, kZstdLevel);
}

struct Options {
    float precision = 1e-4f;    // metres
    std::optional<float> rate;  // per second
};

/// Prints a row.
Bytes compress(const Model& model, const Clip& clip, const Options& options, float shell) {
    acl::ansi_allocator allocator;
    const float rate = options.rate.value_or(rate_of(clip));
    const acl::track_array_qvvf tracks = make_samples(allocator, model, clip, rate, options.precision, shell);
    acl::qvvf_transform_error_metric metric;
    acl::compression_settings settings = acl::get_default_compression_settings();
    settings.error_metric = &metric;
    acl::output_stats stats;
    acl::compressed_tracks* compressed = nullptr;
    const acl::error_result result = acl::compress_track_list(allocator, tracks, settings, compressed, stats);
    if (result.any()) fail(result.c_str());
    acl::decompression_context<acl::debug_transform_decompression_settings> context;
    context.initialize(*compressed);
    const acl::track_error error = acl::calculate_compression_error(allocator, tracks, context, metric);
    Bytes bytes;
    bytes.memory = compressed->get_size();
    bytes.file = bytes_under_zstd(compressed, bytes.memory);
    for (const TrackView& track : clip.tracks) {
        if (track.path != TrackPath::weights) bytes.keys += track.values.size_bytes();
    }
    std::printf("| %.*s | %.0f | %u | %zu | %zu | %zu | %.4f | %.4f |\n", static_cast<int>(clip.name.size()),
                clip.name.data(), static_cast<double>(rate), tracks.get_num_samples_per_track(), bytes.keys,
                bytes.memory, bytes.file, 1e3 * static_cast<double>(error.error),
                1e3 * error_of_source(model, clip, context, shell));
    allocator.deallocate(compressed, compressed->get_size());
    return bytes;
}

void compress_all(const std::string& path, const Options& options) {
    const auto model = Model::open(path);
    if (!model) fail(path + ": " + describe(model.error()));
    const float height = height_of(*model);
    const float shell = kShell * height;
    std::printf("\n%s, height %.3g m\n\n", path.c_str(), static_cast<double>(height));
    std::printf("| clip | Hz | samples | keys, bytes | in memory | under zstd | worst, mm | from the source |\n");
    std::printf("|---|---|---|---|---|---|---|---|\n");
    Bytes sum;
    for (const Clip& clip : model->clips()) {
        if (clip.packed) fail(path + ": a clip is packed: expected an exact file, without --compact");
        if (!(clip.end > clip.start) || clip.tracks.empty()) continue;
        const Bytes bytes = compress(*model, clip, options, shell);
        sum.keys += bytes.keys;
        sum.memory += bytes.memory;
        sum.file += bytes.file;
    }
    std::printf("| all | | | %zu | %zu | %zu | | |\n", sum.keys, sum.memory, sum.file);
}

int print_usage() {
    std::fprintf(stderr, "usage: bendy_bench_acl [--max-error MILLIMETRES] [--rate HERTZ] FILE.bendy...\n");
    return 2;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    int first = 1;
    for (; first + 1 < argc; first += 2) {
        const std::string option = argv[first];
        if (!option.starts_with("--")) break;
        char* end = nullptr;
        const float number = std::strtof(argv[first + 1], &end);
        if (*end != '\0' || !std::isfinite(number) || !(number > 0.0f)) {
            std::fprintf(stderr, "bendy_bench_acl: %s %s: expected a number above 0\n", option.c_str(),
                         argv[first + 1]);
            return 2;
        }
        if (option == "--max-error") {
            options.precision = 1e-3f * number;
        } else if (option == "--rate") {
            options.rate = number;
        } else {
            return print_usage();
        }
    }
    if (first >= argc || std::string(argv[first]).starts_with("--")) return print_usage();
    for (int k = first; k < argc; ++k) compress_all(argv[k], options);
    return 0;
}
