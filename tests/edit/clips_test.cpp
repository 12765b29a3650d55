#include <bendy/edit/clips.h>

#include "format/edit_file.h"
#include "runtime/build_model.h"
#include "runtime/clip_model.h"
#include "runtime/packed_model.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

// Clips are changed as keys; the runtime, which shares no code with that, plays the old and the new ones.
namespace bendy::edit::clips_test {
namespace {

using test::Buffer;
using test::Loaded;
using test::Node;
using test::Owned;

/// The joints of the body.
enum Body : std::uint32_t { rig, hips, spine, arm_left, hand_left, arm_right, hand_right, sword, count };

/// Keys that stay the same on every machine.
struct Keys {
    std::uint32_t target;
    TrackPath path;
    Interpolation interpolation;
    std::vector<float> times;
};

std::vector<float> make_values(const Keys& keys, std::uint16_t components, test::Noise& noise) {
    std::vector<float> values;
    const bool is_cubic = keys.interpolation == Interpolation::cubic;
    for (std::size_t row = 0; row < keys.times.size() * (is_cubic ? 3 : 1); ++row) {
        std::vector<double> numbers;
        double square = 0.0;
        for (std::uint16_t c = 0; c < components; ++c) {
            numbers.push_back(noise.next(2000) / 1000.0 - 1.0 + (c == 3 ? 1.5 : 0.0));
            square += numbers.back() * numbers.back();
        }
        const bool is_unit = keys.path == TrackPath::rotation && !is_cubic;
        for (const double number : numbers)
            values.push_back(static_cast<float>(is_unit ? number / std::sqrt(square) : number));
    }
    return values;
}

Node clip_of(const std::string& name, const std::vector<Keys>& tracks, std::vector<Node> more = {}) {
    test::Noise noise(7);
    std::vector<TrackRecord> records;
    std::vector<float> times;
    std::vector<float> values;
    for (const Keys& keys : tracks) {
        const std::uint16_t components = keys.path == TrackPath::rotation ? 4 : 3;
        const auto numbers = make_values(keys, components, noise);
        records.push_back(test::track(keys.target, keys.path, keys.interpolation, components,
                                      static_cast<std::uint32_t>(keys.times.size()),
                                      static_cast<std::uint32_t>(times.size()), values.size()));
        times.insert(times.end(), keys.times.begin(), keys.times.end());
        values.insert(values.end(), numbers.begin(), numbers.end());
    }
    ClipRecord info;
    info.start = 0.25f;
    info.end = 2.0f;
    Node node = test::make_container(FourCC("CYCL"), {test::make_leaf(FourCC("NAME"), std::as_bytes(std::span(name))),
                                                      test::make_leaf(FourCC("CINF"), bytes_of(info)),
                                                      test::make_leaf(FourCC("TRAK"), test::bytes_of_all(records)),
                                                      test::make_leaf(FourCC("TIME"), test::bytes_of_all(times)),
                                                      test::make_leaf(FourCC("KEYV"), test::bytes_of_all(values))});
    for (Node& leaf : more) node.children.push_back(std::move(leaf));
    return node;
}

Node curve_of(const std::string& name, CurveTarget kind, std::uint32_t target, Interpolation interpolation,
              const std::string& path = "glow") {
    static constexpr std::array kTimes{0.5f, 1.0f, 1.5f};
    static constexpr std::array kValues{0.0f, 1.0f, 4.0f, 1.0f, 2.0f, -1.0f, 0.5f, 3.0f, 1.0f};
    CurveView curve;
    curve.name = name;
    curve.path = path;
    curve.kind = kind;
    curve.target = target;
    curve.interpolation = interpolation;
    curve.keys = kTimes.size();
    curve.times = kTimes;
    curve.values = std::span(kValues).first(interpolation == Interpolation::cubic ? 9 : 3);
    return test::make_leaf(FourCC("CURV"), write_curve(curve));
}

RestRecord rest_of(const glm::quat& rotation, const glm::vec3& place) {
    RestRecord rest;
    rest.rotation = {rotation.x, rotation.y, rotation.z, rotation.w};
    rest.translation = {place.x, place.y, place.z};
    return rest;
}

Node target_of(const std::string& name) {
    return test::make_container(
        FourCC("TARG"), {test::make_leaf(FourCC("NAME"), std::as_bytes(std::span(name))),
                         test::make_leaf(FourCC("TINF"), bytes_of(MorphTargetRecord{})),
                         test::make_leaf(FourCC("POSI"), test::stream_payload<float>(3, {1, 0, 0, 0, 1, 0, 0, 0, 1}))});
}

const std::vector<float> kEnds{0.25f, 2.0f};
const std::vector<float> kSome{0.25f, 0.75f, 1.0f, 1.75f};
const std::vector<float> kInside{0.5f, 1.25f};

std::vector<Keys> all_tracks() {
    return {{hips, TrackPath::translation, Interpolation::linear, kSome},
            {hips, TrackPath::rotation, Interpolation::linear, kEnds},
            {spine, TrackPath::rotation, Interpolation::cubic, kSome},
            {arm_left, TrackPath::rotation, Interpolation::linear, kSome},
            {arm_right, TrackPath::rotation, Interpolation::cubic, kInside},
            {hand_left, TrackPath::rotation, Interpolation::step, kSome},
            {hand_left, TrackPath::translation, Interpolation::cubic, kSome},
            {hand_right, TrackPath::scale, Interpolation::linear, kInside},
            {sword, TrackPath::rotation, Interpolation::linear, kEnds},
            {0, TrackPath::weights, Interpolation::linear, kSome}};
}

/// A body that is symmetric about x = 0; its arms' axes are not mirrored, and its root is turned and scaled.
/// \param clips  CYCL
Buffer body(std::vector<Node> clips, bool has_roles = false) {
    const glm::quat lying = glm::angleAxis(static_cast<float>(-M_PI / 2), glm::vec3(1, 0, 0));
    const glm::quat left = glm::normalize(glm::quat(0.8f, 0.1f, -0.3f, 0.5f));
    const glm::quat right = glm::normalize(glm::quat(0.2f, 0.7f, 0.4f, -0.1f));
    const glm::vec3 to_hand(0.1f, 0.4f, -0.05f);  // in the axes of the spine
    const glm::vec3 mirrored(-to_hand.x, to_hand.y, to_hand.z);
    test::ModelSpec spec;
    spec.joints = {{kNone, rest_of(lying, {0, 0, 0}), {}, "rig"},
                   {rig, rest_of(glm::quat(1, 0, 0, 0), {0, 0, 0.5f}), {}, "hips"},
                   {hips, rest_of(glm::angleAxis(0.3f, glm::vec3(1, 0, 0)), {0, 0, 0.25f}), {}, "spine"},
                   {spine, rest_of(left, {0.25f, 0.1f, 0.2f}), {}, has_roles ? "a" : "arm.L"},
                   {arm_left, rest_of(right, glm::inverse(left) * to_hand), {}, has_roles ? "b" : "LeftHand"},
                   {spine, rest_of(right, {-0.25f, 0.1f, 0.2f}), {}, has_roles ? "c" : "arm.R"},
                   {arm_right, rest_of(left, glm::inverse(right) * mirrored), {}, has_roles ? "d" : "RightHand"},
                   {hand_right, rest_of(left, {0, 0.1f, 0}), {}, "sword"}};
    spec.joints[rig].rest.scale = {2, 2, 2};
    spec.meshes.push_back({kNone,
                           {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                           {},
                           {},
                           {0, 1, 2},
                           {target_of("smile"), target_of("wink_L"), target_of("wink_R")}});
    if (has_roles) {
        const auto role = [](std::uint32_t joint, Role is) {
            return RoleRecord{joint, static_cast<std::uint16_t>(is), 0};
        };
        const std::vector<RoleRecord> roles{role(hips, Role::hips), role(arm_left, Role::left_upper_arm),
                                            role(hand_left, Role::left_hand), role(arm_right, Role::right_upper_arm),
                                            role(hand_right, Role::right_hand)};
        spec.more.push_back(test::make_leaf(FourCC("ROLE"), test::bytes_of_all(roles)));
    }
    for (Node& clip : clips) spec.more.push_back(std::move(clip));
    return test::build_file(spec);
}

Buffer body_with_all(bool has_roles = false) {
    const std::vector<MarkerRecord> markers{{0.25f, 6}, {1.0f, 16}, {1.5f, 22}};
    return body({clip_of("TurnLeft", all_tracks(),
                         {test::make_leaf(FourCC("MARK"), test::markers_payload(markers, "step.Lright stepstep.R")),
                          curve_of("glow left", CurveTarget::joint, arm_left, Interpolation::linear),
                          curve_of("cubic", CurveTarget::nothing, kNone, Interpolation::cubic)})},
                has_roles);
}

Buffer changed(const Buffer& file, const std::string& word, const std::string& text, Log* log = nullptr) {
    Log unheard;
    const auto change = parse_clip_change(word, std::span(&text, 1));
    EXPECT_TRUE(change) << change.error().message;
    if (!change) return {};
    Edited edited = change_clips(file, *change, log == nullptr ? unheard : *log);
    EXPECT_TRUE(edited) << edited.error().message;
    return edited ? *std::move(edited) : Buffer();
}

/// What is wrong with the text of an option, or with the clip.
std::string wrong(const Buffer& file, const std::string& word, const std::string& text) {
    const auto change = parse_clip_change(word, std::span(&text, 1));
    if (!change) return change.error().message;
    Log log;
    const Edited edited = change_clips(file, *change, log);
    return edited ? std::string() : edited.error().message;
}

/// The pose of a clip: the joints' matrices, then the weights.
std::vector<float> pose_at(const Model& model, std::size_t clip, double seconds) {
    Pose pose(model);
    EXPECT_TRUE(sample(pose, &model.clips()[clip], static_cast<float>(seconds)));
    std::vector<float> numbers;
    for (const glm::mat4& matrix : pose.model_space()) {
        for (int k = 0; k < 16; ++k) numbers.push_back(matrix[k / 4][k % 4]);
    }
    const auto weights = pose.morph_weights();
    numbers.insert(numbers.end(), weights.begin(), weights.end());
    return numbers;
}

void expect_same(const std::vector<float>& a, const std::vector<float>& b, double tolerance, double seconds) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k)
        ASSERT_NEAR(a[k], b[k], tolerance) << "number " << k << " at " << seconds;
}

glm::vec3 place_of(const std::vector<float>& pose, std::uint32_t joint) {
    return {pose[joint * 16 + 12], pose[joint * 16 + 13], pose[joint * 16 + 14]};
}

std::string markers_of(const Buffer& file) {
    const Loaded loaded(file);
    std::string text;
    for (const Marker& marker : loaded.document.objects.front().clips.front().markers)
        text += std::string(marker.name) + '@' + std::to_string(marker.seconds) + ' ';
    return text;
}

TEST(Trim, KeepsEveryPoseOfThePart) {
    const Buffer file = body_with_all();
    const Owned before(file);
    for (const auto& [from, to] :
         {std::pair(0.3, 1.9), std::pair(0.75, 1.0), std::pair(1.1, 1.2), std::pair(0.25, 2.0)}) {
        const Owned after(changed(file, "trim", "TurnLeft=" + std::to_string(from) + ".." + std::to_string(to)));
        const Clip& clip = after->clips()[0];
        EXPECT_EQ(clip.start, 0.0f);
        EXPECT_NEAR(clip.end, to - from, 1e-6);
        for (int k = 0; k <= 40; ++k) {
            const double t = (to - from) * k / 40;
            if (k % 40 != 0 && std::abs(from + t - 0.75) < 1e-3) continue;  // beside a step
            expect_same(pose_at(*before, 0, from + t), pose_at(*after, 0, t), 2e-5, from + t);
        }
    }
}

TEST(Trim, KeepsKeysInsideBitByBit) {
    const Loaded before(body_with_all());
    const Loaded after(changed(body_with_all(), "trim", "TurnLeft=0.5.."));
    const TrackView& old_track = before.document.objects.front().clips.front().tracks[0];
    const TrackView& new_track = after.document.objects.front().clips.front().tracks[0];
    ASSERT_EQ(new_track.keys, 4u);  // one is added, one is gone
    for (std::size_t k = 1; k < 4; ++k) {
        EXPECT_EQ(new_track.times[k], old_track.times[k] - 0.5f);
        for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(new_track.values[k * 3 + c], old_track.values[k * 3 + c]);
    }
}

TEST(Trim, MovesMarkersAndCurves) {
    Log log;
    const Buffer file = changed(body_with_all(), "trim", "TurnLeft=0.75..1.25", &log);
    EXPECT_EQ(markers_of(file), "right step@0.250000 ");
    ASSERT_EQ(log.warnings.size(), 1u);
    EXPECT_EQ(log.warnings[0], "clip \"TurnLeft\": markers outside the part are left out: \"step.L\" and \"step.R\"");
    const Loaded before(body_with_all());
    const Loaded after(file);
    for (std::size_t k = 0; k < 2; ++k) {
        const CurveView& was = before.document.objects.front().clips.front().curves[k];
        const CurveView& now = after.document.objects.front().clips.front().curves[k];
        for (const float t : {0.0f, 0.1f, 0.25f, 0.4f, 0.5f}) {
            float a = 0.0f;
            float b = 0.0f;
            ASSERT_TRUE(sample_curve(was, t + 0.75f, std::span(&a, 1)));
            ASSERT_TRUE(sample_curve(now, t, std::span(&b, 1)));
            EXPECT_NEAR(a, b, 1e-6) << t;
        }
    }
}

TEST(Resample, GoesThroughThePoses) {
    const Buffer file = body_with_all();
    const Owned before(file);
    const Owned after(changed(file, "resample", "TurnLeft@16"));
    for (int k = 0; k <= 28; ++k)
        expect_same(pose_at(*before, 0, 0.25 + k / 16.0), pose_at(*after, 0, 0.25 + k / 16.0), 1e-5, k);
    for (const TrackView& track : after->clips()[0].tracks) {
        if (track.interpolation == Interpolation::step) continue;
        EXPECT_EQ(track.keys, 29u);
        EXPECT_EQ(track.interpolation, Interpolation::linear);
    }
    const Owned coarse(changed(file, "resample", "*@0.8"));  // the end is no frame
    EXPECT_EQ(coarse->clips()[0].tracks[0].keys, 3u);
    expect_same(pose_at(*before, 0, 2.0), pose_at(*coarse, 0, 2.0), 1e-5, 2.0);
}

TEST(Loop, EndsAsItStartsAndChangesTheLastSecondsOnly) {
    const Buffer file = body_with_all();
    const Owned before(file);
    const Owned after(changed(file, "loop", "TurnLeft=0.5"));
    EXPECT_TRUE(after->clips()[0].loop);
    expect_same(pose_at(*after, 0, 0.25), pose_at(*after, 0, 2.0), 1e-6, 2.0);
    for (int k = 0; k <= 20; ++k) {
        const double t = 0.25 + 1.25 * k / 20;
        expect_same(pose_at(*before, 0, t), pose_at(*after, 0, t), 1e-6, t);
    }
    const auto close = pose_at(*after, 0, 1.50001);  // nothing jumps where the drift begins
    const auto there = pose_at(*before, 0, 1.50001);
    expect_same(close, there, 1e-3, 1.50001);
}

/// In the mirrored clip, each joint is where its counterpart's mirror image was.
void expect_mirrored(const Owned& before, const Owned& after) {
    constexpr std::array<std::uint32_t, count> kOther{rig,        hips,     spine,     arm_right,
                                                      hand_right, arm_left, hand_left, sword};
    for (int k = 0; k <= 35; ++k) {
        const double t = 0.25 + k / 20.0;
        const auto was = pose_at(*before, 0, t);
        const auto now = pose_at(*after, 0, t);
        for (std::uint32_t joint = 0; joint < sword; ++joint) {
            const glm::vec3 place = place_of(was, joint);
            const glm::vec3 image(-place.x, place.y, place.z);
            EXPECT_LT(glm::distance(image, place_of(now, kOther[joint])), 2e-5f) << joint << " at " << t;
        }
    }
}

TEST(Mirror, MovesEachJointToTheMirrorImageOfItsCounterpart) {
    for (const bool has_roles : {false, true}) {
        const Buffer file = body_with_all(has_roles);
        Log log;
        const Buffer mirrored = changed(file, "mirror", "*", &log);
        expect_mirrored(Owned(file), Owned(mirrored));
        ASSERT_EQ(log.warnings.size(), 1u);
        EXPECT_EQ(log.warnings[0], "not mirrored, without a counterpart: joint \"sword\"");
    }
}

TEST(Mirror, TwiceIsTheFirstClip) {
    const Buffer file = body_with_all();
    const Owned before(file);
    const Owned again(changed(changed(file, "mirror", "#0"), "mirror", "#0"));
    for (int k = 0; k <= 35; ++k)
        expect_same(pose_at(*before, 0, 0.25 + k / 20.0), pose_at(*again, 0, 0.25 + k / 20.0), 1e-5, k);
    EXPECT_EQ(markers_of(changed(changed(file, "mirror", "*"), "mirror", "*")), markers_of(file));
}

TEST(Mirror, IsExactWhereSidesHaveMirroredAxes) {
    const auto joint = [](std::uint32_t parent, const glm::quat& rotation, const glm::vec3& place, const char* name) {
        return test::JointSpec{parent, rest_of(rotation, place), {}, name};
    };
    const glm::quat left = glm::normalize(glm::quat(0.8f, 0.1f, -0.3f, 0.5f));
    const glm::quat right(left.w, left.x, -left.y, -left.z);
    test::ModelSpec spec;
    spec.joints = {joint(kNone, glm::quat(1, 0, 0, 0), {0, 1, 0}, "hips"), joint(0, left, {0.3f, 0.2f, 0.1f}, "hand_l"),
                   joint(0, right, {-0.3f, 0.2f, 0.1f}, "hand_r")};
    spec.more.push_back(clip_of("Wave", {{1, TrackPath::rotation, Interpolation::linear, kSome},
                                         {2, TrackPath::rotation, Interpolation::cubic, kSome},
                                         {2, TrackPath::translation, Interpolation::linear, kSome}}));
    const Buffer file = test::build_file(spec);
    const Buffer once = changed(file, "mirror", "Wave");
    EXPECT_NE(once, file);
    const Buffer again = changed(once, "mirror", "Wave");
    const Loaded before(file);
    const Loaded after(again);
    for (std::size_t t = 0; t < 3; ++t) {
        const TrackView& a = before.document.objects.front().clips.front().tracks[t];
        const TrackView& b = after.document.objects.front().clips.front().tracks[t];
        EXPECT_EQ(a.target, b.target);
        EXPECT_EQ(std::vector<float>(a.values.begin(), a.values.end()),
                  std::vector<float>(b.values.begin(), b.values.end()));
    }
}

TEST(Mirror, SwapsTargetsMarkersAndCurves) {
    const Buffer file = changed(body_with_all(), "mirror", "TurnLeft");
    EXPECT_EQ(markers_of(file), "step.R@0.250000 left step@1.000000 step.L@1.500000 ");
    const Loaded before(body_with_all());
    const Loaded after(file);
    const ClipView& was = before.document.objects.front().clips.front();
    const ClipView& now = after.document.objects.front().clips.front();
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(was.tracks.back().values[k * 3], now.tracks.back().values[k * 3]);
        EXPECT_EQ(was.tracks.back().values[k * 3 + 1], now.tracks.back().values[k * 3 + 2]);
        EXPECT_EQ(was.tracks.back().values[k * 3 + 2], now.tracks.back().values[k * 3 + 1]);
    }
    EXPECT_EQ(now.curves[0].name, "glow right");
    EXPECT_EQ(now.curves[0].target, arm_right);
}

