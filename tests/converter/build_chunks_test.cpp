#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>
#include <bendy/runtime.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <initializer_list>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter::build_chunks_test {
namespace {

using Buffer = std::vector<std::byte>;

std::vector<std::byte> bytes_from(std::string_view text) {
    const Bytes bytes = as_byte_span(text);
    return {bytes.begin(), bytes.end()};
}

/// The file of a scene, found good, and opened.
struct Built {
    explicit Built(const Scene& scene, std::string_view generator = "test 1.0")
        : bytes(build_chunks(scene, generator, report)), model(open(bytes)), tree(*read_chunk_tree(bytes)) {
        Faults faults;
        document = read_document(tree, faults);
    }
    Built(const Built&) = delete;
    Built& operator=(const Built&) = delete;

    static Model open(Bytes bytes) {
        const Faults faults = validate(bytes);
        for (const Error& fault : faults.list()) ADD_FAILURE() << describe_with_place(fault, bytes);
        Result<Model> opened = Model::from_memory(bytes);
        if (!opened) throw std::runtime_error(describe_with_place(opened.error(), bytes));
        return *std::move(opened);
    }

    /// The ids of a chunk's direct children, one after another.
    [[nodiscard]] std::string ids(std::string_view path) const {
        std::string text;
        for (const std::uint32_t child : tree.children(find_path(tree, path))) {
            text += (text.empty() ? "" : " ") + std::string(tree[child].id.letters().data());
        }
        return text;
    }

    Report report;
    Buffer bytes;
    Model model;
    ChunkTree tree;
    Document document;
};

Track make_track(TrackPath path, Interpolation interpolation, std::uint32_t target, std::uint32_t components,
                 std::vector<float> times, std::vector<float> values) {
    return {path, interpolation, target, components, std::move(times), std::move(values)};
}

std::vector<Joint> make_joints() {
    std::vector<Joint> joints(5);
    joints[0].name = "root";
    joints[0].rest.translation = {0.0f, 1.0f, -2.5f};
    joints[0].extras = R"({"mass":12})";
    joints[1].name = "arm";
    joints[1].parent = 0;
    joints[1].rest.rotation = {0.5f, -0.5f, 0.5f, -0.5f};
    joints[2].name = "手";
    joints[2].parent = 1;
    joints[2].rest.scale = {-1.0f, 0.0f, 3.0f};
    joints[3].name = "arm";
    joints[3].parent = 0;
    joints[3].rest.shear = {0.25f, -0.5f, 0.75f};
    joints[4].name = "";  // a second root
    return joints;
}

Mesh make_body() {
    Mesh mesh;
    mesh.name = "body";
    mesh.joint = 3;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1.0f / 3.0f, 1e-20f, -7.0f}};
    mesh.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0.6f, 0.8f, 0}};
    mesh.tangents = {{1, 0, 0, 1}, {1, 0, 0, -1}, {0, 1, 0, 1}, {0, 0, 1, -1}};
    mesh.texture_coords = {{"", 0, 2, {0, 0, 1, 0, 0, 1, 1, 1}}, {"", 2, 2, {-0.5f, 0.1f, 2, 3, 0.3f, 0.7f, 0, -0.0f}}};
    mesh.colours = {{"", 0, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0.2f, 0.4f, 0.6f}},
                    {"", 1, 4, {0.1f, 0.2f, 0.3f, 0.4f, 0, 0, 0, 0, 1, 1, 1, 1, 0.5f, 0.5f, 0.5f, 0.5f}}};
    mesh.attributes = {{"_HEAT", 0, 1, {-40.5f, 0, 1e10f, 3}}, {"_FLOW", 0, 2, {1, 2, 3, 4, 5, 6, 7, 8}}};
    mesh.influences = 2;
    mesh.palette.joints = {2, 1};
    mesh.palette.inverse_bind = {glm::mat4(2.0f), glm::mat4(1.0f)};
    mesh.palette.inverse_bind[1][3] = {0.1f, -0.2f, 0.3f, 1.0f};
    mesh.bones = {0, 1, 1, 0, 0, 1, 1, 1};
    mesh.weights = {1, 0, 0.75f, 0.25f, 0.1f, 0.9f, 1, 0};
    mesh.targets.resize(2);
    mesh.targets[0].name = "smile";
    mesh.targets[0].rest_weight = 0.375f;
    mesh.targets[0].positions = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {4, 4, 4}};
    mesh.targets[0].normals = {{0.1f, 0, 0}, {0, 0, 0}, {0, 0.1f, 0}, {0, 0, 0.1f}};
    mesh.targets[1].name = "";
    mesh.targets[1].tangents = {{1, 2, 3}, {0, 0, 0}, {0, 0, 0}, {4, 5, 6}};
    mesh.submeshes = {{Topology::triangles, 1, {0, 1, 2}}, {Topology::triangles, 0, {2, 1, 3}}};
    mesh.extras = R"({"lod":0})";
    return mesh;
}

