// What takes a part of a model is given that of another one: a twin, which is the same file opened twice, and a larger
// model, whose numbers go beyond the arrays of the first.
#include <bendy/runtime.h>

#include "format/sample_file.h"
#include "runtime/build_model.h"
#include "runtime/clip_model.h"
#include "runtime/limb_model.h"
#include "source_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bendy::other_model_test {
namespace {

/// 21 joints and 6 meshes with targets, a chain of all bones of a limb, and a clip that moves the last joint.
test::Buffer larger_file() {
    test::LimbModel limbs(1);
    const auto last = static_cast<std::uint32_t>(limbs.spec.joints.size()) - 1;
    ChainRecord chain;
    chain.start = last - test::LimbModel::kBones + 1;
    chain.effector = last;
    limbs.spec.chains = {chain};
    limbs.spec.more = {test::clip_node(
        {"run",
         0.0f,
         1.0f,
         true,
         {{TrackPath::translation, 0, 3, {0}, {7, 7, 7}}, {TrackPath::translation, last, 3, {0}, {7, 7, 7}}}})};
    return test::build_file(limbs.spec);
}

/// A model, and one of everything that is made from it.
struct Parts {
    explicit Parts(test::Buffer file)
        : model(std::move(file)),
          pose(*model),
          scratch(*model),
          lod(*model),
          bounds(*model),
          crowd(*model),
          path(*model, 0),
          binding(*model, *model),
          positions(model->vertex_count()),
          palettes(crowd.palette_size()) {
        fade.play(*clip, 0.0f);
    }