/// A curve as "name kind target path".
std::string text_of(const CurveView& curve) {
    return std::string(curve.name) + ' ' +
           std::string(kValueNames<CurveTarget>.at(static_cast<std::size_t>(curve.kind))) +
           (curve.target == kNone ? "" : ' ' + std::to_string(curve.target)) + ' ' + std::string(curve.path);
}

Node leaf_of(FourCC id, const std::string& text) {
    return test::make_leaf(id, std::as_bytes(std::span(text)));
}

/// A body with curves in its clip "Act", materials, and lights.
Buffer body_with_curves(const std::vector<Node>& curves, std::vector<Keys> tracks = {}) {
    tracks.push_back({arm_left, TrackPath::rotation, Interpolation::linear, kSome});
    Node root = test::to_node(body({clip_of("Act", tracks, curves)}));
    for (const char* name : {"eye.L", "skin", "eye.R"}) {
        root.children.push_back(test::make_container(
            FourCC("MATE"),
            {leaf_of(FourCC("NAME"), name), test::make_leaf(FourCC("SURF"), bytes_of(SurfaceRecord{}))}));
    }
    root.children.push_back(leaf_of(FourCC("EXTN"), R"({"KHR_lights_punctual":{"lights":[
        {"type":"point","name":"lamp_right"},{"type":"point","name":"sun"},{"type":"point","name":"lamp_left"}]},
        "ACME":{"left":1,"up":2,"leftEye":{"open":1},"rightEye":{"open":1}}})"));
    test::edit<VersionRecord>(test::at(root, "HEAD/VERS"), [](VersionRecord& version) { version.materials = 3; });
    return test::to_file(root);
}