Mesh make_hat() {
    Mesh mesh;
    mesh.name = "hat";
    mesh.joint = 4;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.submeshes = {
        {Topology::points, kNone, {2, 0}}, {Topology::lines, kNone, {0, 1}}, {Topology::triangles, kNone, {0, 1, 2}}};
    return mesh;
}

std::vector<Clip> make_clips() {
    std::vector<Clip> clips(3);
    clips[0].name = "wave";
    clips[0].loop = true;
    clips[0].extras = R"({"loop":true})";
    clips[0].tracks = {
        make_track(TrackPath::translation, Interpolation::linear, 1, 3, {0.5f, 1.5f}, {1, 2, 3, 4, 5, 6}),
        make_track(TrackPath::rotation, Interpolation::cubic, 1, 4, {0.25f}, {1, 1, 1, 1, 0, 0, 1, 0, 2, 2, 2, 2}),
        make_track(TrackPath::scale, Interpolation::step, 2, 3, {0.5f, 1.5f}, {1, 2, 3, 4, 5, 6}),
        make_track(TrackPath::weights, Interpolation::linear, 0, 2, {0.5f, 1.75f}, {0, 1, 0.5f, -0.25f}),
    };
    clips[1].name = "";
    clips[2].name = "wave";
    clips[2].tracks = {make_track(TrackPath::translation, Interpolation::linear, 4, 3, {3}, {0, 0, 9})};
    return clips;
}

std::vector<Material> make_materials() {
    std::vector<Material> materials(2);
    Material& paint = materials[0];
    paint.name = "paint";
    paint.base_colour = {0.1f, 0.2f, 0.3f, 0.4f};
    paint.metallic = 0.5f;
    paint.roughness = 0.6f;
    paint.emissive = {0.7f, 0.8f, 9.0f};
    paint.normal_scale = -1.1f;
    paint.occlusion_strength = 0.12f;
    paint.alpha_cutoff = 0.13f;
    paint.alpha_mode = AlphaMode::mask;
    paint.double_sided = true;
    paint.unlit = true;
    paint.base_colour_texture = {0, 1, {0.1f, 0.2f}, 0.3f, {4, 5}};
    paint.metallic_roughness_texture = {1, 2, {0.2f, 0.3f}, 0.4f, {5, 6}};
    paint.normal_texture = {2, 3, {0.3f, 0.4f}, 0.5f, {6, 7}};
    paint.occlusion_texture = {1, 4, {0.4f, 0.5f}, 0.6f, {7, 8}};
    paint.emissive_texture = {0, 5, {0.5f, 0.6f}, -0.7f, {8, -9}};
    paint.extensions = R"({"KHR_materials_ior":{"ior":1.4}})";
    paint.extras = R"({"gloss":1})";
    return materials;
}

Scene make_scene() {
    Scene scene;
    scene.name = "hero";
    scene.joints = make_joints();
    scene.meshes = {make_body(), make_hat()};
    scene.clips = make_clips();
    scene.materials = make_materials();
    scene.images.resize(3);
    scene.images[0].media_type = "image/webp";
    scene.images[0].bytes = bytes_from("RIFF....WEBP");
    scene.images[1].uri = "skin%20a.png";
    scene.images[2].media_type = "image/tiff";
    scene.images[2].bytes = bytes_from("II*");
    scene.textures.resize(3);
    scene.textures[0] = {
        "skin", {0, 1}, Filter::linear, Filter::nearest_mipmap_linear, Wrap::clamp_to_edge, Wrap::mirrored_repeat,
        "{}",   ""};
    scene.textures[1].images = {2};
    scene.textures[2].images = {1, 2};
    scene.extras = R"({"object":1})";
    scene.source_extras = R"({"source":2})";
    scene.asset = R"({"version":"2.0"})";
    return scene;
}

