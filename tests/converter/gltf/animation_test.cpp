#include "build_gltf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bendy::converter::animation_test {
namespace {

using namespace test;

/// One animated node; `values` as `type`.
Import import_keys(const std::vector<float>& times, const std::vector<float>& values, const char* type,
                   const char* path, const char* interpolation = "LINEAR") {
    Gltf gltf = make_triangle();
    const std::size_t input = gltf.add_accessor(times, "SCALAR");
    const std::size_t output = gltf.add_accessor(values, type);
    gltf.add_animation(0, path, input, output, interpolation);
    return gltf.import();
}

TEST(GltfAnimation, EveryPathAndInterpolation) {
    const Import step = import_keys({0, 1}, {1, 2, 3, 4, 5, 6}, "VEC3", "translation", "STEP");
    const Track& track = step->clips.at(0).tracks.at(0);
    EXPECT_EQ(track.path, TrackPath::translation);
    EXPECT_EQ(track.interpolation, Interpolation::step);
    EXPECT_EQ(track.components, 3u);
    EXPECT_EQ(track.target, 0u);
    EXPECT_EQ(track.times, (std::vector<float>{0, 1}));
    EXPECT_EQ(track.values, (std::vector<float>{1, 2, 3, 4, 5, 6}));

    const Import linear = import_keys({0.5f}, {1, 2, 3}, "VEC3", "scale");
    EXPECT_EQ(linear->clips.at(0).tracks.at(0).path, TrackPath::scale);
    EXPECT_EQ(linear->clips.at(0).tracks.at(0).interpolation, Interpolation::linear);

    const Import cubic = import_keys({0}, {9, 9, 9, 9, 0, 0, 0, 1, 8, 8, 8, 8}, "VEC4", "rotation", "CUBICSPLINE");
    EXPECT_EQ(cubic->clips.at(0).tracks.at(0).components, 4u);
    EXPECT_EQ(cubic->clips.at(0).tracks.at(0).interpolation, Interpolation::cubic);
    EXPECT_EQ(cubic->clips.at(0).tracks.at(0).values.size(), 12u);
}

TEST(GltfAnimation, OrderAndNumberStayEvenIfNothingMoves) {
    Gltf gltf = make_triangle();
    const std::size_t input = gltf.add_accessor<float>({0}, "SCALAR");
    const std::size_t output = gltf.add_accessor<float>({0, 0, 0}, "VEC3");
    gltf.add_animation(0, "pointer", input, output);
    gltf.json["animations"].push_back({{"name", "empty"}, {"samplers", Json::array()}, {"channels", Json::array()}});
    gltf.add_animation(0, "translation", input, output);
    gltf.json["animations"][2]["extras"] = {{"loop", true}};
    const Import import = gltf.import();
    ASSERT_EQ(import->clips.size(), 3u);
    EXPECT_TRUE(import->clips[0].tracks.empty());
    EXPECT_EQ(import->clips[1].name, "empty");
    EXPECT_EQ(import->clips[2].tracks.size(), 1u);
    EXPECT_EQ(import->clips[2].extras, R"({"loop":true})");
    EXPECT_EQ(import.warned("animates 'pointer' left out"), 1u);
}

/// One clip from 0 to 1 s with these extras.
Import import_extras(const Json& extras) {
    Gltf gltf = make_triangle();
    gltf.add_animation(0, "translation", gltf.add_accessor<float>({0, 1}, "SCALAR"),
                       gltf.add_accessor<float>({0, 0, 0, 1, 0, 0}, "VEC3"));
    gltf.json["animations"][0]["extras"] = extras;
    return gltf.import();
}

std::string markers_of(const Import& import) {
    std::string text;
    for (const Marker& marker : import->clips.at(0).markers)
        text += marker.name + '@' + std::to_string(marker.seconds) + ' ';
    return text;
}

TEST(GltfAnimation, MarkersStandInExtras) {
    const Import list = import_extras(
        {{"markers", {{{"time", 0.75}, {"name", "right"}}, {{"time", 0.25}, {"name", "left"}}}}, {"mine", 1}});
    EXPECT_EQ(markers_of(list), "left@0.250000 right@0.750000 ");
    EXPECT_EQ(list->clips[0].extras, R"({"mine":1})");
    const Import object = import_extras({{"markers", {{"step", {0.25, 1}}, {"hit", 0}}}});
    EXPECT_EQ(markers_of(object), "hit@0.000000 step@0.250000 step@1.000000 ");
    EXPECT_EQ(object->clips[0].extras, "");
    const Import text = import_extras({{"markers", R"([{"time": 0.5, "name": "in text"}])"}, {"loop", true}});
    EXPECT_EQ(markers_of(text), "in text@0.500000 ");
    EXPECT_TRUE(text->clips[0].loop);
}

TEST(GltfAnimation, MarkersThatAreWrongAreNamedAndLeftOut) {
    const Import import = import_extras(Json::parse(
        R"({"markers": [{"time": 2, "name": "late"}, {"time": 0.5, "name": "good"}, {"name": "when"}, 7, {"time": 1.0005, "name": "end"}]})"));
    EXPECT_EQ(markers_of(import), "good@0.500000 end@1.000000 ");
    EXPECT_EQ(import->clips[0].extras, "");
    const auto place_of = [&](const char* message) {
        for (const Warning& warning : import.report.warnings()) {
            if (warning.message.find(message) != std::string::npos) return warning.first_place;
        }
        return std::string("nothing");
    };
    EXPECT_EQ(place_of("2.0 s is outside the clip, which lasts from 0.0 s to 1.0 s"),
              "animations[0].extras.markers[0]");
    EXPECT_EQ(place_of("it is required and missing"), "animations[0].extras.markers[2].time");
    EXPECT_EQ(place_of("it must be an object, not 7"), "animations[0].extras.markers[3]");
}

TEST(GltfAnimation, OtherThingsNamedMarkersStayInExtras) {
    for (const char* extras : {R"({"markers":3})", R"({"markers":[1,2]})", R"({"markers":"no JSON"})"}) {
        const Import import = import_extras(Json::parse(extras));
        EXPECT_EQ(markers_of(import), "");
        EXPECT_EQ(import->clips[0].extras, extras);
        EXPECT_FALSE(import.report.warnings().empty());
    }
    const Import elsewhere = import_extras(Json::parse(R"({"a":{"markers":3}})"));
    EXPECT_TRUE(elsewhere.report.warnings().empty());
}

TEST(GltfAnimation, ChannelsWithoutANodeOfTheSceneAreCounted) {
    Gltf gltf = make_triangle();
    gltf.add_node(Json::object());
    gltf.json["scenes"] = {{{"nodes", {0}}}};
    const std::size_t input = gltf.add_accessor<float>({0}, "SCALAR");
    const std::size_t output = gltf.add_accessor<float>({0, 0, 0}, "VEC3");
    gltf.add_animation(1, "translation", input, output);
    gltf.add_animation(0, "translation", input, output);
    gltf.json["animations"][1]["channels"][0]["target"].erase("node");
    const Import import = gltf.import();
    EXPECT_EQ(import.warned("outside the chosen scene left out"), 1u + 1u);  // the node, and its channel
    EXPECT_EQ(import.warned("without a target node"), 1u);
    ASSERT_EQ(import->clips.size(), 2u);
    EXPECT_TRUE(import->clips[0].tracks.empty());
    EXPECT_TRUE(import->clips[1].tracks.empty());
}

TEST(GltfAnimation, ChannelsWithoutANodeDoNotMoveTheOthers) {
    Gltf gltf = make_triangle();
    const std::size_t input = gltf.add_accessor<float>({0}, "SCALAR");
    gltf.add_animation(0, "translation", input, gltf.add_accessor<float>({1, 1, 1}, "VEC3"));
    Json& animation = gltf.json["animations"][0];
    animation["samplers"].push_back({{"input", input}, {"output", gltf.add_accessor<float>({2, 2, 2}, "VEC3")}});
    const Json last = {{"sampler", 1}, {"target", {{"node", 0}, {"path", "scale"}}}};
    const Json without = {{"sampler", 0}, {"target", {{"path", "rotation"}}}};
    animation["channels"] = {without, animation["channels"][0], without, last};
    const Import import = gltf.import();
    EXPECT_EQ(import.warned("without a target node"), 2u);
    ASSERT_EQ(import->clips.at(0).tracks.size(), 2u);
    EXPECT_EQ(import->clips[0].tracks[0].path, TrackPath::translation);
    EXPECT_EQ(import->clips[0].tracks[0].values, (std::vector<float>{1, 1, 1}));
    EXPECT_EQ(import->clips[0].tracks[1].path, TrackPath::scale);
    EXPECT_EQ(import->clips[0].tracks[1].values, (std::vector<float>{2, 2, 2}));
}

TEST(GltfAnimation, OfTwoChannelsForOneTargetTheLastIsTaken) {
    Gltf gltf = make_triangle();
    const std::size_t input = gltf.add_accessor<float>({0}, "SCALAR");
    gltf.add_animation(0, "translation", input, gltf.add_accessor<float>({1, 1, 1}, "VEC3"));
    Json& animation = gltf.json["animations"][0];
    animation["samplers"].push_back({{"input", input}, {"output", gltf.add_accessor<float>({2, 2, 2}, "VEC3")}});
    animation["channels"].push_back({{"sampler", 1}, {"target", {{"node", 0}, {"path", "translation"}}}});
    const Import import = gltf.import();
    ASSERT_EQ(import->clips.at(0).tracks.size(), 1u);
    EXPECT_EQ(import->clips[0].tracks[0].values, (std::vector<float>{2, 2, 2}));
    EXPECT_EQ(import.warned("second channel"), 1u);
}

TEST(GltfAnimation, CountsMustAgree) {
    const Import import = import_keys({0, 1}, {0, 0, 0}, "VEC3", "translation");
    EXPECT_EQ(import.place(), "animations[0].samplers[0].output");
    EXPECT_EQ(import.message(), "accessors[2]: expected 2 keys of 3 numbers, found 3 numbers");
    EXPECT_FALSE(import_keys({0}, {0, 0, 0, 1}, "VEC4", "rotation", "CUBICSPLINE").result);
}

TEST(GltfAnimation, TimesMustIncrease) {
    const Import import = import_keys({0, 1, 0.5f}, std::vector<float>(9), "VEC3", "translation");
    EXPECT_EQ(import.place(), "animations[0].samplers[0].input");
    EXPECT_EQ(import.message(), "accessors[1], element 2: key times must increase, but 0.500000 follows 1.000000");
    EXPECT_NE(import_keys({0, std::nanf("")}, std::vector<float>(6), "VEC3", "translation").message().find("NaN"),
              std::string::npos);
}

TEST(GltfAnimation, KeysAtOneTimeAreAJump) {
    const Import import = import_keys({0, 1, 1, 1, 2}, {0, 0, 0, 1, 1, 1, 7, 7, 7, 5, 5, 5, 6, 6, 6}, "VEC3", "scale");
    const Track& track = import->clips.at(0).tracks.at(0);
    EXPECT_EQ(track.times, (std::vector<float>{0, std::nextafter(1.0f, 0.0f), 1, 2}));
    EXPECT_EQ(track.values, (std::vector<float>{0, 0, 0, 1, 1, 1, 5, 5, 5, 6, 6, 6}));
    EXPECT_EQ(import.warned("keys at the same time"), 2u);
}

TEST(GltfAnimation, RotationKeysAreNormalised) {
    const Import import = import_keys({0, 1}, {0, 0, 0, 2, 0.6f, 0, 0, 0.8f}, "VEC4", "rotation");
    EXPECT_EQ(import->clips.at(0).tracks.at(0).values, (std::vector<float>{0, 0, 0, 1, 0.6f, 0, 0, 0.8f}));
    EXPECT_EQ(import.warned("not a unit quaternion"), 1u);
}

TEST(GltfAnimation, ARotationKeyOfZerosIsLeftOut) {
    const Import one = import_keys({0, 1, 2}, {0, 0, 0, 1, 0, 0, 0, 0, 0.6f, 0, 0, 0.8f}, "VEC4", "rotation");
    const Track& track = one->clips.at(0).tracks.at(0);
    EXPECT_EQ(track.times, (std::vector<float>{0, 2}));
    EXPECT_EQ(track.values, (std::vector<float>{0, 0, 0, 1, 0.6f, 0, 0, 0.8f}));
    EXPECT_EQ(one.warned("rotation key is (0, 0, 0, 0), left out"), 1u);
    const Import all = import_keys({0, 1}, std::vector<float>(8), "VEC4", "rotation");
    EXPECT_TRUE(all->clips.at(0).tracks.empty());
    EXPECT_EQ(all.warned("rotation key is (0, 0, 0, 0), left out"), 2u);
    std::vector<float> spline(24, 0.5f);
    std::fill_n(spline.begin() + 4, 4, 0.0f);  // the first key's value
    const Import cubic = import_keys({0, 1}, spline, "VEC4", "rotation", "CUBICSPLINE");
    EXPECT_EQ(cubic->clips.at(0).tracks.at(0).times, (std::vector<float>{1}));
    EXPECT_EQ(cubic->clips[0].tracks[0].values, std::vector<float>(12, 0.5f));
}

TEST(GltfAnimation, NormalisedIntegersAreRotationsToo) {
    Gltf gltf = make_triangle();
    const std::size_t input = gltf.add_accessor<float>({0}, "SCALAR");
    gltf.add_animation(0, "rotation", input, gltf.add_accessor<std::int16_t>({0, 0, 0, -32768}, "VEC4", true));
    EXPECT_EQ(gltf.import()->clips.at(0).tracks.at(0).values, (std::vector<float>{0, 0, 0, -1}));
}

TEST(GltfAnimation, WeightsMoveEveryMeshOfTheNode) {
    Gltf gltf = make_triangle();
    gltf.primitive()["targets"] = {{{"POSITION", 0}}, {{"POSITION", 0}}};
    gltf.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", gltf.add_positions(3)}}}});
    const std::size_t input = gltf.add_accessor<float>({0, 1}, "SCALAR");
    gltf.add_animation(0, "weights", input, gltf.add_accessor<float>({0, 1, 2, 3}, "SCALAR"));
    const Import import = gltf.import();
    ASSERT_EQ(import->meshes.size(), 2u);
    const auto& tracks = import->clips.at(0).tracks;
    ASSERT_EQ(tracks.size(), 2u);
    EXPECT_EQ(tracks[0].target, 0u);
    EXPECT_EQ(tracks[1].target, 1u);
    EXPECT_EQ(tracks[1].components, 2u);
    EXPECT_EQ(tracks[1].values, (std::vector<float>{0, 1, 2, 3}));
}

TEST(GltfAnimation, WeightsWithoutMorphTargetsAreLeftOut) {
    const Import import = import_keys({0}, {1}, "SCALAR", "weights");
    EXPECT_TRUE(import->clips.at(0).tracks.empty());
    EXPECT_EQ(import.warned("without morph targets"), 1u);
}

TEST(GltfAnimation, SharedSamplersCannotGrowWithoutBound) {
    Gltf gltf;
    const std::size_t input = gltf.add_accessor(
        [] {
            std::vector<float> times(50'000);
            for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<float>(i);
            return times;
        }(),
        "SCALAR");
    const std::size_t output = gltf.add_accessor(std::vector<float>(150'000), "VEC3");
    gltf.add_node(Json::object());
    gltf.add_animation(0, "translation", input, output);
    Json& channels = gltf.json["animations"][0]["channels"];
    for (int i = 1; i < 20'000; ++i) channels.push_back(channels[0]);
    EXPECT_EQ(gltf.import().message(), "the decoded data would be implausibly large");
}

}  // namespace
}  // namespace bendy::converter::animation_test