/// What a curve becomes if the clip is mirrored.
std::string mirrored(const std::string& name, CurveTarget kind, std::uint32_t target, const std::string& path,
                     Log* log = nullptr) {
    const Buffer file = body_with_curves({curve_of(name, kind, target, Interpolation::linear, path)});
    const Buffer after = changed(file, "mirror", "Act", log);
    if (after.empty()) return {};
    return text_of(Loaded(after).document.objects.front().clips.front().curves.front());
}

TEST(Mirror, BringsPathsAndNamesOfCurvesToTheOtherSide) {
    const auto nothing = CurveTarget::nothing;
    EXPECT_EQ(mirrored("left_step", nothing, kNone, "/extras/left_step"), "right_step nothing /extras/right_step");
    EXPECT_EQ(mirrored("grip_L", nothing, kNone, "/extras/grip_L"), "grip_R nothing /extras/grip_R");
    EXPECT_EQ(mirrored("", nothing, kNone, "/extras/hands/LeftGrip"), " nothing /extras/hands/RightGrip");
    EXPECT_EQ(mirrored("left_heel_contact", nothing, kNone, "/extras/left_heel_contact"),
              "right_heel_contact nothing /extras/right_heel_contact");
    EXPECT_EQ(mirrored("glow.L", CurveTarget::joint, arm_left, "extras/glow.L"), "glow.R joint 5 extras/glow.R");
    EXPECT_EQ(mirrored("smirk_L", CurveTarget::mesh, 0, "extras/smirk_L"), "smirk_R mesh 0 extras/smirk_R");
    EXPECT_EQ(mirrored("left", CurveTarget::material, 0, "emissiveFactor"), "right material 2 emissiveFactor");
    EXPECT_EQ(mirrored("pale", CurveTarget::material, 1, "emissiveFactor"), "pale material 1 emissiveFactor");
}