void expect_numbers(const StreamView& stream, std::uint32_t components, const std::vector<float>& values,
                    const std::string& what) {
    ASSERT_EQ(stream.components, components) << what;
    ASSERT_EQ(std::size_t{stream.elements} * components, values.size()) << what;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float number =
            stream.number(static_cast<std::uint32_t>(i / components), static_cast<std::uint32_t>(i % components));
        EXPECT_EQ(std::bit_cast<std::uint32_t>(number), std::bit_cast<std::uint32_t>(values[i])) << what << ' ' << i;
    }
}

template <class Vector>
std::vector<float> flat(const std::vector<Vector>& vectors) {
    std::vector<float> numbers;
    for (const Vector& vector : vectors) {
        for (int c = 0; c < Vector::length(); ++c) numbers.push_back(vector[c]);
    }
    return numbers;
}

TEST(BuildChunks, JointsSurvive) {
    const Scene scene = make_scene();
    const Built built(scene);
    ASSERT_EQ(built.model.joints().size(), scene.joints.size());
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
        const Joint& given = scene.joints[i];
        const bendy::Joint& joint = built.model.joints()[i];
        EXPECT_EQ(joint.name, given.name);
        EXPECT_EQ(joint.parent, given.parent) << i;
        EXPECT_EQ(joint.extras, given.extras);
        EXPECT_EQ(joint.rest.translation, given.rest.translation);
        EXPECT_EQ(joint.rest.scale, given.rest.scale);
        EXPECT_EQ(joint.shear, given.rest.shear);
        EXPECT_EQ(glm::vec4(joint.rest.rotation.x, joint.rest.rotation.y, joint.rest.rotation.z, joint.rest.rotation.w),
                  given.rest.rotation);
    }
}

TEST(BuildChunks, VerticesSurvive) {
    const Scene scene = make_scene();
    const Built built(scene);
    ASSERT_EQ(built.model.meshes().size(), 2u);
    const bendy::Mesh& stored = built.model.meshes()[0];
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(stored.name, "body");
    EXPECT_EQ(stored.extras, mesh.extras);
    EXPECT_EQ(stored.joint, 3u);
    EXPECT_EQ(stored.vertices, 4u);
    expect_numbers(stored.positions, 3, flat(mesh.positions), "positions");
    ASSERT_TRUE(stored.normals && stored.tangents && stored.bones && stored.weights);
    expect_numbers(*stored.normals, 3, flat(mesh.normals), "normals");
    expect_numbers(*stored.tangents, 4, flat(mesh.tangents), "tangents");
    ASSERT_EQ(stored.texture_coords.size(), 2u);
    ASSERT_EQ(stored.colours.size(), 2u);
    ASSERT_EQ(stored.attributes.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(stored.texture_coords[i].set, mesh.texture_coords[i].set);
        expect_numbers(stored.texture_coords[i], 2, mesh.texture_coords[i].values, "texture coordinates");
        EXPECT_EQ(stored.colours[i].set, mesh.colours[i].set);
        expect_numbers(stored.colours[i], mesh.colours[i].components, mesh.colours[i].values, "colours");
        EXPECT_EQ(stored.attributes[i].name, mesh.attributes[i].name);
        expect_numbers(stored.attributes[i].values, mesh.attributes[i].components, mesh.attributes[i].values,
                       "attributes");
    }
    expect_numbers(*stored.weights, 2, mesh.weights, "weights");
    ASSERT_EQ(stored.bones->components, 2u);
    for (std::uint32_t i = 0; i < mesh.bones.size(); ++i) EXPECT_EQ(stored.bones->index(i / 2, i % 2), mesh.bones[i]);
    EXPECT_TRUE(std::equal(stored.palette.joints.begin(), stored.palette.joints.end(), mesh.palette.joints.begin(),
                           mesh.palette.joints.end()));
    ASSERT_EQ(stored.palette.inverse_bind().size(), 2u);
    EXPECT_EQ(stored.palette.inverse_bind()[0], mesh.palette.inverse_bind[0]);
    EXPECT_EQ(stored.palette.inverse_bind()[1], mesh.palette.inverse_bind[1]);

    const bendy::Mesh& hat = built.model.meshes()[1];
    EXPECT_TRUE(hat.is_rigid());
    EXPECT_EQ(hat.name, "hat");
    EXPECT_EQ(hat.joint, 4u);
    expect_numbers(hat.positions, 3, flat(scene.meshes[1].positions), "positions of the hat");
    EXPECT_FALSE(hat.normals || hat.tangents);
}

