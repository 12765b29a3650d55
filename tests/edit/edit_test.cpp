#include <bendy/edit/clips.h>
#include <bendy/edit/edit.h>

#include "format/edit_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace bendy::edit::edit_test {
namespace {

using test::at;
using test::child;
using test::Loaded;
using test::Node;
using Buffer = test::Buffer;

Buffer stripped(const Buffer& file, Part part, const std::string& name = {}) {
    Log log;
    auto edited = strip(file, {part, name}, log);
    EXPECT_TRUE(edited) << edited.error().message;
    return edited ? *std::move(edited) : Buffer();
}

std::uint32_t texture_of(const Node& root, std::size_t place) {
    SurfaceRecord surface;
    copy_at(at(const_cast<Node&>(root), "HEAD/MATE/SURF").payload, 0, surface);
    return place == 0 ? surface.base_colour_texture.texture : surface.emissive_texture.texture;
}

TEST(Strip, AnImageThatIsSharedMovesToATextureThatStays) {
    const Node root = test::to_node(stripped(test::sample_file(), Part::textures, "#1"));
    Node file = root;
    EXPECT_EQ(at(file, "HEAD/TEXT[1]/IMAG").payload,
              at(*std::make_unique<Node>(test::sample()), "HEAD/TEXT[1]/IMAG").payload);
    EXPECT_THROW(at(file, "HEAD/TEXT[2]"), std::out_of_range);
    EXPECT_EQ(texture_of(root, 0), 1u);  // was 2
    EXPECT_EQ(texture_of(root, 1), 0u);
}

TEST(Strip, TheSecondOfTwoThatSharedSharesWithTheFirst) {
    Node root = test::sample();
    Node copy = at(root, "HEAD/TEXT[2]");
    root.children.insert(root.children.begin() + 4, copy);  // TEXT 3, the same image
    test::edit<VersionRecord>(at(root, "HEAD/VERS"), [](VersionRecord& version) { version.textures = 4; });
    Node file = test::to_node(stripped(test::to_file(root), Part::textures, "#1"));
    EXPECT_NO_THROW(at(file, "HEAD/TEXT[1]/IMAG"));
    SameRecord same;
    copy_at(at(file, "HEAD/TEXT[2]/SAME").payload, 0, same);
    EXPECT_EQ(same.texture, 1u);
    EXPECT_EQ(same.image, 0u);
}

TEST(Strip, TextureNumbersInExtensionsAreMended) {
    const auto after = [](std::string_view json, const std::string& name) {
        Node root = test::sample();
        Node& leaf = at(root, "HEAD/MATE/EXTN");
        leaf.payload.assign(as_byte_span(json).begin(), as_byte_span(json).end());
        Node file = test::to_node(stripped(test::to_file(root), Part::textures, name));
        return std::string(as_text(at(file, "HEAD/MATE/EXTN").payload));
    };
    EXPECT_EQ(after(R"({"X":{"f":1,"aTexture":{"index":2, "scale":2},"g":{"index":1}}})", "skin"),
              R"({"X":{"aTexture":{"index":1,"scale":2},"f":1,"g":{"index":1}}})");
    EXPECT_EQ(after(R"({"X":{"aTexture":{"index":0},"f":1}})", "skin"), R"({"X":{"f":1}})");
    EXPECT_EQ(after(R"({"X":{"f":1, "aTexture":{"index":0}}})", "skin"), R"({"X":{"f":1}})");
    EXPECT_EQ(after(R"({"X":{"aTexture":{"index":0},"bTexture":{"index":0}}})", ""), R"({"X":{}})");
    EXPECT_EQ(after(R"({"X": {"aTexture": {"index":0}}})", "#2"), R"({"X": {"aTexture": {"index":0}}})");  // unchanged
    EXPECT_EQ(after(R"({"X":{"aTexture":{"index":0)", ""), R"({"X":{"aTexture":{"index":0)");              // not JSON
}

TEST(Strip, LocalMaterialsGoWithTheOthers) {
    Node file = test::to_node(stripped(test::sample_file(), Part::materials));
    EXPECT_THROW(at(file, "HEAD/OBJE/SKIN/MATE"), std::out_of_range);
    SubmeshRecord record;
    copy_at(at(file, "HEAD/OBJE/SKIN/POLY").payload, 0, record);
    EXPECT_EQ(record.material, kNone);
}

TEST(Strip, ChainsAreNumberedAnew) {
    Node file = test::to_node(stripped(test::sample_file(), Part::chains, "back"));
    ChainWeightRecord chain_weight;
    copy_at(at(file, "HEAD/OBJE/SKIN/SKIN[1]/PIVO/PULL").payload, 0, chain_weight);
    EXPECT_EQ(chain_weight.chain, 0u);  // was 1
    EXPECT_THROW(at(file, "HEAD/OBJE/SKIN/PIVO/PULL"), std::out_of_range);
}

TEST(Strip, AMeshTakesItsTracksAndLevelsAlong) {
    Node file = test::to_node(stripped(test::sample_file(), Part::meshes, "fur"));
    EXPECT_THROW(at(file, "HEAD/OBJE/LODD"), std::out_of_range);
    const Loaded loaded(file);
    const ObjectView& object = loaded.document.objects.front();
    ASSERT_EQ(object.meshes.size(), 1u);
    EXPECT_EQ(object.clips.front().tracks.size(), 4u);  // of 5: not the weights
    for (const SubmeshView& submesh : object.skeleton.submeshes) EXPECT_EQ(submesh.mesh, 0u);
}

TEST(Strip, TracksThatStayKeepTheirKeys) {
    const Loaded before(test::sample_file());
    const Loaded after(stripped(test::sample_file(), Part::targets));
    const auto& tracks = before.document.objects.front().clips.front().tracks;
    std::size_t next = 0;
    for (const TrackView& track : after.document.objects.front().clips.front().tracks) {
        while (tracks[next].path == TrackPath::weights) ++next;
        EXPECT_TRUE(std::equal(track.times.begin(), track.times.end(), tracks[next].times.begin()));
        EXPECT_TRUE(std::equal(track.values.begin(), track.values.end(), tracks[next].values.begin()));
        EXPECT_EQ(track.target, tracks[next].target);
        ++next;
    }
    EXPECT_EQ(next, 5u);
}

/// The sample with a curve of each of these textures in its clip.
Buffer with_texture_curves(const std::vector<std::uint32_t>& textures) {
    Node root = test::sample();
    constexpr std::array kTimes{0.5f, 1.0f};
    constexpr std::array kValues{0.0f, 1.0f};
    for (const std::uint32_t texture : textures) {
        const std::string name = "curve " + std::to_string(texture);
        CurveView curve;
        curve.name = name;
        curve.path = "offset";
        curve.kind = CurveTarget::texture;
        curve.target = texture;
        curve.keys = 2;
        curve.times = kTimes;
        curve.values = kValues;
        at(root, "HEAD/OBJE/CYCL").children.push_back(test::make_leaf(FourCC("CURV"), write_curve(curve)));
    }
    return test::to_file(root);
}

TEST(Strip, CurvesAreRenumberedOrGoWithTheirTargets) {
    Log log;
    const auto edited = strip(with_texture_curves({0, 1, 2}), {Part::textures, "#1"}, log);
    ASSERT_TRUE(edited) << edited.error().message;
    const Loaded loaded(*edited);
    const auto& curves = loaded.document.objects.front().clips.front().curves;
    ASSERT_EQ(curves.size(), 2u);
    EXPECT_EQ(curves[0].name, "curve 0");
    EXPECT_EQ(curves[0].target, 0u);
    EXPECT_EQ(curves[1].name, "curve 2");
    EXPECT_EQ(curves[1].target, 1u);
    ASSERT_EQ(log.warnings.size(), 1u);
    EXPECT_TRUE(log.warnings[0].starts_with("CURV \"curve 1\" is removed with its texture, ")) << log.warnings[0];
}

TEST(Strip, AClipWithoutTracksStaysForItsCurves) {
    Node root = test::to_node(with_texture_curves({0}));
    Node& clip = at(root, "HEAD/OBJE/CYCL");
    std::erase_if(clip.children, [](const Node& leaf) {
        return leaf.id == FourCC("TRAK") || leaf.id == FourCC("TIME") || leaf.id == FourCC("KEYV");
    });
    test::edit<ClipRecord>(at(root, "HEAD/OBJE/CYCL/CINF"), [](ClipRecord& info) { info.frame_rate = 0.0f; });
    const Loaded loaded(stripped(test::to_file(root), Part::meshes));
    EXPECT_EQ(loaded.document.objects.front().clips.front().curves.size(), 1u);
}

TEST(MergeClips, TakesCurvesAlong) {
    Log log;
    const auto merged = add_clips(test::sample_file(), with_texture_curves({0, 1}), SameName::number, log);
    ASSERT_TRUE(merged) << merged.error().message;
    const Loaded loaded(*merged);
    const auto& clips = loaded.document.objects.front().clips;
    ASSERT_EQ(clips.size(), 2u);
    EXPECT_TRUE(clips[0].curves.empty());
    ASSERT_EQ(clips[1].curves.size(), 1u);  // the other texture has no name, so nobody knows which it is here
    EXPECT_EQ(clips[1].curves[0].name, "curve 0");
    EXPECT_EQ(loaded.document.textures.at(clips[1].curves[0].target).name, "skin");
    EXPECT_NE(std::find(log.warnings.begin(), log.warnings.end(),
                        "CURV \"curve 1\" is left out: there is no texture of that name here"),
              log.warnings.end());
}

/// The sample with these lights in HEAD, and curves to them.
Buffer with_light_curves(const std::string& lights, const std::vector<std::string>& paths) {
    Node root = test::sample();
    const std::string json = R"({"KHR_lights_punctual":{"lights":[)" + lights + "]}}";
    std::erase_if(root.children, [](const Node& leaf) { return leaf.id == FourCC("EXTN"); });
    root.children.push_back(test::make_leaf(FourCC("EXTN"), std::as_bytes(std::span(json))));
    static constexpr std::array kTimes{0.5f};
    static constexpr std::array kValues{1.0f};
    for (const std::string& path : paths) {
        CurveView curve;
        curve.path = path;
        curve.keys = 1;
        curve.times = kTimes;
        curve.values = kValues;
        at(root, "HEAD/OBJE/CYCL").children.push_back(test::make_leaf(FourCC("CURV"), write_curve(curve)));
    }
    return test::to_file(root);
}

TEST(MergeClips, PointsAtTheLightsOfTheSameNames) {
    const std::string lights = "/extensions/KHR_lights_punctual/lights/";
    const auto merged = [&](const std::string& here, const std::string& there, const std::string& path, Log& log) {
        const auto file =
            add_clips(with_light_curves(here, {}), with_light_curves(there, {path}), SameName::number, log);
        EXPECT_TRUE(file) << file.error().message;
        const Loaded loaded(file ? *file : Buffer());
        const auto& curves = loaded.document.objects.front().clips.back().curves;
        return curves.empty() ? std::string() : std::string(curves.front().path);
    };
    Log log;
    EXPECT_EQ(merged(R"({"name":"sun"},{"name":"lamp"})", R"({"name":"lamp"},{"name":"sun"})", lights + "0/color", log),
              lights + "1/color");
    EXPECT_EQ(merged("{},{}", "{},{}", lights + "1/color", log), lights + "1/color");
    EXPECT_EQ(merged("{},{}", "{},{}", "/extras/lights/1", log), "/extras/lights/1");
    for (const std::string& warning : log.warnings) EXPECT_EQ(warning.find("CURV"), std::string::npos) << warning;
    for (const char* here : {R"({"name":"sun"},{"name":"moon"})", "{},{}", "{}"}) {
        log.warnings.clear();
        EXPECT_EQ(merged(here, R"({"name":"lamp"},{"name":"sun"})", lights + "0/color", log), "") << here;
        EXPECT_EQ(log.warnings.at(0),
                  "CURV \"\" is left out: it is not clear what " + lights + "0/color is in this file");
    }
}

/// The sample with markers in its clip.
Buffer marked() {
    Node root = test::sample();
    at(root, "HEAD/OBJE/CYCL")
        .children.push_back(test::make_leaf(FourCC("MARK"), test::markers_payload({{0.5f, 4}, {1.0f, 7}}, "stephit")));
    return test::to_file(root);
}

std::string markers_of(const Loaded& loaded, std::size_t clip) {
    std::string text;
    for (const Marker& marker : loaded.document.objects.front().clips.at(clip).markers)
        text += std::string(marker.name) + '@' + std::to_string(marker.seconds) + ' ';
    return text;
}

TEST(Markers, StayWithTheirClip) {
    const std::string all = "step@0.500000 hit@1.000000 ";
    ASSERT_EQ(markers_of(Loaded(marked()), 0), all);
    EXPECT_EQ(markers_of(Loaded(stripped(marked(), Part::meshes)), 0), all);
    EXPECT_TRUE(Loaded(stripped(marked(), Part::clips)).document.objects.front().clips.empty());
    Log log;
    const Edited part = extract(marked(), "spine", log);
    ASSERT_TRUE(part) << part.error().message;
    EXPECT_EQ(markers_of(Loaded(*part), 0), all);
    const Edited merged = add_clips(test::sample_file(), marked(), SameName::number, log);
    ASSERT_TRUE(merged) << merged.error().message;
    EXPECT_EQ(markers_of(Loaded(*merged), 0), "");
    EXPECT_EQ(markers_of(Loaded(*merged), 1), all);
}

TEST(Markers, AreStrippedAlone) {
    EXPECT_EQ(stripped(marked(), Part::markers), stripped(test::sample_file(), Part::unknown));
}

TEST(Roles, GoWithTheirJoints) {
    Node root = test::sample();
    const std::vector<RoleRecord> roles{{0, static_cast<std::uint16_t>(Role::hips), 0},
                                        {1, static_cast<std::uint16_t>(Role::spine), 0},
                                        {3, static_cast<std::uint16_t>(Role::tail), 2}};
    at(root, "HEAD/OBJE").children.push_back(test::make_leaf(FourCC("ROLE"), test::bytes_of_all(roles)));
    Log log;
    const Edited part = extract(test::to_file(root), "tail*", log);  // joint 3; joint 0 is above it
    ASSERT_TRUE(part) << part.error().message;
    const Loaded loaded(*part);
    const std::span<const RoleRecord> kept = loaded.document.objects.front().roles;
    ASSERT_EQ(kept.size(), 2u);
    EXPECT_EQ(kept[0].joint, 0u);
    EXPECT_EQ(kept[1].joint, 1u);
    EXPECT_EQ(static_cast<Role>(kept[1].role), Role::tail);
    EXPECT_EQ(kept[1].place, 2u);
}

/// "3 tail 2" for each role of the file.
std::vector<std::string> roles_of(const Buffer& file) {
    std::vector<std::string> lines;
    const Loaded loaded(file);
    for (const RoleRecord& record : loaded.document.objects.front().roles) {
        lines.push_back(std::to_string(record.joint) + ' ' + std::string(kValueNames<Role>.at(record.role)) + ' ' +
                        std::to_string(record.place));
    }
    return lines;
}

Buffer with_role(const Buffer& file, const std::string& text) {
    const auto what = parse_role(text);
    EXPECT_TRUE(what) << what.error().message;
    Log log;
    Edited edited = set_role(file, *what, log);
    EXPECT_TRUE(edited) << edited.error().message;
    return edited ? *std::move(edited) : Buffer();
}

TEST(Roles, AreSetAndTakenAway) {
    using Roles = std::vector<std::string>;
    const Buffer bare = test::sample_file();
    Buffer file = with_role(bare, "tail:2=tail*");
    EXPECT_EQ(roles_of(file), Roles{"3 tail 2"});
    file = with_role(with_role(file, "head=spine"), "hips=hip");
    EXPECT_EQ(roles_of(file), (Roles{"0 hips 0", "1 head 0", "3 tail 2"}));
    EXPECT_EQ(roles_of(with_role(file, "head=#2")), (Roles{"0 hips 0", "2 head 0", "3 tail 2"}));
    EXPECT_EQ(roles_of(with_role(file, "jaw=spine")), (Roles{"0 hips 0", "1 jaw 0", "3 tail 2"}));
    EXPECT_EQ(with_role(file, "head=spine"), file);
    EXPECT_EQ(with_role(file, "jaw="), file);
    EXPECT_EQ(with_role(with_role(with_role(file, "head="), "hips="), "tail:2="), bare);
    EXPECT_EQ(stripped(file, Part::roles), bare);
}

TEST(Roles, SayWhatIsWrong) {
    const auto wrong = [](std::string_view text) {
        const auto what = parse_role(text);
        return what ? std::string() : what.error().message;
    };
    EXPECT_EQ(wrong("hips"), "\"hips\" is not ROLE=JOINT");
    EXPECT_EQ(wrong("left_foott=a"), "there is no role \"left_foott\"; did you mean \"left_foot\"?");
    EXPECT_EQ(wrong("none=a"), "there is no role \"none\"");
    EXPECT_EQ(wrong("tail:x=a"), "\"x\" is not a place in a chain, 0 to 65535");
    EXPECT_EQ(wrong("tail:65536=a"), "\"65536\" is not a place in a chain, 0 to 65535");
    EXPECT_EQ(wrong("hips:1=a"), "\"hips\" is one joint and has no places");
    Log log;
    EXPECT_FALSE(set_role(test::sample_file(), {Role::hips, 0, "nobody"}, log));
    EXPECT_FALSE(set_role(test::sample_file(), {Role::hips, 0, "*"}, log));
}

/// The bytes with a material changed as by --set.
Edited with_set(const Buffer& file, std::string_view text) {
    const auto what = parse_set(text);
    if (!what) return what.error();
    Log log;
    return set_material(file, *what, log);
}

SurfaceRecord surface_of(const Buffer& file, std::size_t material = 0) {
    const Loaded loaded(file);
    return loaded.document.materials.at(material).surface;
}

TEST(SetMaterial, ChangesOneField) {
    const Buffer file = test::sample_file();
    const std::string name(Loaded(file).document.materials.at(0).name);
    SurfaceRecord surface = surface_of(file);
    const auto set = [&](const std::string& field) {
        const Edited edited = with_set(file, "material:" + name + '.' + field);
        EXPECT_TRUE(edited) << edited.error().message;
        return surface_of(*edited);
    };
    const auto expect_only = [&](const SurfaceRecord& found, const SurfaceRecord& wanted) {
        EXPECT_EQ(std::memcmp(&found, &wanted, sizeof wanted), 0);
    };
    SurfaceRecord wanted = surface;
    wanted.roughness = 0.4f;
    expect_only(set("roughness=0.4"), wanted);
    wanted = surface;
    wanted.base_colour = {1.0f, 0.5f, 0.0f, 0.25f};
    expect_only(set("base_colour=1,0.5,0,0.25"), wanted);
    wanted = surface;
    wanted.alpha_mode = static_cast<std::uint8_t>(AlphaMode::blend);
    wanted.double_sided = surface.double_sided;
    expect_only(set("alpha_mode=blend"), wanted);
    wanted = surface;
    wanted.normal_texture.rotation = -1.5f;
    expect_only(set("normal_texture.rotation=-1.5"), wanted);
    wanted = surface;
    wanted.base_colour_texture.texture = kNone;
    expect_only(set("base_colour_texture.texture=none"), wanted);
    wanted.base_colour_texture.texture = 1;
    expect_only(set("base_colour_texture.texture=#1"), wanted);
}

TEST(SetMaterial, NamesMayHaveDotsAndSignsOfEquality) {
    const auto what = parse_set("material:a=b.roughness.001.base_colour_texture.scale=2,3");
    ASSERT_TRUE(what) << what.error().message;
    EXPECT_EQ(what->material, "a=b.roughness.001");
    EXPECT_EQ(what->field, "base_colour_texture.scale");
    EXPECT_EQ(what->value, "2,3");
    EXPECT_EQ(parse_set("material:Wood.base_colour_texture.texture=a.roughness=1")->value, "a.roughness=1");
}

TEST(SetMaterial, SaysWhatIsWrong) {
    const auto wrong = [](std::string_view text) {
        const Edited edited = with_set(test::sample_file(), text);
        return edited ? std::string() : edited.error().message;
    };
    EXPECT_EQ(wrong("Wood.roughness=1"), "\"Wood.roughness=1\" is not material:NAME.FIELD=VALUE");
    EXPECT_EQ(wrong("material:Wood.roughness"), "\"material:Wood.roughness\" is not material:NAME.FIELD=VALUE");
    EXPECT_EQ(wrong("material:#0.rough=1"),
              "\"material:#0.rough=1\" names no field of a material, as in material:Wood.roughness=0.4; these are "
              "base_colour, emissive, metallic, roughness, normal_scale, occlusion_strength, alpha_cutoff, alpha_mode, "
              "double_sided, unlit; of base_colour_texture, metallic_roughness_texture, normal_texture, "
              "occlusion_texture, emissive_texture: texture, coords, offset, scale, rotation");
    EXPECT_EQ(wrong("material:#0.roughness=1.5"), "roughness takes a number, from 0 to 1, not \"1.5\"");
    EXPECT_EQ(wrong("material:#0.roughness=x"), "roughness takes a number, from 0 to 1, not \"x\"");
    EXPECT_EQ(wrong("material:#0.roughness=nan"), "roughness takes a number, from 0 to 1, not \"nan\"");
    EXPECT_EQ(wrong("material:#0.normal_scale=1e300"), "normal_scale takes a number, not \"1e300\"");
    EXPECT_EQ(wrong("material:#0.emissive=1,2"), "emissive takes 3 numbers with commas, 0 or more, not \"1,2\"");
    EXPECT_EQ(wrong("material:#0.emissive=1,2,3,4"),
              "emissive takes 3 numbers with commas, 0 or more, not \"1,2,3,4\"");
    EXPECT_EQ(wrong("material:#0.unlit=2"), "unlit takes a number, 0 or 1, not \"2\"");
    EXPECT_EQ(wrong("material:#0.alpha_mode=glass"), "alpha_mode is one word of \"opaque mask blend\", not \"glass\"");
    EXPECT_NE(wrong("material:#0.normal_texture.texture=Bark").find("there is no texture \"Bark\""), std::string::npos);
    EXPECT_NE(wrong("material:Nothing.roughness=1").find("there is no material \"Nothing\""), std::string::npos);
    Log log;
    EXPECT_FALSE(set_material(test::sample_file(), {"#0", "reserved", "0"}, log));
}

TEST(StandingPose, GoesWithItsJoints) {
    const std::vector<StandingRotationRecord> rotations{
        {0, {0.1f, 0.0f, 0.0f}}, {1, {0.2f, 0.0f, 0.0f}}, {3, {0.3f, 0.0f, 0.0f}}};
    const Edited set = set_standing_pose(test::sample_file(), {}, rotations);
    ASSERT_TRUE(set) << set.error().message;
    Log log;
    const Edited part = extract(*set, "tail*", log);  // joint 3; joint 0 is above it
    ASSERT_TRUE(part) << part.error().message;
    const Loaded loaded(*part);
    const auto& kept = loaded.document.objects.front().standing_pose;
    ASSERT_TRUE(kept.has_value());
    ASSERT_EQ(kept->rotations.size(), 2u);
    EXPECT_EQ(kept->rotations[1].joint, 1u);
    EXPECT_EQ(kept->rotations[1].rotation[0], 0.3f);
    EXPECT_EQ(stripped(*set, Part::standing_pose), stripped(test::sample_file(), Part::unknown));
}

TEST(Names, Matches) {
    EXPECT_TRUE(matches("a*c", "abbc"));
    EXPECT_TRUE(matches("*", ""));
    EXPECT_TRUE(matches("a?c*", "abc"));
    EXPECT_FALSE(matches("a?c", "ac"));
    EXPECT_FALSE(matches("a*b", "abc"));
    EXPECT_TRUE(matches("*a*b", "xxaxab"));
}

TEST(Names, Nearest) {
    const std::array<std::string_view, 4> names{"Walk", "mixamorig:Hips", "LeftArm", ""};
    EXPECT_EQ(nearest_name(names, "walk"), "Walk");
    EXPECT_EQ(nearest_name(names, "Wlak"), "Walk");
    EXPECT_EQ(nearest_name(names, "Hips"), "mixamorig:Hips");
    EXPECT_EQ(nearest_name(names, "LeftArms"), "LeftArm");
    EXPECT_EQ(nearest_name(names, "zzz"), "");
    EXPECT_EQ(nearest_name(names, std::string(1000, 'a')), "");
}

/// Every operation on a file that may hold anything: what they give must be valid, whatever it is.
void edit_in_every_way(const Buffer& file, const Buffer& good) {
    const auto look = [](const Edited& edited) {
        if (edited) {
            EXPECT_TRUE(validate(*edited).empty());
        } else {
            EXPECT_EQ(edited.error().message.find("would not be valid"), std::string::npos) << edited.error().message;
        }
    };
    Log log;
    for (int part = 0; part <= static_cast<int>(Part::unknown); ++part)
        look(strip(file, {static_cast<Part>(part), {}}, log));
    look(strip(file, {Part::textures, "#0"}, log));
    look(strip(file, {Part::targets, "#0"}, log));
    look(strip(file, {Part::meshes, "#0"}, log));
    look(set_role(file, {Role::tail, 1, "#1"}, log));
    look(rename(file, {Named::joint, {{"*", "x*"}}}, log));
    look(extract(file, "#1", log));
    for (const auto& [word, text] :
         {std::pair("keep-clip", "#0"), std::pair("copy-clip", "#0=copy"), std::pair("trim", "*=0.6..0.9"),
          std::pair("resample", "*@30"), std::pair("mirror", "*"), std::pair("loop", "*=0.2"),
          std::pair("root-motion", "*=#0.."), std::pair("root-motion", "*=#2..#0")}) {
        const std::string said = text;
        const auto change = parse_clip_change(word, std::span(&said, 1));
        ASSERT_TRUE(change) << change.error().message;
        look(change_clips(file, *change, log));
    }
    look(limit_influences(file, 1, log));
    look(add_clips(file, good, SameName::number, log));
    look(add_clips(good, file, SameName::number, log));
}

TEST(Hostile, FilesWithOneByteWrongAndRightSums) {
    const Buffer good = test::sample_file();
    for (std::size_t at = 16; at < good.size(); at += 3) {
        Buffer file = good;
        file[at] ^= std::byte{static_cast<unsigned char>(1u << (at % 8))};
        if (!test::resum(file)) continue;
        edit_in_every_way(file, good);
    }
}

TEST(Hostile, CutFiles) {
    const Buffer good = test::sample_file();
    Log log;
    for (std::size_t size = 0; size < good.size(); size += 7) {
        const Buffer file(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_FALSE(strip(file, {Part::lod, {}}, log));
    }
}

TEST(Hostile, ARopeOfManyJoints) {
    const Buffer file = test::rope_file(20'000);
    Log log;
    const auto part = extract(file, "#15000", log);
    ASSERT_TRUE(part) << part.error().message;
    EXPECT_EQ(Loaded(*part).document.objects.front().skeleton.joints.size(), 20'000u);  // 15,000 of them above it
    const auto upper = extract(*part, "#0", log);
    ASSERT_TRUE(upper);
    EXPECT_EQ(*upper, file);
}

}  // namespace
}  // namespace bendy::edit::edit_test