    test::Owned model;
    const Clip* clip = model->clips().data();
    const Chain* chain = model->chains().data();
    Pose pose, scratch;
    Lod lod;
    Bounds bounds;
    Crowd crowd;
    RootPath path;
    Binding binding;
    Crossfade fade;
    std::vector<glm::vec3> positions;
    std::vector<PaletteMatrix> palettes;
    std::uint32_t last_joint = static_cast<std::uint32_t>(model->joints().size()) - 1;
    std::uint32_t last_mesh = static_cast<std::uint32_t>(model->meshes().size()) - 1;
};

template <class Value>
std::optional<CallError> error_of(const Result<Value, CallError>& result) {
    return result ? std::nullopt : std::optional(result.error());
}

/// A call that takes an object: it must return other_model.
struct Call {
    const char* name;  ///< as in counterparts.txt
    std::optional<CallError> (*run)(Parts& mine, Parts& other);
};

std::optional<CallError> play(Parts& mine, const CrowdMember& member) {
    return error_of(mine.crowd.play({&member, 1}));
}

const std::vector<Call> kCalls{
    {"sample(Pose& pose, const Clip* clip, float seconds)",
     [](Parts& mine, Parts& other) { return error_of(sample(mine.pose, other.clip, 0.3f)); }},
    {"sample(Pose& pose, Binding& binding, const Clip* clip, float seconds)",
     [](Parts& mine, Parts& other) { return error_of(sample(mine.pose, mine.binding, other.clip, 0.3f)); }},
    {"sample(Pose& pose, Binding& binding, const Clip* clip, float seconds)",
     [](Parts& mine, Parts& other) { return error_of(sample(mine.pose, other.binding, other.clip, 0.3f)); }},
    {"sample(Pose& pose, const Crossfade& crossfade, Pose& scratch)",
     [](Parts& mine, Parts& other) { return error_of(sample(mine.pose, other.fade, mine.scratch)); }},
    {"sample(Pose& pose, const Crossfade& crossfade, Pose& scratch)",
     [](Parts& mine, Parts& other) { return error_of(sample(mine.pose, mine.fade, other.scratch)); }},
    {"Crossfade::play(const Clip& clip, float fade_seconds, Easing easing)",  // tells when it is sampled
     [](Parts& mine, Parts& other) {
         Crossfade fade = mine.fade;
         fade.play(*other.clip, 0.5f);
         fade.advance(0.1);
         return error_of(sample(mine.pose, fade, mine.scratch));
     }},
    {"Crossfade::play(const Clip& clip, const Playback& playback, float fade_seconds, Easing easing)",
     [](Parts& mine, Parts& other) {
         Crossfade fade = other.fade;
         fade.play(*mine.clip, Playback(*other.clip), 0.5f);
         fade.advance(0.1);
         return error_of(sample(mine.pose, fade, mine.scratch));
     }},
    {"blend(Pose& pose, const Pose& other, float weight, std::span<const float> mask)",
     [](Parts& mine, Parts& other) { return error_of(blend(mine.pose, other.pose, 0.5f)); }},
    {"make_additive(Pose& pose, const Pose& reference)",
     [](Parts& mine, Parts& other) { return error_of(make_additive(mine.pose, other.pose)); }},
    {"add(Pose& pose, const Pose& difference, float weight, std::span<const float> mask)",
     [](Parts& mine, Parts& other) { return error_of(add(mine.pose, other.pose, 0.5f)); }},
    {"reach(Pose& pose, const Chain* chain, const ReachTarget& target, const ReachOptions& options)",
     [](Parts& mine, Parts& other) { return error_of(reach(mine.pose, other.chain, glm::vec3(1.0f))); }},
    {"ReachState::forget(const Chain* chain)",
     [](Parts& mine, Parts& other) {
         ReachState state(*mine.model);
         return error_of(state.forget(other.chain));
     }},
    {"reach(Pose& pose, std::span<const ReachRequest> requests, std::span<ReachResult> results)",
     [](Parts& mine, Parts& other) {
         const ReachRequest request{other.chain, glm::vec3(1.0f), {}};
         return error_of(reach(mine.pose, {&request, 1}));
     }},
    {"skin(Pose& pose, const SkinRequest& request)",
     [](Parts& mine, Parts& other) {
         return error_of(skin(mine.pose, {.lod = &other.lod, .out = {.positions = mine.positions}}));
     }},
    {"Bounds::of(Pose& pose)", [](Parts& mine, Parts& other) { return error_of(mine.bounds.of(other.pose)); }},
    {"Bounds::of(Pose& pose, std::uint32_t joint)",
     [](Parts& mine, Parts& other) { return error_of(other.bounds.of(mine.pose, 0)); }},
    {"RootPath::at(const Clip& clip, double seconds)",
     [](Parts& mine, Parts& other) { return error_of(mine.path.at(*other.clip, 0.3)); }},
    {"RootPath::between(const Clip& clip, double from, double to)",
     [](Parts& mine, Parts& other) { return error_of(mine.path.between(*other.clip, 0.1, 0.3)); }},
    {"RootPath::over(const Clip& clip, const PlayedInterval& played)",
     [](Parts& mine, Parts& other) {
         return error_of(mine.path.over(*other.clip, Playback(*mine.clip).advance(0.1)));
     }},
    {"RootPath::extract(Pose& pose)",
     [](Parts& mine, Parts& other) { return error_of(other.path.extract(mine.pose)); }},
    {"Crowd::play(std::span<const CrowdMember> members, std::size_t worker)",
     [](Parts& mine, Parts& other) {
         return play(mine, {other.clip, 0.3f, nullptr, {.positions = mine.positions}, mine.palettes});
     }},
    {"Crowd::play(std::span<const CrowdMember> members, std::size_t worker)",
     [](Parts& mine, Parts& other) {
         return play(mine, {mine.clip, 0.3f, &other.lod, {}, mine.palettes});
     }},
    {"Crowd::play(std::span<const CrowdMember> members, std::size_t worker, const PoseMember& pose_member)",
     [](Parts& mine, Parts& other) {
         const CrowdMember member{nullptr, 0.0f, nullptr, {.positions = mine.positions}, mine.palettes};
         return error_of(mine.crowd.play({&member, 1}, 0, [&](const CrowdMember&, Pose& pose) { pose = other.pose; }));
     }},
};

/// Calls that take the number of a joint, a mesh, a vertex or a worker, or something that says all about itself: what
/// they return for a number that the model does not have is tested below.
const std::vector<std::string> kNumberCalls{
    "Bounds::joint(std::uint32_t joint)",
    "Crowd::first_entry(std::uint32_t mesh)",
    "Lod::vertices(std::uint32_t mesh)",
    "Lod::indices(std::uint32_t mesh)",
    "Model::chain_weights(const Chain& chain)",
    "Model::constraint(std::uint32_t joint)",
    "Model::ik_constraint(std::uint32_t joint)",
    "Model::first_vertex(std::uint32_t mesh)",
    "Model::first_morph_target(std::uint32_t mesh)",
    "Model::rigid_mover(std::uint32_t mesh, std::uint32_t vertex)",
    "Model::has_one_mover(std::uint32_t mesh)",
    "Pose::local(std::uint32_t joint)",
    "Pose::set_local(std::uint32_t joint, const JointTransform& transform)",
    "Pose::palette(std::uint32_t mesh)",
    "RootPath::RootPath(const Model& model, std::uint32_t joint, const RootAxes& axes)",
    "mask_below(const Model& model, std::uint32_t joint, float inside, float outside)",
    "socket_matrix(Pose& pose, const Socket& socket, const glm::mat4& model_to_world)",
    "apply_morph_targets(const Mesh& mesh, std::span<const float> weights, std::uint32_t vertices, const Vertices& "
    "out)",
    "sample_track(const TrackView& track, const Clip& clip, float seconds, std::span<float> value)",
};

/// Calls that read nothing but the part that they are given, so that no model is involved.
const std::vector<std::string> kOwnCalls{
    "ChainView::solver()",
    "Playback::Playback(const Clip& clip)",
    "apply_morph_targets(const Mesh& mesh, std::span<const float> weights, const Vertices& out)",
    "find_curve(const ClipView& clip, std::string_view name_or_path)",
    "find_curve(const ClipView& clip, CurveTarget kind, std::uint32_t target, std::string_view path)",
    "mix_frames(const PlayRecord& play, const Clip& clip, float seconds)",
};

/// The calls of all public headers, as check_counterparts.py has them, that take a part of a model.
std::vector<std::string> calls_with_parts() {
    constexpr std::array kParts{
        "Clip",        "Chain",        "Lod&",        "Socket",          "Binding&",         "Crossfade&",
        "CrowdMember", "ReachRequest", "SkinRequest", "const Mesh&",     "TrackView&",       "_t joint",
        "_t mesh,",    "_t mesh)",     "Pose& other", "Pose& reference", "Pose& difference", "Pose& scratch",
        "Bounds::of(", "extract("};
    std::ifstream file(source_folder() / "tests/capi/counterparts.txt");
    std::vector<std::string> calls;
    for (std::string line; std::getline(file, line);) {
        const std::size_t end = line.find(") -> ");
        if (end == std::string::npos || line.find('(') > end) continue;
        const std::string call = line.substr(0, end + 1);
        const auto is_in = [&](const char* part) { return call.find(part) != std::string::npos; };
        if (std::any_of(kParts.begin(), kParts.end(), is_in)) calls.push_back(call);
    }
    return calls;
}

bool is_in(const std::vector<std::string>& list, const std::string& call) {
    return std::find(list.begin(), list.end(), call) != list.end();
}

bool are_equal(const Pose& a, const Pose& b) {
    for (std::uint32_t joint = 0; joint < a.model().joints().size(); ++joint) {
        const JointTransform is = a.local(joint);
        const JointTransform expected = b.local(joint);
        if (is.rotation != expected.rotation || is.translation != expected.translation || is.scale != expected.scale)
            return false;
    }
    return std::equal(a.morph_weights().begin(), a.morph_weights().end(), b.morph_weights().begin());
}

TEST(OtherModel, EveryCallIsInOneOfTheTables) {
    const std::vector<std::string> calls = calls_with_parts();
    EXPECT_GT(calls.size(), 40u);
    std::vector<std::string> known;
    for (const Call& call : kCalls) known.emplace_back(call.name);
    known.insert(known.end(), kNumberCalls.begin(), kNumberCalls.end());
    known.insert(known.end(), kOwnCalls.begin(), kOwnCalls.end());
    for (const std::string& call : calls) EXPECT_TRUE(is_in(known, call)) << call;
    for (const std::string& call : known) EXPECT_TRUE(is_in(calls, call)) << call;
}

TEST(OtherModel, ItsPartsAreRefused) {
    const Kernel before = kernel();
    for (const Kernel each : kernels()) {
        ASSERT_TRUE(set_kernel(each));
        for (const bool is_twin : {true, false}) {
            Parts mine(test::sample_file());
            Parts other(is_twin ? test::sample_file() : larger_file());
            const Pose rest(*mine.model);
            for (const Call& call : kCalls) {
                SCOPED_TRACE(std::string(kernel_name(each)) + (is_twin ? ", twin: " : ", larger: ") + call.name);
                ASSERT_TRUE(sample(mine.pose, mine.clip, 0.4f));
                mine.pose.change_morph_weights()[0] = 0.75f;
                const Pose posed = mine.pose;
                std::fill(mine.positions.begin(), mine.positions.end(), glm::vec3(-7.0f));
                for (PaletteMatrix& matrix : mine.palettes) matrix.rows[0][0] = -7.0f;
                EXPECT_EQ(call.run(mine, other), CallError::other_model);
                EXPECT_TRUE(are_equal(mine.pose, posed) || are_equal(mine.pose, rest));
                for (const glm::vec3& position : mine.positions) EXPECT_EQ(position, glm::vec3(-7.0f));
                for (const PaletteMatrix& matrix : mine.palettes) EXPECT_EQ(matrix.rows[0][0], -7.0f);
            }
        }
    }
    EXPECT_TRUE(set_kernel(before));
}

TEST(OtherModel, TheOthersOfACallAreDone) {
    Parts mine(test::sample_file());
    Parts other(larger_file());
    Pose expected(*mine.model);
    const auto reached = reach(expected, mine.chain, glm::vec3(0.1f, 0.9f, 0.1f));
    ASSERT_TRUE(reached);
    const std::vector<ReachRequest> requests{{other.chain, glm::vec3(1.0f), {}},
                                             {mine.chain, glm::vec3(0.1f, 0.9f, 0.1f), {}},
                                             {other.chain, glm::vec3(1.0f), {}}};
    std::vector<ReachResult> results(3);
    EXPECT_EQ(error_of(reach(mine.pose, requests, results)), CallError::other_model);
    EXPECT_TRUE(are_equal(mine.pose, expected));
    EXPECT_EQ(results[1].distance, reached->distance);
    EXPECT_EQ(results[0].iterations + results[2].iterations, 0u);

    std::vector<glm::vec3> refused(mine.positions.size(), glm::vec3(-7.0f));
    const std::array<CrowdMember, 3> members{{{other.clip, 0.3f, nullptr, {.positions = refused}, {}},
                                              {mine.clip, 0.3f, nullptr, {.positions = mine.positions}, {}},
                                              {mine.clip, NAN, nullptr, {.positions = refused}, {}}}};
    EXPECT_EQ(error_of(mine.crowd.play(members)), CallError::other_model);
    EXPECT_EQ(error_of(mine.crowd.play(std::span(members).subspan(1))), CallError::not_finite);
    for (const glm::vec3& position : refused) EXPECT_EQ(position, glm::vec3(-7.0f));
    ASSERT_TRUE(sample(mine.pose, mine.clip, 0.3f));
    std::vector<glm::vec3> skinned(mine.positions.size());
    ASSERT_TRUE(skin(mine.pose, {.out = {.positions = skinned}}));
    EXPECT_EQ(mine.positions, skinned);
}

TEST(OtherModel, ACrowdGoesOnAfterAPoseOfAnother) {
    Parts mine(test::sample_file());
    Parts other(larger_file());
    const CrowdMember member{nullptr, 0.0f, nullptr, {.positions = mine.positions}, mine.palettes};
    EXPECT_FALSE(mine.crowd.play({&member, 1}, 0, [&](const CrowdMember&, Pose& pose) { pose = other.pose; }));
    EXPECT_TRUE(mine.crowd.play({&member, 1}));
    std::vector<glm::vec3> rest(mine.positions.size());
    ASSERT_TRUE(skin(mine.scratch, {.out = {.positions = rest}}));
    EXPECT_EQ(mine.positions, rest);
}

TEST(OtherModel, NoCopyOfAPartIsAPart) {
    Parts mine(test::sample_file());
    const Clip clip = *mine.clip;
    const Chain chain = *mine.chain;
    EXPECT_EQ(error_of(sample(mine.pose, &clip, 0.3f)), CallError::other_model);
    EXPECT_EQ(error_of(reach(mine.pose, &chain, glm::vec3(1.0f))), CallError::other_model);
    const Model copy = *mine.model;  // of the handle: the same character
    Pose pose(copy);
    EXPECT_TRUE(sample(pose, mine.clip, 0.3f));
    EXPECT_TRUE(reach(pose, mine.chain, glm::vec3(1.0f)));
    EXPECT_TRUE(reach(mine.pose, copy.chains().data(), glm::vec3(1.0f)));
}

TEST(OtherModel, PartsOfOneThatIsGoneAreRefusedUnread) {
    Parts mine(test::sample_file());
    const Clip* clip = nullptr;
    const Chain* chain = nullptr;
    {
        const Parts gone(larger_file());
        clip = gone.clip;
        chain = gone.chain;
    }
    EXPECT_EQ(error_of(sample(mine.pose, clip, 0.3f)), CallError::other_model);
    EXPECT_EQ(error_of(sample(mine.pose, mine.binding, clip, 0.3f)), CallError::other_model);
    EXPECT_EQ(error_of(reach(mine.pose, chain, glm::vec3(1.0f))), CallError::other_model);
    const CrowdMember member{clip, 0.3f, nullptr, {}, mine.palettes};
    EXPECT_EQ(error_of(mine.crowd.play({&member, 1})), CallError::other_model);
}

TEST(OtherModel, NumbersThatItDoesNotHaveAreNone) {
    Parts mine(test::sample_file());
    Parts other(larger_file());
    const Model& model = *mine.model;
    ASSERT_GT(other.last_joint, mine.last_joint);
    ASSERT_GT(other.last_mesh, mine.last_mesh);
    EXPECT_TRUE(model.chain_weights(*other.chain).empty());
    for (const std::uint32_t joint : {mine.last_joint + 1, other.last_joint, kNone}) {
        EXPECT_TRUE(mine.bounds.joint(joint).is_empty());
        EXPECT_EQ(error_of(mine.bounds.of(mine.pose, joint)), CallError::out_of_range);
        EXPECT_EQ(model.constraint(joint), nullptr);
        EXPECT_EQ(model.ik_constraint(joint), nullptr);
        EXPECT_EQ(mask_below(model, joint), std::vector<float>(model.joints().size(), 0.0f));
        EXPECT_EQ(RootPath(model, joint).at(*mine.clip, 0.3)->translation, glm::dvec3(0.0));
    }
    const Socket socket{other.last_joint};
    EXPECT_TRUE(socket_matrix(other.pose, socket));
    EXPECT_EQ(error_of(socket_matrix(mine.pose, socket)), CallError::out_of_range);
    for (const std::uint32_t mesh : {mine.last_mesh + 1, other.last_mesh, kNone}) {
        EXPECT_EQ(mine.lod.vertices(mesh), 0u);
        EXPECT_TRUE(mine.lod.indices(mesh).empty());
        EXPECT_TRUE(mine.pose.palette(mesh).empty());
        EXPECT_EQ(mine.crowd.first_entry(mesh), mine.crowd.palette_size());
        EXPECT_EQ(model.first_vertex(mesh), model.vertex_count());
        EXPECT_EQ(model.first_morph_target(mesh), model.morph_target_count());
        EXPECT_EQ(model.rigid_mover(mesh, 0), kNone);
        EXPECT_TRUE(model.has_one_mover(mesh));
        if (mesh == kAllMeshes) continue;
        EXPECT_EQ(error_of(skin(mine.pose, {.mesh = mesh})), CallError::out_of_range);
    }
    EXPECT_EQ(model.rigid_mover(mine.last_mesh, model.meshes()[mine.last_mesh].vertices), kNone);
    EXPECT_EQ(error_of(mine.crowd.play(std::span<const CrowdMember>(), 1)), CallError::out_of_range);
    const Mesh& mesh = model.meshes()[0];
    std::vector<glm::vec3> room(mesh.vertices + 1);
    const std::vector<float> weights(mesh.targets.size());
    EXPECT_EQ(error_of(apply_morph_targets(mesh, weights, mesh.vertices + 1, {room, {}, {}})), CallError::out_of_range);
    std::array<float, 2> value{-7.0f, -7.0f};
    sample_track(other.clip->tracks[0], *other.clip, 0.3f, value);
    EXPECT_EQ(value[0], -7.0f);
    const JointTransform moved{{1, 0, 0, 0}, {7, 7, 7}, {1, 1, 1}};
    const Pose posed = mine.pose;
    EXPECT_DEBUG_DEATH((void)mine.pose.local(other.last_joint), "");
    EXPECT_DEBUG_DEATH(mine.pose.set_local(other.last_joint, moved), "");
    EXPECT_TRUE(are_equal(mine.pose, posed));
}

}  // namespace
}  // namespace bendy::other_model_test