TEST(BuildChunks, TargetsSurvive) {
    const Scene scene = make_scene();
    const Built built(scene);
    const bendy::Mesh& stored = built.model.meshes()[0];
    ASSERT_EQ(stored.targets.size(), 2u);
    EXPECT_EQ(stored.targets[0].name, "smile");
    EXPECT_EQ(stored.targets[0].rest_weight, 0.375f);
    EXPECT_EQ(stored.targets[1].name, "");
    EXPECT_EQ(stored.targets[1].rest_weight, 0.0f);
    EXPECT_FALSE(stored.targets[1].positions.has_value());
    const Mesh& mesh = scene.meshes[0];
    for (std::size_t k = 0; k < 2; ++k) {
        std::vector<glm::vec3> positions(4);
        std::vector<glm::vec3> normals(4);
        std::vector<glm::vec4> tangents(4);
        const std::vector<float> weights{k == 0 ? 1.0f : 0.0f, k == 1 ? 1.0f : 0.0f};
        ASSERT_TRUE(apply_morph_targets(stored, weights, {positions, normals, tangents}));
        for (std::size_t v = 0; v < 4; ++v) {
            const MorphTarget& target = mesh.targets[k];
            const auto displaced = [v](glm::vec3 source, const std::vector<glm::vec3>& by) {
                return by.empty() ? source : source + by[v];
            };
            EXPECT_EQ(positions[v], displaced(mesh.positions[v], target.positions)) << k << ' ' << v;
            EXPECT_EQ(normals[v], displaced(mesh.normals[v], target.normals)) << k << ' ' << v;
            EXPECT_EQ(glm::vec3(tangents[v]), displaced(glm::vec3(mesh.tangents[v]), target.tangents)) << k << ' ' << v;
            EXPECT_EQ(tangents[v].w, mesh.tangents[v].w);
        }
    }
}

TEST(BuildChunks, PolygonsSurviveWithTheirMaterialsAndJoints) {
    const Built built(make_scene());
    // Triangle 0 1 2: joint 2 has 1 + 0.25 + 0.1, joint 1 has 0.75 + 0.9. Triangle 2 1 3: joint 1 has 0.9 + 0.75 + 1.
    struct Expected {
        std::uint32_t joint, mesh, material;
        Topology topology;
        std::vector<std::uint32_t> vertices;
    };
    const std::vector<Expected> expected{{1, 0, 0, Topology::triangles, {2, 1, 3}},
                                         {1, 0, 1, Topology::triangles, {0, 1, 2}},
                                         {4, 1, kNone, Topology::triangles, {0, 1, 2}},
                                         {4, 1, kNone, Topology::lines, {0, 1}},
                                         {4, 1, kNone, Topology::points, {2, 0}}};
    const auto polygons = built.model.joint_submeshes();
    ASSERT_EQ(polygons.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(polygons[i].joint, expected[i].joint) << i;
        EXPECT_EQ(polygons[i].mesh, expected[i].mesh) << i;
        EXPECT_EQ(polygons[i].material, expected[i].material) << i;
        EXPECT_EQ(polygons[i].topology, expected[i].topology) << i;
        std::vector<std::uint32_t> vertices;
        const bendy::Mesh& mesh = built.model.meshes()[polygons[i].mesh];
        for (std::uint32_t k = 0; k < polygons[i].count; ++k)
            vertices.push_back(mesh.indices->index(polygons[i].first + k, 0));
        EXPECT_EQ(vertices, expected[i].vertices) << i;
    }
}

/// Two joints with a triangle each of materials that are called by what becomes of them.
Scene scene_with_own_materials() {
    Scene scene;
    scene.joints.resize(2);
    scene.joints[1].parent = 0;
    for (const auto& [name, joint] :
         std::initializer_list<std::pair<const char*, std::uint32_t>>{{"own of 1", 1},
                                                                      {"shared", kNone},
                                                                      {"used by both", 0},
                                                                      {"moved by a curve", 1},
                                                                      {"own of 0", 0},
                                                                      {"also of 1", 1}}) {
        Material& material = scene.materials.emplace_back();
        material.name = name;
        material.joint = joint;
    }
    const std::array<std::vector<std::uint32_t>, 2> used{{{1, 2, 4}, {0, 2, 3, 5}}};
    for (std::uint32_t joint = 0; joint < 2; ++joint) {
        Mesh& mesh = scene.meshes.emplace_back();
        mesh.joint = joint;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        for (const std::uint32_t material : used[joint])
            mesh.submeshes.push_back({Topology::triangles, material, {0, 1, 2}});
    }
    Curve& curve = scene.clips.emplace_back().curves.emplace_back();
    curve.path = "alphaCutoff";
    curve.kind = CurveTarget::material;
    curve.target = 3;
    curve.times = {0.0f};
    curve.values = {1.0f};
    return scene;
}