TEST(Mirror, FollowsPointersIntoExtensions) {
    const auto nothing = CurveTarget::nothing;
    const std::string lights = "/extensions/KHR_lights_punctual/lights/";
    EXPECT_EQ(mirrored("left", nothing, kNone, lights + "2/intensity"), "right nothing " + lights + "0/intensity");
    EXPECT_EQ(mirrored("sun", nothing, kNone, lights + "1/color"), "sun nothing " + lights + "1/color");
    EXPECT_EQ(mirrored("x", nothing, kNone, "/extensions/ACME/leftEye/open"),
              "x nothing /extensions/ACME/rightEye/open");
    EXPECT_EQ(mirrored("up left", nothing, kNone, "/extensions/ACME/up"), "up right nothing /extensions/ACME/up");
    Log log;  // a member that the object does not have yet may be made
    EXPECT_EQ(mirrored("x", nothing, kNone, "/extensions/GONE/left", &log), "x nothing /extensions/GONE/right");
    EXPECT_TRUE(log.warnings.empty());
    EXPECT_EQ(mirrored("x", nothing, kNone, lights + "9/left", &log), "x nothing " + lights + "9/right");
}

TEST(Mirror, LetsCurvesWithoutSidesInTheirPathsChangePlaces) {
    const auto curve = [](const std::string& name, const std::string& path) {
        return curve_of(name, CurveTarget::nothing, kNone, Interpolation::linear, path);
    };
    const Buffer file = body_with_curves({curve("left step", "/extras/steps/0"), curve("right step", "/extras/steps/1"),
                                          curve("left alone", "/extras/alone")});
    const Loaded after(changed(file, "mirror", "Act"));
    const auto& curves = after.document.objects.front().clips.front().curves;
    EXPECT_EQ(text_of(curves[0]), "right step nothing /extras/steps/1");
    EXPECT_EQ(text_of(curves[1]), "left step nothing /extras/steps/0");
    EXPECT_EQ(text_of(curves[2]), "right alone nothing /extras/alone");
    const Loaded twice(changed(changed(file, "mirror", "Act"), "mirror", "Act"));
    EXPECT_EQ(text_of(twice.document.objects.front().clips.front().curves[0]), "left step nothing /extras/steps/0");
}

