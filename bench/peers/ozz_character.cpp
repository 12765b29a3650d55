#include "ozz_character.h"

#include "peer_timing.h"

#include <ozz/animation/offline/animation_builder.h>
#include <ozz/animation/offline/animation_optimizer.h>
#include <ozz/animation/offline/raw_animation.h>
#include <ozz/animation/offline/raw_skeleton.h>
#include <ozz/animation/offline/skeleton_builder.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <utility>

namespace bendy::bench {
namespace {

namespace offline = ozz::animation::offline;
using ozz::math::Float4x4;

/// For random times; the default of ozz's importer, ten seconds, is longer than most clips.
constexpr float kIframeInterval = 0.1f;
/// Vertices of fewer influences than ozz's mesh tool would make a part of join the next part.
constexpr std::size_t kSmallestPart = 32;
constexpr float kSampleRate = 60.0f;  // of tracks that ozz cannot interpolate as the file says

ozz::math::Float3 float3_of(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}

ozz::math::Quaternion quaternion_of(const glm::quat& q) {
    return {q.x, q.y, q.z, q.w};
}

Float4x4 matrix_of(const glm::mat4& matrix) {
    Float4x4 to;
    for (int column = 0; column < 4; ++column) to.cols[column] = ozz::math::simd_float4::LoadPtrU(&matrix[column].x);
    return to;
}

/// Joints have their numbers as names.
ozz::unique_ptr<ozz::animation::Skeleton> make_skeleton(const Model& model) {
    const auto joints = model.joints();
    std::vector<std::vector<std::uint32_t>> children(joints.size());
    std::vector<std::uint32_t> roots;
    for (std::uint32_t joint = 0; joint < joints.size(); ++joint)
        (joints[joint].parent == kNone ? roots : children[joints[joint].parent]).push_back(joint);
    const std::function<offline::RawSkeleton::Joint(std::uint32_t)> make = [&](std::uint32_t joint) {
        offline::RawSkeleton::Joint raw;
        raw.name = std::to_string(joint).c_str();
        const JointTransform& rest = joints[joint].rest;
        raw.transform.translation = float3_of(rest.translation);
        raw.transform.rotation = quaternion_of(rest.rotation);
        raw.transform.scale = float3_of(rest.scale);
        for (const std::uint32_t child : children[joint]) raw.children.push_back(make(child));
        return raw;
    };
    offline::RawSkeleton raw;
    for (const std::uint32_t root : roots) raw.roots.push_back(make(root));
    return offline::SkeletonBuilder()(raw);
}

float key_time(const TrackView& track, const Clip& clip, std::uint32_t key) {
    return track.times.empty() ? static_cast<float>(key) / clip.frame_rate : track.times[key] - clip.start;
}

/// Linear tracks with their own keys, others sampled.
template <class Keys, class Make>
void add_keys(const TrackView& track, const Clip& clip, float duration, Keys& keys, const Make& make) {
    const auto add = [&](float time, const float* numbers) {
        time = std::clamp(time, 0.0f, duration);
        if (keys.empty() || time > keys.back().time) keys.push_back({time, make(numbers)});
    };
    if (track.interpolation == Interpolation::linear) {
        for (std::uint32_t key = 0; key < track.keys; ++key)
            add(key_time(track, clip, key), track.values.data() + std::size_t{key} * track.components);
        return;
    }
    std::array<float, 4> value{};
    const int samples = std::max(1, static_cast<int>(std::ceil(kSampleRate * duration)));
    for (int k = 0; k <= samples; ++k) {
        const float time = duration * static_cast<float>(k) / static_cast<float>(samples);
        sample_track(track, clip, clip.start + time, std::span(value).first(track.components));
        add(time, value.data());
    }
}

offline::RawAnimation make_raw(const Model& model, const Clip& clip, const OzzCharacter& character) {
    offline::RawAnimation raw;
    raw.duration = std::max(clip.end - clip.start, 1e-3f);
    raw.tracks.resize(character.joints());
    for (const TrackView& track : clip.tracks) {
        if (track.path == TrackPath::weights) continue;
        auto& to = raw.tracks[character.theirs_of[track.target]];
        const auto vector = [](const float* n) { return ozz::math::Float3(n[0], n[1], n[2]); };
        if (track.path == TrackPath::scale) add_keys(track, clip, raw.duration, to.scales, vector);
        if (track.path == TrackPath::translation) add_keys(track, clip, raw.duration, to.translations, vector);
        if (track.path == TrackPath::rotation) {
            add_keys(track, clip, raw.duration, to.rotations,
                     [](const float* n) { return ozz::math::Quaternion(n[0], n[1], n[2], n[3]); });
        }
    }
    for (std::size_t joint = 0; joint < raw.tracks.size(); ++joint) {
        const JointTransform& rest = model.joints()[character.ours_of[joint]].rest;
        auto& track = raw.tracks[joint];
        if (track.translations.empty()) track.translations.push_back({0.0f, float3_of(rest.translation)});
        if (track.rotations.empty()) track.rotations.push_back({0.0f, quaternion_of(rest.rotation)});
        if (track.scales.empty()) track.scales.push_back({0.0f, float3_of(rest.scale)});
    }
    return raw;
}

OzzClip make_clip(const Model& model, const Clip& clip, const OzzCharacter& character) {
    if (clip.packed) fail("a clip of the first file is packed: expected an exact file, without --compact");
    const offline::RawAnimation raw = make_raw(model, clip, character);
    OzzClip made;
    offline::AnimationBuilder builder;
    made.plain = builder(raw);
    builder.iframe_interval = kIframeInterval;
    made.iframes = builder(raw);
    offline::RawAnimation optimised;
    check(offline::AnimationOptimizer()(raw, *character.skeleton, &optimised), "ozz's AnimationOptimizer");
    made.optimised = builder(optimised);
    check(made.plain && made.iframes && made.optimised, "ozz's AnimationBuilder");
    return made;
}

/// \param movers  set to the palette's entry of each vertex, if the mesh is rigid
OzzPalette make_palette(const Model& model, std::uint32_t number, const OzzCharacter& character,
                        std::vector<std::uint32_t>& movers) {
    OzzPalette palette;
    const Mesh& mesh = model.meshes()[number];
    if (!mesh.is_rigid()) {
        const auto inverse_bind = mesh.palette.inverse_bind();
        for (std::size_t entry = 0; entry < inverse_bind.size(); ++entry) {
            palette.joints.push_back(character.theirs_of[mesh.palette.joints[entry]]);
            palette.inverse_bind.push_back(matrix_of(inverse_bind[entry]));
        }
        return palette;
    }
    for (std::uint32_t vertex = 0; vertex < mesh.vertices; ++vertex) {
        const std::uint32_t joint = model.rigid_mover(number, vertex);
        const std::uint32_t mover = joint == kNone ? 0 : character.theirs_of[joint];
        const auto found = std::find(palette.joints.begin(), palette.joints.end(), mover);
        movers.push_back(static_cast<std::uint32_t>(found - palette.joints.begin()));
        if (found == palette.joints.end()) palette.joints.push_back(mover);
    }
    palette.inverse_bind.assign(palette.joints.size(), Float4x4::identity());
    return palette;
}

bool is_same(const OzzPalette& a, const OzzPalette& b) {
    return a.joints == b.joints && a.inverse_bind.size() == b.inverse_bind.size() &&
           std::memcmp(a.inverse_bind.data(), b.inverse_bind.data(), a.inverse_bind.size() * sizeof(Float4x4)) == 0;
}

struct Influence {
    float weight = 0.0f;
    std::uint32_t entry = 0;
};

/// Those that are not 0, the heaviest first.
std::vector<Influence> influences_of(const Mesh& mesh, std::uint32_t vertex, const std::vector<std::uint32_t>& movers) {
    if (mesh.is_rigid()) return {{1.0f, movers[vertex]}};
    std::vector<Influence> influences;
    for (std::uint32_t k = 0; k < mesh.bones->components; ++k) {
        const float weight = mesh.weights->number(vertex, k);
        if (weight != 0.0f) influences.push_back({weight, mesh.bones->index(vertex, k)});
    }
    if (influences.empty()) influences.push_back({1.0f, mesh.bones->index(vertex, 0)});
    std::stable_sort(influences.begin(), influences.end(),
                     [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
    return influences;
}

void add_vertex(OzzPart& part, const Mesh& mesh, std::uint32_t vertex, std::vector<Influence> influences) {
    influences.resize(part.influences, {0.0f, influences.front().entry});
    for (std::size_t k = 0; k < part.influences; ++k) {
        part.joints.push_back(static_cast<std::uint16_t>(influences[k].entry));
        if (k + 1 < part.influences) part.weights.push_back(influences[k].weight);
    }
    const glm::vec3 position = mesh.positions.vec3(vertex);
    const glm::vec3 normal = mesh.normals ? mesh.normals->vec3(vertex) : glm::vec3(0.0f, 1.0f, 0.0f);
    const glm::vec4 tangent = mesh.tangents ? mesh.tangents->vec4(vertex) : glm::vec4(1.0f, 0.0f, 0.0f, 1.0f);
    part.positions.insert(part.positions.end(), {position.x, position.y, position.z});
    part.normals.insert(part.normals.end(), {normal.x, normal.y, normal.z});
    part.tangents.insert(part.tangents.end(), {tangent.x, tangent.y, tangent.z});
    part.vertices.push_back(vertex);
}

/// Splits a mesh by numbers of influences, as ozz's fbx2mesh does.
std::vector<OzzPart> make_parts(const Mesh& mesh, const std::vector<std::uint32_t>& movers) {
    std::vector<std::vector<std::uint32_t>> buckets;  // [n]: the vertices of n + 1 influences
    std::vector<std::vector<Influence>> influences;
    for (std::uint32_t vertex = 0; vertex < mesh.vertices; ++vertex) {
        influences.push_back(influences_of(mesh, vertex, movers));
        buckets.resize(std::max(buckets.size(), influences.back().size()));
        buckets[influences.back().size() - 1].push_back(vertex);
    }
    for (std::size_t n = 0; n + 1 < buckets.size(); ++n) {
        if (buckets[n].size() >= kSmallestPart) continue;
        buckets[n + 1].insert(buckets[n + 1].end(), buckets[n].begin(), buckets[n].end());
        buckets[n].clear();
    }
    std::vector<OzzPart> parts;
    for (std::size_t n = 0; n < buckets.size(); ++n) {
        if (buckets[n].empty()) continue;
        OzzPart& part = parts.emplace_back();
        part.influences = n + 1;
        for (const std::uint32_t vertex : buckets[n]) add_vertex(part, mesh, vertex, influences[vertex]);
    }
    return parts;
}

/// Leaves out the entries that no vertex follows, as ozz's fbx2mesh does.
void remove_unused_entries(OzzCharacter& character, std::size_t number) {
    OzzPalette& palette = character.palettes[number];
    const auto for_each_joint = [&](const auto& change) {
        for (OzzMesh& mesh : character.meshes) {
            if (mesh.palette != number) continue;
            for (OzzPart& part : mesh.parts) std::for_each(part.joints.begin(), part.joints.end(), change);
        }
    };
    std::vector<bool> is_used(palette.joints.size());
    for_each_joint([&](std::uint16_t& entry) { is_used[entry] = true; });
    OzzPalette kept;
    std::vector<std::uint16_t> places(palette.joints.size());
    for (std::size_t entry = 0; entry < palette.joints.size(); ++entry) {
        if (!is_used[entry]) continue;
        places[entry] = static_cast<std::uint16_t>(kept.joints.size());
        kept.joints.push_back(palette.joints[entry]);
        kept.inverse_bind.push_back(palette.inverse_bind[entry]);
    }
    for_each_joint([&](std::uint16_t& entry) { entry = places[entry]; });
    palette = std::move(kept);
}

}  // namespace

OzzCharacter make_ozz(const Model& model) {
    OzzCharacter character;
    character.skeleton = make_skeleton(model);
    check(character.skeleton != nullptr, "ozz's SkeletonBuilder");
    character.theirs_of.resize(model.joints().size());
    for (const char* name : character.skeleton->joint_names()) {
        const auto ours = static_cast<std::uint32_t>(std::atoi(name));
        character.theirs_of[ours] = static_cast<std::uint32_t>(character.ours_of.size());
        character.ours_of.push_back(ours);
    }
    for (const Clip& clip : model.clips()) character.clips.push_back(make_clip(model, clip, character));
    for (std::uint32_t number = 0; number < model.meshes().size(); ++number) {
        std::vector<std::uint32_t> movers;
        OzzPalette palette = make_palette(model, number, character, movers);
        if (character.palettes.empty() || !is_same(character.palettes.back(), palette))
            character.palettes.push_back(std::move(palette));
        character.meshes.push_back({character.palettes.size() - 1, make_parts(model.meshes()[number], movers)});
    }
    for (std::size_t number = 0; number < character.palettes.size(); ++number) remove_unused_entries(character, number);
    return character;
}

ozz::math::SimdFloat4 simd_of(const glm::vec3& v) {
    return ozz::math::simd_float4::Load(v.x, v.y, v.z, 0.0f);
}

}  // namespace bendy::bench
