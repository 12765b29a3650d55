// Sampling, blending and matrices.
#include "joint_transforms.h"
#include "sections.h"

#include <ozz/animation/runtime/blending_job.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

namespace bendy::bench {
namespace {

using ozz::math::SimdFloat4;
using ozz::math::SoaTransform;

struct SampledPeer {
    std::string name;
    ozz::unique_ptr<ozz::animation::Animation> OzzClip::*clip;
};

/// One state for each clip: with ozz each clip that plays has a context of its own.
std::vector<std::unique_ptr<OzzState>> states_of(const OzzCharacter& character) {
    std::vector<std::unique_ptr<OzzState>> states;
    for (std::size_t k = 0; k < character.clips.size(); ++k) states.push_back(std::make_unique<OzzState>(character));
    return states;
}

/// \param played  the character itself, or another encoding of it
template <class Times>
void race_sampling(Table& table, const Character& character, const Model& played, const std::string& what,
                   const std::vector<SampledPeer>& peers) {
    const auto clips = played.clips();
    std::vector<Times> times;
    for (const Clip& clip : clips) times.push_back({clip.end - clip.start});
    Pose pose(played);
    std::vector<Contestant> contestants{{"ours", [&, times]() mutable {
                                             for (std::size_t k = 0; k < clips.size(); ++k)
                                                 sample_at(pose, clips[k], clips[k].start + times[k].next());
                                         }}};
    std::vector<std::vector<std::unique_ptr<OzzState>>> states;
    for (std::size_t k = 0; k < peers.size(); ++k) states.push_back(states_of(character.ozz));
    for (std::size_t peer = 0; peer < peers.size(); ++peer) {
        contestants.push_back({"ozz, " + peers[peer].name, [&, peer, times]() mutable {
                                   for (std::size_t k = 0; k < clips.size(); ++k)
                                       states[peer][k]->sample(*(character.ozz.clips[k].*peers[peer].clip),
                                                               times[k].next());
                               }});
    }
    const double items = character.joints() * static_cast<double>(clips.size());
    table.compare({character.name, what, "joint", items}, contestants);
}

void measure_sampling(Table& table, const Character& character, const Model& played, const std::string& suffix,
                      const std::vector<SampledPeer>& peers) {
    race_sampling<FrameTimes>(table, character, played, "sample, next frame" + suffix, peers);
    race_sampling<RandomTimes>(table, character, played, "sample, random time" + suffix, peers);
}

/// A difference for add: a turn of 0.2 about x, 1 mm, scale 1; our form and ozz's.
constexpr float kTurnSine = 0.0998334f, kTurnCosine = 0.9950042f, kShift = 0.001f;

void set_difference(Pose& pose) {
    const JointTransform turn{glm::quat(kTurnCosine, kTurnSine, 0.0f, 0.0f), {0.0f, kShift, 0.0f}, glm::vec3(1.0f)};
    for (std::uint32_t joint = 0; joint < pose.model().joints().size(); ++joint) set_local(pose, joint, turn);
}

std::vector<SoaTransform> make_difference(std::size_t soa_joints) {
    SoaTransform turn = SoaTransform::identity();
    turn.rotation.x = ozz::math::simd_float4::Load1(kTurnSine);
    turn.rotation.w = ozz::math::simd_float4::Load1(kTurnCosine);
    turn.translation.y = ozz::math::simd_float4::Load1(kShift);
    return std::vector<SoaTransform>(soa_joints, turn);
}

/// A mask in ozz's form. \param is_inverse  each weight subtracted from 1
std::vector<SimdFloat4> soa_mask(const OzzCharacter& character, std::span<const float> mask, bool is_inverse) {
    std::vector<float> numbers(4 * character.soa_joints());
    for (std::size_t joint = 0; joint < character.joints(); ++joint) {
        const float weight = mask[character.ours_of[joint]];
        numbers[joint] = is_inverse ? 1.0f - weight : weight;
    }
    std::vector<SimdFloat4> to;
    for (std::size_t k = 0; k < numbers.size(); k += 4) to.push_back(ozz::math::simd_float4::LoadPtrU(&numbers[k]));
    return to;
}

using Layer = ozz::animation::BlendingJob::Layer;

Layer layer_of(const std::vector<SoaTransform>& transforms, float weight,
               const std::vector<SimdFloat4>* weights = nullptr) {
    Layer layer;
    layer.transform = ozz::make_span(transforms);
    layer.weight = weight;
    if (weights != nullptr) layer.joint_weights = ozz::make_span(*weights);
    return layer;
}

void run_blending(const OzzCharacter& character, std::span<const Layer> layers, std::span<const Layer> additive,
                  std::vector<SoaTransform>& output) {
    ozz::animation::BlendingJob job;
    job.layers = {layers.data(), layers.size()};
    job.additive_layers = {additive.data(), additive.size()};
    job.rest_pose = character.skeleton->joint_rest_poses();
    job.output = ozz::make_span(output);
    check(job.Run(), "ozz's BlendingJob");
}

/// Two clips into one palette, the work of a frame.
void race_frame(Table& table, const Character& character, const Clip& first, const Clip& second,
                const OzzClip& ozz_first, const OzzClip& ozz_second) {
    Pose a(character.model), b(character.model);
    OzzState state(character.ozz), other(character.ozz);
    FrameTimes ours_a{first.end - first.start}, ours_b{second.end - second.start};
    const auto ours = [&] {
        sample_at(a, first, first.start + ours_a.next());
        sample_at(b, second, second.start + ours_b.next());
        check(blend(a, b, 0.5f).has_value(), "blend");
        (void)a.model_space();
        make_palettes(a);
    };
    std::vector<SoaTransform> blended(state.locals.size());
    const std::array both{layer_of(state.locals, 0.5f), layer_of(other.locals, 0.5f)};
    std::vector<Contestant> contestants{{"ours", ours}};
    const auto add = [&](const char* name, const ozz::animation::Animation& one, const ozz::animation::Animation& two) {
        contestants.push_back({name, [&, times_a = ours_a, times_b = ours_b]() mutable {
                                   state.sample(one, times_a.next());
                                   other.sample(two, times_b.next());
                                   run_blending(character.ozz, both, {}, blended);
                                   std::swap(state.locals, blended);  // the layers keep their memory
                                   state.local_to_model();
                                   state.make_palettes();
                                   std::swap(state.locals, blended);
                               }});
    };
    add("ozz, all keys", *ozz_first.plain, *ozz_second.plain);
    add("ozz, optimised, iframes", *ozz_first.optimised, *ozz_second.optimised);
    table.compare({character.name, "two clips, blend, matrices, palettes", "joint", character.joints()}, contestants);
}

}  // namespace

void measure_sampling(Table& table, const Character& character) {
    measure_sampling(table, character, character.model, "",
                     {{"all keys", &OzzClip::plain},
                      {"all keys, iframes", &OzzClip::iframes},
                      {"optimised, iframes", &OzzClip::optimised}});
}

void measure_packed(Table& table, const Character& character, const Model& packed) {
    if (packed.clips().size() != character.model.clips().size() ||
        packed.joints().size() != character.model.joints().size())
        fail(character.name + ": the compact file has other joints or clips than the exact one");
    measure_sampling(table, character, packed, ", packed", {{"optimised, iframes", &OzzClip::optimised}});
}

void measure_matrices(Table& table, const Character& character) {
    Pose pose(character.model);
    OzzState state(character.ozz);
    if (character.is_animated()) {
        const Clip& clip = character.model.clips().front();
        sample_at(pose, clip, 0.5f * (clip.start + clip.end));
        state.sample(*character.ozz.clips.front().plain, 0.5f * (clip.end - clip.start));
    }
    const auto race = [&](const char* what, const std::function<void()>& ours, const std::function<void()>& theirs) {
        table.compare({character.name, what, "joint", character.joints()}, {{"ours", ours}, {"ozz", theirs}});
    };
    const auto ozz_palettes = [&] {
        state.local_to_model();
        state.make_palettes();
    };
    race(
        "local to model",
        [&] {
            mark_changed(pose);
            (void)pose.model_space();
        },
        [&] { state.local_to_model(); });
    race(
        "local to model, palettes",
        [&] {
            mark_changed(pose);
            (void)pose.model_space();
            make_palettes(pose);
        },
        ozz_palettes);
    const auto meshes = character.model.meshes();
    if (std::any_of(meshes.begin(), meshes.end(), [](const Mesh& mesh) { return mesh.is_rigid(); })) return;
    race(
        "palettes alone",
        [&] {
            mark_changed(pose);
            make_palettes(pose);
        },
        ozz_palettes);
}

void measure_blending(Table& table, const Character& character) {
    const Model& model = character.model;
    const std::size_t other_clip = model.clips().size() > 1 ? 1 : 0;
    const Clip& first = model.clips().front();
    const Clip& second = model.clips()[other_clip];
    const OzzClip& ozz_first = character.ozz.clips.front();
    const OzzClip& ozz_second = character.ozz.clips[other_clip];
    Pose a(model), b(model), out(model), difference(model);
    sample_at(a, first, first.start + 0.3f * (first.end - first.start));
    sample_at(b, second, second.start + 0.8f * (second.end - second.start));
    set_difference(difference);
    const auto middle = static_cast<std::uint32_t>(model.joints().size() / 2);
    const std::vector<float> mask = mask_below(model, middle, 1.0f, 0.25f);

    OzzState state(character.ozz), other(character.ozz);
    state.sample(*ozz_first.plain, 0.3f * ozz_first.plain->duration());
    other.sample(*ozz_second.plain, 0.8f * ozz_second.plain->duration());
    std::vector<SoaTransform> blended(state.locals.size());
    const std::vector<SoaTransform> added = make_difference(state.locals.size());
    const auto inside = soa_mask(character.ozz, mask, false), outside = soa_mask(character.ozz, mask, true);
    const std::array both{layer_of(state.locals, 0.5f), layer_of(other.locals, 0.5f)};
    const std::array masked{layer_of(state.locals, 1.0f, &outside), layer_of(other.locals, 1.0f, &inside)};
    const std::array base{layer_of(state.locals, 1.0f)};
    const std::array addition{layer_of(added, 0.5f)};
    const auto ozz = [&](std::span<const Layer> layers, std::span<const Layer> additive = {}) {
        return [&, layers, additive] { run_blending(character.ozz, layers, additive, blended); };
    };

    const auto race = [&](std::string_view what, const auto& ours, const std::function<void()>& theirs) {
        const auto run = [&] { check(ours(), what); };
        copy_locals(a, out);
        table.compare({character.name, std::string(what) + ", in place", "joint", character.joints()},
                      {{"ours", run}, {"ozz, into a third", theirs}});
        const auto copy_and_run = [&] {
            copy_locals(a, out);
            run();
        };
        table.compare({character.name, std::string(what) + ", into a third", "joint", character.joints()},
                      {{"ours", copy_and_run}, {"ozz, into a third", theirs}});
    };
    // Forth and back, so that no number shrinks until it is denormal.
    bool is_a = false;
    const auto next = [&]() -> const Pose& { return (is_a = !is_a) ? a : b; };
    race(
        "blend", [&] { return blend(out, next(), 0.5f).has_value(); }, ozz(both));
    race(
        "blend, mask", [&] { return blend(out, next(), 1.0f, mask).has_value(); }, ozz(masked));
    float sign = 0.5f;
    race(
        "add", [&] { return add(out, difference, sign = -sign).has_value(); }, ozz(base, addition));
    race_frame(table, character, first, second, ozz_first, ozz_second);
}

}  // namespace bendy::bench