/// The joint of an expression has its weight as X, which is not a place.
TEST(Mirror, KeepsTheWeightsOfExpressions) {
    const auto expression = [](const std::string& name, std::uint32_t joint) {
        return curve_of(name, CurveTarget::joint, joint, Interpolation::linear, std::string(kExpressionPath));
    };
    const std::vector<Keys> moves{{hand_left, TrackPath::translation, Interpolation::linear, kSome}};
    const auto values_of = [](const Loaded& file) {
        const TrackView& track = file.document.objects.front().clips.front().tracks.front();
        return std::pair(track.target, std::vector<float>(track.values.begin(), track.values.end()));
    };
    const Buffer file = body_with_curves({expression("blinkLeft", hand_left), expression("blinkRight", hips)}, moves);
    const Loaded before(file);
    const Loaded after(changed(file, "mirror", "Act"));
    EXPECT_EQ(values_of(after), std::pair(std::uint32_t{hips}, values_of(before).second));
    const auto& curves = after.document.objects.front().clips.front().curves;
    EXPECT_EQ(text_of(curves[0]), "blinkRight joint 1 translation/0");
    EXPECT_EQ(text_of(curves[1]), "blinkLeft joint 4 translation/0");

    Log log;
    const Buffer one = body_with_curves({expression("blinkLeft", spine)},
                                        {{spine, TrackPath::translation, Interpolation::linear, kSome}});
    const Loaded alone(changed(one, "mirror", "Act", &log));
    EXPECT_EQ(values_of(alone), values_of(Loaded(one)));
    EXPECT_EQ(text_of(alone.document.objects.front().clips.front().curves[0]), "blinkLeft joint 2 translation/0");
    EXPECT_EQ(log.warnings, std::vector<std::string>{"not mirrored, without a counterpart: curve \"blinkLeft\""});
}

TEST(Mirror, SaysWhatStaysOnItsSide) {
    Log log;  // sword is below the right hand only
    EXPECT_EQ(mirrored("left glow", CurveTarget::joint, sword, "extras/left", &log), "left glow joint 7 extras/left");
    EXPECT_EQ(log.warnings, std::vector<std::string>{"not mirrored, without a counterpart: curve \"left glow\""});
    log.warnings.clear();
    const Buffer file = body({clip_of("Act", {{arm_left, TrackPath::rotation, Interpolation::linear, kSome}},
                                      {leaf_of(FourCC("EXTR"), R"({"foot":"left"})")})});
    changed(file, "mirror", "Act", &log);
    EXPECT_EQ(log.warnings, std::vector<std::string>{"clip \"Act\": EXTR tells left or right, and stays as it is"});
}

TEST(Mirror, ReadsSidesInNames) {
    const auto is_mirrored = [](const std::string& left, const std::string& right) {
        test::ModelSpec spec;
        spec.joints = {{kNone, test::moved(0, 1, 0), {}, "hips"},
                       {0, test::moved(1, 0, 0), {}, left},
                       {0, test::moved(-1, 0, 0), {}, right}};
        spec.more.push_back(clip_of("Wave", {{1, TrackPath::rotation, Interpolation::linear, kSome}}));
        const std::string text = "Wave";
        Log log;
        const Edited edited =
            change_clips(test::build_file(spec), *parse_clip_change("mirror", std::span(&text, 1)), log);
        return edited && Loaded(*edited).document.objects.front().clips.front().tracks.front().target == 2;
    };
    EXPECT_TRUE(is_mirrored("mixamorig:LeftArm", "mixamorig:RightArm"));
    EXPECT_TRUE(is_mirrored("arm.L.001", "arm.R.001"));
    EXPECT_TRUE(is_mirrored("J_Bip_L_UpperArm", "J_Bip_R_UpperArm"));
    EXPECT_TRUE(is_mirrored("Bip01 L Arm", "Bip01 R Arm"));
    EXPECT_TRUE(is_mirrored("lShldr", "rShldr"));
    EXPECT_TRUE(is_mirrored("ArmL", "ArmR"));
    EXPECT_TRUE(is_mirrored("LArm", "RArm"));
    EXPECT_TRUE(is_mirrored("leftarm", "rightarm"));
    EXPECT_TRUE(is_mirrored("HAND_LEFT", "HAND_RIGHT"));
    EXPECT_TRUE(is_mirrored("左腕", "右腕"));
    EXPECT_FALSE(is_mirrored("cleft", "cright"));
    EXPECT_FALSE(is_mirrored("pool", "poor"));
}