TEST(BuildChunks, AJointsOwnMaterialStandsInItsJoint) {
    const Scene scene = scene_with_own_materials();
    const Built built(scene);
    EXPECT_EQ(built.document.global_materials, 3u);
    std::vector<std::string> names;
    for (const MaterialView& material : built.document.materials) names.emplace_back(material.name);
    EXPECT_EQ(names, (std::vector<std::string>{"shared", "used by both", "moved by a curve", "own of 0", "own of 1",
                                               "also of 1"}));
    EXPECT_EQ(built.document.objects[0].skeleton.first_local_material, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(built.document.objects[0].clips[0].curves[0].target, 2u);
    std::multiset<std::pair<std::uint32_t, std::string>> used;
    for (const auto& polygons : built.model.joint_submeshes()) used.emplace(polygons.joint, names[polygons.material]);
    EXPECT_EQ(used, (std::multiset<std::pair<std::uint32_t, std::string>>{{0, "shared"},
                                                                          {0, "used by both"},
                                                                          {0, "own of 0"},
                                                                          {1, "own of 1"},
                                                                          {1, "used by both"},
                                                                          {1, "moved by a curve"},
                                                                          {1, "also of 1"}}));
    Report report;
    const auto again = import_bendy(built.bytes, report);
    ASSERT_TRUE(again);
    const Buffer settled = build_chunks(*again, "test 1.0", report);
    EXPECT_EQ(build_chunks(*import_bendy(settled, report), "test 1.0", report), settled);
    const Buffer compact = build_chunks(scene, "test 1.0", report, {.compact = true});
    EXPECT_TRUE(validate(compact).empty());
    const auto from_compact = import_bendy(compact, report);
    ASSERT_TRUE(from_compact);
    EXPECT_EQ(build_chunks(*from_compact, "test 1.0", report), settled) << "also beside a table of joints";
}

TEST(BuildChunks, ClipsSurvive) {
    const Scene scene = make_scene();
    const Built built(scene);
    const auto clips = built.model.clips();
    ASSERT_EQ(clips.size(), scene.clips.size());
    for (std::size_t c = 0; c < clips.size(); ++c) {
        EXPECT_EQ(clips[c].name, scene.clips[c].name);
        EXPECT_EQ(clips[c].loop, scene.clips[c].loop);
        EXPECT_EQ(clips[c].extras, scene.clips[c].extras);
        ASSERT_EQ(clips[c].tracks.size(), scene.clips[c].tracks.size());
        for (std::size_t t = 0; t < clips[c].tracks.size(); ++t) {
            const TrackView& track = clips[c].tracks[t];
            const Track& given = scene.clips[c].tracks[t];
            EXPECT_EQ(track.path, given.path);
            EXPECT_EQ(track.interpolation, given.interpolation);
            EXPECT_EQ(track.target, given.target);
            EXPECT_EQ(track.components, given.components);
            EXPECT_EQ(std::vector<float>(track.times.begin(), track.times.end()), given.times);
            EXPECT_EQ(std::vector<float>(track.values.begin(), track.values.end()), given.values);
        }
    }
    EXPECT_EQ(clips[0].start, 0.25f);  // the earliest key of all tracks
    EXPECT_EQ(clips[0].end, 1.75f);
    EXPECT_EQ(clips[1].start, 0.0f);
    EXPECT_EQ(clips[1].end, 0.0f);
    EXPECT_EQ(clips[2].start, 3.0f);
    EXPECT_EQ(clips[2].end, 3.0f);
}

TEST(BuildChunks, EqualKeysAreStoredOnce) {
    const Built built(make_scene());
    const auto& tracks = built.model.clips()[0].tracks;
    EXPECT_EQ(tracks[0].times.data(), tracks[2].times.data());
    EXPECT_EQ(tracks[0].values.data(), tracks[2].values.data());
    EXPECT_NE(tracks[0].times.data(), tracks[3].times.data());
}

TEST(BuildChunks, KeysKeepTheSignOfZero) {
    Scene scene;
    scene.joints.resize(2);
    scene.clips.resize(1);
    const std::vector<float> plus{0.0f, 0.0f, 0.0f};
    const std::vector<float> minus{-0.0f, 0.0f, -0.0f};
    scene.clips[0].tracks = {make_track(TrackPath::translation, Interpolation::linear, 0, 3, {0}, plus),
                             make_track(TrackPath::translation, Interpolation::linear, 1, 3, {0}, minus)};
    const Built built(scene);
    const auto& tracks = built.model.clips()[0].tracks;
    EXPECT_EQ(std::memcmp(tracks[0].values.data(), plus.data(), sizeof(float) * 3), 0);
    EXPECT_EQ(std::memcmp(tracks[1].values.data(), minus.data(), sizeof(float) * 3), 0);
}

void expect_use(const TextureUseRecord& record, const TextureUse& use) {
    EXPECT_EQ(record.texture, use.texture);
    EXPECT_EQ(record.coords, use.coords);
    EXPECT_EQ(glm::vec2(record.offset[0], record.offset[1]), use.offset);
    EXPECT_EQ(glm::vec2(record.scale[0], record.scale[1]), use.scale);
    EXPECT_EQ(record.rotation, use.rotation);
}

TEST(BuildChunks, MaterialsSurvive) {
    const Scene scene = make_scene();
    const Built built(scene);
    ASSERT_EQ(built.model.materials().size(), scene.materials.size());
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& given = scene.materials[i];
        const MaterialView& view = built.model.materials()[i];
        const SurfaceRecord& surface = view.surface;
        EXPECT_EQ(view.name, given.name);
        EXPECT_EQ(view.extensions, given.extensions);
        EXPECT_EQ(view.extras, given.extras);
        for (int c = 0; c < 4; ++c) EXPECT_EQ(surface.base_colour[static_cast<std::size_t>(c)], given.base_colour[c]);
        for (int c = 0; c < 3; ++c) EXPECT_EQ(surface.emissive[static_cast<std::size_t>(c)], given.emissive[c]);
        EXPECT_EQ(surface.metallic, given.metallic);
        EXPECT_EQ(surface.roughness, given.roughness);
        EXPECT_EQ(surface.normal_scale, given.normal_scale);
        EXPECT_EQ(surface.occlusion_strength, given.occlusion_strength);
        EXPECT_EQ(surface.alpha_cutoff, given.alpha_cutoff);
        EXPECT_EQ(surface.alpha_mode, static_cast<std::uint8_t>(given.alpha_mode));
        EXPECT_EQ(surface.double_sided != 0, given.double_sided);
        EXPECT_EQ(surface.unlit != 0, given.unlit);
        expect_use(surface.base_colour_texture, given.base_colour_texture);
        expect_use(surface.metallic_roughness_texture, given.metallic_roughness_texture);
        expect_use(surface.normal_texture, given.normal_texture);
        expect_use(surface.occlusion_texture, given.occlusion_texture);
        expect_use(surface.emissive_texture, given.emissive_texture);
    }
}