TEST(RootMotion, IsTakenOutAndGivenToAJointAbove) {
    const std::vector<Keys> tracks{{hips, TrackPath::translation, Interpolation::cubic, kSome},
                                   {hips, TrackPath::rotation, Interpolation::linear, kEnds},
                                   {spine, TrackPath::rotation, Interpolation::linear, kSome}};
    const Buffer file = body({clip_of("Walk", tracks)}, true);
    const Owned before(file);
    const Owned still(changed(file, "root-motion", "Walk=.."));
    const Owned moved(changed(file, "root-motion", "Walk=hips..rig"));
    RootAxes axes;
    axes.turn = RootTurn::none;
    const RootPath path(*before, hips, axes);
    const RootPath root(*moved, rig, axes);
    for (int k = 0; k <= 35; ++k) {
        const double t = 0.25 + k / 20.0;
        const auto was = pose_at(*before, 0, t);
        auto now = pose_at(*moved, 0, t);
        std::copy(was.begin(), was.begin() + 16, now.begin());  // the rig's own matrix: it moves instead
        expect_same(was, now, 1e-5, t);
        const glm::dvec3 way = path.at(before->clips()[0], t)->translation;
        EXPECT_GT(glm::length(way), 0.0);
        EXPECT_LT(glm::distance(way, root.at(moved->clips()[0], t)->translation), 1e-5);
        EXPECT_LT(
            glm::distance(glm::dvec3(place_of(was, hips)) - way, glm::dvec3(place_of(pose_at(*still, 0, t), hips))),
            1e-5);
    }
}

TEST(RootMotion, SaysWhyItCannot) {
    const Buffer file = body({clip_of("Walk", all_tracks())}, true);
    EXPECT_EQ(wrong(file, "root-motion", "Walk=hips..spine"),
              "clip \"Walk\": joint \"spine\" is not above \"hips\", whose movement it would get");
    EXPECT_EQ(wrong(file, "root-motion", "Walk=b..rig"),
              "clip \"Walk\": joint \"a\" above \"b\" moves too; give it as the one that root motion is taken from");
    EXPECT_EQ(wrong(file, "root-motion", "Walk=rig"), "\"Walk=rig\" is not CLIP=FROM..TO");
    EXPECT_EQ(wrong(body({clip_of("Walk", all_tracks())}), "root-motion", "Walk=.."),
              "clip \"Walk\": no joint has the role hips; name the joint that moves, as in CLIP=JOINT..");
}

/// A clip of 12 s in which the hips go along a path and sway about it, once a second; keys at 60 a second. A spine that
/// turns with the sway is its cycle.
Buffer walk_along(const std::function<glm::dvec2(double)>& path, Interpolation interpolation, bool has_roles = true) {
    const double sway = 2.0 * M_PI;
    const auto place = [&](double t) {
        const glm::dvec2 ground = path(t) + glm::dvec2(0.03 * std::sin(sway * t), 0.02 * std::cos(2.0 * sway * t));
        return glm::dvec3(ground.x, 0.9 + 0.02 * std::sin(sway * t), ground.y);
    };
    test::ClipSpec clip{"Walk", 0.0f, 12.0f};
    test::TrackSpec moved{TrackPath::translation, 0, 3, {}, {}}, turned{TrackPath::rotation, 1, 4, {}, {}};
    const double h = 1.0 / 60.0;
    for (int k = 0; k <= 720; ++k) {
        const double t = k * h;
        std::vector<glm::dvec3> rows{place(t)};
        const glm::dvec3 slope = (place(t + 1e-4) - place(t - 1e-4)) / 2e-4;
        if (interpolation == Interpolation::cubic) rows = {slope, place(t), slope};
        moved.times.push_back(static_cast<float>(t));
        turned.times.push_back(static_cast<float>(t));
        for (const glm::dvec3& row : rows)
            for (int c = 0; c < 3; ++c) moved.values.push_back(static_cast<float>(row[c]));
        const double angle = 0.2 * std::sin(sway * t);
        for (const double number : {0.0, std::sin(angle), 0.0, std::cos(angle)})
            turned.values.push_back(static_cast<float>(number));
    }
    clip.tracks = {moved, turned};
    Node node = test::clip_node(clip);
    test::child(node, "TRAK").payload.at(offsetof(TrackRecord, interpolation)) = static_cast<std::byte>(interpolation);
    test::ModelSpec spec;
    spec.joints = {{kNone, rest_of(glm::quat(1, 0, 0, 0), {0, 0.9f, 0}), {}, "hips"},
                   {0, rest_of(glm::quat(1, 0, 0, 0), {0, 0.2f, 0}), {}, "spine"}};
    if (has_roles) {
        const std::vector<RoleRecord> roles{{0, static_cast<std::uint16_t>(Role::hips), 0}};
        spec.more.push_back(test::make_leaf(FourCC("ROLE"), test::bytes_of_all(roles)));
    }
    spec.more.push_back(node);
    return test::build_file(spec);
}

TEST(OnTheSpot, TakesTheWayOutAndKeepsWhatSwaysAboutIt) {
    const std::array<std::function<glm::dvec2(double)>, 3> paths{
        [](double t) { return glm::dvec2(0.5 * t, 1.4 * t); },
        [](double t) { return 5.0 * glm::dvec2(std::cos(0.3 * t) - 1.0, std::sin(0.3 * t)); },
        [](double) { return glm::dvec2(0.0, 2.0); }};
    for (const Interpolation interpolation : {Interpolation::linear, Interpolation::cubic}) {
        for (const auto& path : paths) {
            Log log;
            const Owned made(changed(walk_along(path, interpolation), "on-the-spot", "Walk", &log));
            EXPECT_TRUE(log.warnings.empty());
            for (int k = 0; k <= 2400; ++k) {
                const double t = k / 200.0;
                const glm::dvec3 now(place_of(pose_at(*made, 0, t), 0));
                const double sway = 2.0 * M_PI * t;
                EXPECT_NEAR(now.y, 0.9 + 0.02 * std::sin(sway), 1e-3);
                // A circle bends by 20 mm within a cycle, and at the ends nothing says how it goes on.
                const bool is_end = t < 0.5 || t > 11.5;
                const double bound = &path != &paths[1] ? 1e-3 : is_end ? 0.04 : 0.02;
                EXPECT_NEAR(now.x, 0.03 * std::sin(sway), bound) << t;
                EXPECT_NEAR(now.z, 0.02 * std::cos(2.0 * sway), bound) << t;
            }
        }
    }
}

TEST(OnTheSpot, AveragesOverACycleOrAsLongAsIsSaid) {
    const auto straight = [](double t) { return glm::dvec2(0.0, t); };
    Log log;
    (void)changed(walk_along(straight, Interpolation::linear), "on-the-spot", "Walk", &log);
    EXPECT_EQ(log.done.front(), "clip \"Walk\", 12 m at 1 m/s, averaged over 1 s: taken out of joint \"hips\"");
    (void)changed(changed(walk_along(straight, Interpolation::linear), "trim", "Walk=0..7.3"), "on-the-spot", "Walk",
                  &log);
    EXPECT_NE(log.done.back().find("averaged over 1 s"), std::string::npos) << log.done.back();
    (void)changed(walk_along(straight, Interpolation::linear), "on-the-spot", "Walk@0.5", &log);
    EXPECT_NE(log.done.back().find("averaged over 0.5 s"), std::string::npos) << log.done.back();
    EXPECT_TRUE(log.warnings.empty());
    (void)changed(changed(walk_along(straight, Interpolation::linear), "trim", "Walk=0..0.4"), "on-the-spot", "Walk",
                  &log);
    EXPECT_NE(log.warnings.at(0).find("has no cycle that repeats"), std::string::npos);
}

TEST(OnTheSpot, SaysWhyItCannot) {
    const auto straight = [](double t) { return glm::dvec2(0.0, t); };
    const Buffer file = walk_along(straight, Interpolation::linear);
    EXPECT_EQ(wrong(file, "on-the-spot", "Walk@0"), "\"Walk@0\" is not CLIP[@SECONDS]");
    EXPECT_EQ(wrong(file, "on-the-spot", "Walk@13"),
              "clip \"Walk\": it lasts 12 s, and its way cannot be averaged over 13 s");
    EXPECT_EQ(wrong(walk_along(straight, Interpolation::linear, false), "on-the-spot", "Walk"),
              "clip \"Walk\": no joint has the role hips; --role hips=JOINT says which joint moves");
    const auto far = [](double t) { return glm::dvec2(1e25 * t * t, 0.0); };
    EXPECT_EQ(wrong(walk_along(far, Interpolation::linear), "on-the-spot", "Walk@1"), "");
}

TEST(Clips, AreKeptAndCopied) {
    const Buffer file = body({clip_of("Walk", all_tracks()), clip_of("Run", all_tracks()), clip_of("Idle", {})});
    const std::vector<std::string> names{"Idle", "W*"};
    Log log;
    const Edited kept = change_clips(file, *parse_clip_change("keep-clip", names), log);
    ASSERT_TRUE(kept);
    EXPECT_EQ(*kept, *strip(file, {Part::clips, "Run"}, log));
    EXPECT_EQ(log.done.front(), "stripped 1 clip: \"Run\"");
    const Loaded copied(changed(file, "copy-clip", "*=*_2"));
    const auto& clips = copied.document.objects.front().clips;
    ASSERT_EQ(clips.size(), 6u);
    EXPECT_EQ(clips[1].name, "Walk_2");
    EXPECT_EQ(clips[3].name, "Run_2");
    EXPECT_EQ(wrong(file, "copy-clip", "Walk=Run"), "clip \"Walk\": there is a clip \"Run\" already");
    EXPECT_EQ(wrong(file, "copy-clip", "*=Jump"), "clip \"Run\": there is a clip \"Jump\" already");
}