TEST(BuildChunks, TexturesSurviveAndSharedImagesAreStoredOnce) {
    const Built built(make_scene());
    const auto textures = built.model.textures();
    ASSERT_EQ(textures.size(), 3u);
    EXPECT_EQ(textures[0].name, "skin");
    EXPECT_EQ(textures[0].extras, "{}");
    EXPECT_EQ(textures[0].sampler.mag_filter, static_cast<std::uint8_t>(Filter::linear));
    EXPECT_EQ(textures[0].sampler.min_filter, static_cast<std::uint8_t>(Filter::nearest_mipmap_linear));
    EXPECT_EQ(textures[0].sampler.wrap_s, static_cast<std::uint8_t>(Wrap::clamp_to_edge));
    EXPECT_EQ(textures[0].sampler.wrap_t, static_cast<std::uint8_t>(Wrap::mirrored_repeat));
    ASSERT_EQ(textures[0].images.size(), 2u);
    EXPECT_EQ(textures[0].images[0].media, MediaType::webp);
    EXPECT_EQ(as_text(textures[0].images[0].bytes), "RIFF....WEBP");
    EXPECT_EQ(textures[0].images[1].uri, "skin%20a.png");
    ASSERT_EQ(textures[1].images.size(), 1u);
    EXPECT_EQ(textures[1].images[0].media, MediaType::other);
    EXPECT_EQ(as_text(textures[1].images[0].bytes), "II*");
    ASSERT_EQ(textures[2].images.size(), 2u);
    ASSERT_TRUE(textures[2].images[0].same && textures[2].images[1].same);
    EXPECT_EQ(textures[2].images[0].same->texture, 0u);
    EXPECT_EQ(textures[2].images[0].same->image, 1u);
    EXPECT_EQ(textures[2].images[1].same->texture, 1u);
    EXPECT_EQ(textures[2].images[1].same->image, 0u);
    EXPECT_TRUE(built.report.warnings().empty());
}