TEST(Clips, SayWhatIsWrong) {
    const Buffer file = body({clip_of("Walk", all_tracks())});
    EXPECT_EQ(wrong(file, "trim", "Walk=1..3"), "clip \"Walk\": it lasts from 0.25 to 2 s, and 3 s is outside");
    EXPECT_EQ(wrong(file, "trim", "Walk=2..1"), "a part from 2 to 1 s ends before it begins");
    EXPECT_EQ(wrong(file, "trim", "Walk=1"), "\"Walk=1\" is not CLIP=A..B");
    EXPECT_EQ(wrong(file, "trim", "Walk=nan.."), "\"Walk=nan..\" is not CLIP=A..B");
    EXPECT_EQ(wrong(file, "trim", "Wlak=..1"), "there is no clip \"Wlak\"; did you mean \"Walk\"? There is \"Walk\"");
    EXPECT_EQ(wrong(file, "resample", "Walk@0"), "0 keys per second: the rate must be from 0.001 to 10000");
    EXPECT_EQ(wrong(file, "resample", "Walk@-1"), "-1 keys per second: the rate must be from 0.001 to 10000");
    EXPECT_EQ(wrong(file, "resample", "Walk=30"), "\"Walk=30\" is not CLIP@RATE");
    EXPECT_EQ(wrong(body({clip_of("Still", {})}), "resample", "*@30"),
              "clip \"Still\" cannot be resampled: it has no keys");
    EXPECT_EQ(wrong(file, "loop", "Walk=0"), "0 s: the end must drift for a time above 0");
    EXPECT_EQ(wrong(file, "loop", "Walk=2"), "clip \"Walk\": it lasts 1.75 s, which is less than 2 s");
    EXPECT_EQ(wrong(body({}), "mirror", "*"), "the file has no clips");
    EXPECT_EQ(
        wrong(test::sample_file(), "mirror", "run"),
        "clip \"run\": no two joints are a left and a right one, by their roles or by names such as arm.L and arm.R; "
        "--role ROLE=JOINT says what they are");
    Node root = test::to_node(file);
    test::edit<ClipRecord>(test::at(root, "HEAD/OBJE/CYCL/CINF"), [](ClipRecord& info) { info.end = 1e6f; });
    EXPECT_EQ(wrong(test::to_file(root), "resample", "Walk@60"),
              "clip \"Walk\": it would have 6e+07 keys, and more than 1e+06 are too many");
}

TEST(Clips, ThatArePackedBecomeKeys) {
    const Buffer file = test::build_file(test::packed_spec(6, 20, 8));
    const Owned before(file);
    Log log;
    const Owned after(changed(file, "trim", "packed=0.6..1.2", &log));
    ASSERT_EQ(log.warnings.size(), 1u);
    EXPECT_NE(log.warnings[0].find("packed tracks are ordinary keys now"), std::string::npos) << log.warnings[0];
    EXPECT_FALSE(after->clips()[0].packed);
    for (int k = 0; k <= 20; ++k)
        expect_same(pose_at(*before, 0, 0.6 + 0.03 * k), pose_at(*after, 0, 0.03 * k), 1e-4, k);
}

TEST(Clips, OfDamagedFilesAreRefusedOrValid) {
    const Buffer good = body_with_all();
    for (std::size_t at = 16; at < good.size(); at += 5) {
        Buffer file = good;
        file[at] ^= std::byte{static_cast<unsigned char>(1u << (at % 8))};
        if (!test::resum(file)) continue;
        for (const auto& [word, text] :
             {std::pair("mirror", "*"), std::pair("trim", "*=0.5..1"), std::pair("loop", "*=0.5"),
              std::pair("root-motion", "*=hips..rig"), std::pair("on-the-spot", "*")}) {
            const std::string said = text;
            Log log;
            const Edited edited = change_clips(file, *parse_clip_change(word, std::span(&said, 1)), log);
            if (edited) {
                EXPECT_TRUE(validate(*edited).empty());
            } else {
                EXPECT_EQ(edited.error().message.find("would not be valid"), std::string::npos)
                    << edited.error().message;
            }
        }
    }
}

TEST(Influences, KeepTheLargestAndTheSum) {
    Node root = test::sample();
    Node& mesh = test::at(root, "HEAD/OBJE/VECT");
    test::child(mesh, "BONE").payload = test::stream_payload<std::uint8_t>(3, {0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1});
    test::child(mesh, "WGHT").payload =
        test::stream_payload<float>(3, {0.2f, 0.5f, 0.3f, 0.0f, 0.75f, 0.25f, 1.0f, 0.0f, 0.0f, 0.25f, 0.25f, 0.5f});
    Log log;
    const Edited edited = limit_influences(test::to_file(root), 2, log);
    ASSERT_TRUE(edited) << edited.error().message;
    const Loaded loaded(*edited);
    const MeshView& now = loaded.document.objects.front().meshes.front();
    const auto weights = now.weights->as<float>();
    const auto bones = now.bones->as<std::uint8_t>();
    EXPECT_EQ(std::vector<std::uint8_t>(bones.begin(), bones.end()),
              (std::vector<std::uint8_t>{1, 0, 0, 1, 0, 0, 1, 1}));
    const std::vector<float> expected{0.625f, 0.375f, 0.75f, 0.25f, 1.0f, 0.0f, 1.0f / 3, 2.0f / 3};
    for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(weights[k], expected[k], 1e-6);
    EXPECT_EQ(log.done.front(),
              "mesh \"fur\": 2 of 4 vertices had more than 2 influences; the largest sum of weights that "
              "one loses is 0.25");
    const Edited same = limit_influences(*edited, 2, log);
    ASSERT_TRUE(same);
    EXPECT_EQ(*same, *edited);
    EXPECT_FALSE(limit_influences(*edited, 0, log));
}

TEST(Influences, OfIntegersSumToTheLastOne) {
    Node root = test::sample();
    Node& mesh = test::at(root, "HEAD/OBJE/VECT");
    test::child(mesh, "BONE").payload = test::stream_payload<std::uint8_t>(4, std::vector<std::uint8_t>(16, 1));
    test::child(mesh, "WGHT").payload =
        test::stream_payload<std::uint8_t>(4, {100, 60, 50, 45, 85, 85, 84, 1, 255, 0, 0, 0, 64, 64, 64, 63}, true);
    Log log;
    const Edited edited = limit_influences(test::to_file(root), 3, log);
    ASSERT_TRUE(edited) << edited.error().message;
    const Loaded loaded(*edited);
    const auto weights = loaded.document.objects.front().meshes.front().weights->as<std::uint8_t>();
    for (std::size_t k = 0; k < 12; k += 3) EXPECT_EQ(weights[k] + weights[k + 1] + weights[k + 2], 255);
    EXPECT_EQ(weights[6], 255);
}

}  // namespace
}  // namespace bendy::edit::clips_test