TEST(BuildChunks, EachMediaTypeHasItsNumber) {
    const std::vector<std::pair<std::string, MediaType>> known{
        {"image/png", MediaType::png},   {"image/jpeg", MediaType::jpeg}, {"image/ktx2", MediaType::ktx2},
        {"image/webp", MediaType::webp}, {"image/avif", MediaType::avif}, {"image/bmp", MediaType::other}};
    Scene scene;
    for (std::uint32_t i = 0; i < known.size(); ++i) {
        scene.images.emplace_back();
        scene.images.back().media_type = known[i].first;
        scene.images.back().bytes = bytes_from("x");
        scene.textures.emplace_back();
        scene.textures.back().images = {i};
    }
    const Built built(scene);
    for (std::size_t i = 0; i < known.size(); ++i)
        EXPECT_EQ(built.model.textures()[i].images[0].media, known[i].second) << known[i].first;
}

TEST(BuildChunks, StructureFirstAndBulkAfterIt) {
    Scene scene = make_scene();
    const Built embedding(scene);
    EXPECT_EQ(embedding.ids("HEAD"), "VERS EXTR MATE MATE OBJE TEXT TEXT TEXT");
    EXPECT_EQ(embedding.ids("HEAD/OBJE"), "NAME EXTR SKIN SKIN VECT VECT CYCL CYCL CYCL");

    for (Image& image : scene.images) image.bytes.clear();
    scene.images[0].uri = "a.webp";
    scene.images[2].uri = "b.tiff";
    const Built linking(scene);
    EXPECT_EQ(linking.ids("HEAD"), "VERS EXTR TEXT TEXT TEXT MATE MATE OBJE");
    EXPECT_EQ(linking.model.textures()[0].images[0].uri, "a.webp");
}

TEST(BuildChunks, TheVersionCountsWhatIsThere) {
    const Built built(make_scene(), "generator of exactly 32 bytes!!!");
    ASSERT_TRUE(built.document.version.has_value());
    const VersionRecord& version = *built.document.version;
    EXPECT_EQ(version.objects, 1u);
    EXPECT_EQ(version.joints, 5u);
    EXPECT_EQ(version.meshes, 2u);
    EXPECT_EQ(version.vertices, 7u);
    EXPECT_EQ(version.clips, 3u);
    EXPECT_EQ(version.materials, 2u);
    EXPECT_EQ(version.textures, 3u);
    EXPECT_EQ(std::string(version.generator.begin(), version.generator.end()), "generator of exactly 32 bytes!!!");
}

TEST(BuildChunks, NamesAndTheAuthorsDataSurvive) {
    const Built built(make_scene());
    EXPECT_EQ(built.model.name(), "hero");
    EXPECT_EQ(built.document.objects.at(0).extras, R"({"object":1})");
    EXPECT_EQ(built.document.extras, R"({"asset":{"version":"2.0"},"extras":{"source":2}})");

    Scene scene;
    scene.source_extras = "[1]";
    EXPECT_EQ(Built(scene).document.extras, R"({"extras":[1]})");
    scene.source_extras.clear();
    EXPECT_EQ(Built(scene).ids("HEAD"), "VERS OBJE");
}

TEST(BuildChunks, AnEmptySceneIsAGoodFile) {
    const Built built(Scene{});
    EXPECT_TRUE(built.model.joints().empty());
    EXPECT_EQ(built.model.vertex_count(), 0u);
}

TEST(BuildChunks, ASceneThatIsGivenUpGivesTheSameBytes) {
    Report report;
    const Scene kept = make_scene();
    const Buffer once = build_chunks(kept, "g", report);
    Scene given_up = kept;
    EXPECT_EQ(build_chunks(std::move(given_up), "g", report), once);
    EXPECT_EQ(build_chunks(kept, "g", report), once);
}

TEST(BuildChunks, TwiceTheSameBytes) {
    Report report;
    const Buffer once = build_chunks(make_scene(), "g", report);
    EXPECT_EQ(once, build_chunks(make_scene(), "g", report));
    Scene other = make_scene();
    other.meshes[0].positions[3].x = 0.5f;
    EXPECT_NE(once, build_chunks(other, "g", report));
}

TEST(BuildChunks, AnImageThatNothingUsesIsNamedAndCounted) {
    Scene scene = make_scene();
    scene.textures[1].images = {};
    scene.textures[2].images = {};
    scene.textures[0].images = {0};
    const Built built(scene);
    ASSERT_EQ(built.report.warnings().size(), 1u);
    EXPECT_EQ(built.report.warnings()[0].count, 2u);
    EXPECT_EQ(built.report.warnings()[0].first_place, "images[1]");
}

TEST(BuildChunks, ATargetTakesTheSmallerOfTwoForms) {
    constexpr std::uint32_t kVertices = 24;
    const auto scene_with = [](std::uint32_t touched) {
        Scene scene;
        scene.joints.resize(1);
        Mesh mesh;
        mesh.joint = 0;
        mesh.positions.resize(kVertices);
        mesh.normals.resize(kVertices, {0, 0, 1});
        mesh.targets.resize(1);
        mesh.targets[0].rest_weight = 0.5f;
        mesh.targets[0].positions.resize(kVertices);
        mesh.targets[0].normals.resize(kVertices);
        for (std::uint32_t v = 0; v < touched; ++v) {  // scattered, and in one of the streams only
            const std::uint32_t vertex = v * 7 % kVertices;
            (v % 2 == 0 ? mesh.targets[0].positions : mesh.targets[0].normals)[vertex] = {static_cast<float>(v) + 1.0f,
                                                                                          0, 0};
        }
        scene.meshes = {mesh};
        return scene;
    };
    const std::size_t dense_size = Built(scene_with(kVertices)).bytes.size();
    std::size_t before = 0;
    for (std::uint32_t touched = 0; touched <= kVertices; ++touched) {
        const Scene scene = scene_with(touched);
        const Built built(scene);
        EXPECT_LE(before, built.bytes.size()) << touched;
        EXPECT_LE(built.bytes.size(), dense_size) << touched;
        before = built.bytes.size();

        const bendy::Mesh& stored = built.model.meshes()[0];
        ASSERT_EQ(stored.targets.size(), 1u);
        EXPECT_EQ(stored.targets[0].rest_weight, 0.5f);
        const bool is_sparse = stored.targets[0].vertices.has_value();
        if (touched == 1) {
            EXPECT_TRUE(is_sparse);
        }
        if (touched == kVertices) {
            EXPECT_FALSE(is_sparse);
        }
        if (is_sparse) {
            EXPECT_EQ(stored.targets[0].vertices->elements, touched);
        }
        std::vector<glm::vec3> positions(kVertices);
        std::vector<glm::vec3> normals(kVertices);
        ASSERT_TRUE(apply_morph_targets(stored, std::vector{1.0f}, {positions, normals, {}}));
        for (std::uint32_t v = 0; v < kVertices; ++v) {
            EXPECT_EQ(positions[v], scene.meshes[0].targets[0].positions[v]);
            EXPECT_EQ(normals[v], glm::vec3(0, 0, 1) + scene.meshes[0].targets[0].normals[v]);
        }
    }
}

TEST(BuildChunks, SmallNumbersTakeSmallStreams) {
    const Built built(make_scene());
    const bendy::Mesh& stored = built.model.meshes()[0];
    EXPECT_EQ(stored.texture_coords[0].type, ComponentType::u8);   // 0 and 1
    EXPECT_EQ(stored.texture_coords[1].type, ComponentType::f32);  // negative numbers
    EXPECT_EQ(stored.bones->type, ComponentType::u8);
    EXPECT_EQ(stored.indices->type, ComponentType::u16);
    EXPECT_EQ(stored.attributes[0].values.type, ComponentType::f32);
}

TEST(BuildChunks, ALongRopeIsNoRecursion) {
    Scene scene;
    constexpr std::uint32_t kJoints = 10'000;
    scene.joints.resize(kJoints);
    for (std::uint32_t i = 1; i < kJoints; ++i) scene.joints[i].parent = i - 1;
    const Built built(scene);
    ASSERT_EQ(built.model.joints().size(), kJoints);
    EXPECT_EQ(built.model.joints()[kJoints - 1].parent, kJoints - 2);
}

}  // namespace
}  // namespace bendy::converter::build_chunks_test
