// Damaged files through the C API: refused with an error, or harmless in all that can be asked. Most worth under
// sanitizers.
#include "capi/open_handles.h"

#include <array>
#include <cstring>

namespace bendy::test::damaged_file_test {
namespace {

void read_clip(const bendy_model* model, std::uint32_t clip) {
    for (std::uint32_t k = 0; k < bendy_track_count(model, clip); ++k) {
        auto track = sized<bendy_track>();
        ASSERT_EQ(bendy_get_track(model, clip, k, &track, nullptr), BENDY_OK);
        std::vector<float> values(track.components);
        ASSERT_EQ(bendy_sample_track(model, clip, k, 0.6f, values.data(), values.size(), nullptr), BENDY_OK);
    }
    for (std::uint32_t k = 0; k < bendy_frame_sequence_count(model, clip); ++k) {
        auto mix = sized<bendy_frame_mix>();
        ASSERT_EQ(bendy_mix_frames(model, clip, k, 0.6f, &mix, nullptr), BENDY_OK);
    }
    const PlaybackHandle playback(bendy_playback_new(model, clip, nullptr));
    auto played = sized<bendy_played>();
    ASSERT_EQ(bendy_playback_advance(playback.get(), 0.7, &played, nullptr), BENDY_OK);
    std::uint64_t count = 0;
    ASSERT_EQ(bendy_count_markers(model, clip, &played, &count, nullptr), BENDY_OK);
    const RootPathHandle path(bendy_root_path_new(model, 0, nullptr, nullptr));
    bendy_root_motion motion = BENDY_ROOT_MOTION_INIT;
    ASSERT_TRUE(path == nullptr || bendy_root_path_over(path.get(), clip, &played, &motion, nullptr) == BENDY_OK);
}

/// Reads every byte of an image.
std::size_t read_image(const bendy_model* model, std::uint32_t texture, std::uint32_t number) {
    auto image = sized<bendy_image>();
    EXPECT_EQ(bendy_get_image(model, texture, number, &image, nullptr), BENDY_OK);
    std::size_t sum = image.uri == nullptr ? 0 : std::strlen(image.uri);
    for (std::size_t k = 0; k < image.byte_count; ++k) sum += static_cast<const unsigned char*>(image.bytes)[k];
    return sum;
}

/// Reads every stream of a mesh.
void read_streams(const bendy_model* model, std::uint32_t mesh) {
    for (std::uint32_t k = 0; k < bendy_stream_count(model, mesh); ++k) {
        auto stream = sized<bendy_stream>();
        ASSERT_EQ(bendy_get_stream(model, mesh, k, &stream, nullptr), BENDY_OK);
        std::vector<float> numbers(std::size_t{stream.elements} * stream.components);
        const bendy_status status = bendy_get_numbers(model, mesh, k, numbers.data(), numbers.size(), nullptr);
        ASSERT_TRUE(status == BENDY_OK || numbers.empty());
        std::size_t sum = std::strlen(stream.name);
        for (std::size_t b = 0; b < stream.data_size; ++b) sum += static_cast<const unsigned char*>(stream.data)[b];
        ASSERT_GE(sum, std::strlen(stream.name));
    }
}

/// Everything there is to ask of a model; gives a number so that nothing is optimised away.
std::size_t read_all(const bendy_model* model) {
    std::size_t sum = 0;
    const auto add_name = [&](bendy_status status, const auto& thing) {
        EXPECT_EQ(status, BENDY_OK);
        if (status == BENDY_OK) sum += std::strlen(thing.name);
    };
    for (std::uint32_t k = 0; k < bendy_joint_count(model); ++k) {
        auto joint = sized<bendy_joint>();
        add_name(bendy_get_joint(model, k, &joint, nullptr), joint);
    }
    for (std::uint32_t k = 0; k < bendy_clip_count(model); ++k) {
        auto clip = sized<bendy_clip>();
        add_name(bendy_get_clip(model, k, &clip, nullptr), clip);
        for (std::uint32_t c = 0; c < bendy_curve_count(model, k); ++c) {
            auto curve = sized<bendy_curve>();
            add_name(bendy_get_curve(model, k, c, &curve, nullptr), curve);
            sum += std::strlen(curve.path);
            std::array<float, 4> values{};
            EXPECT_EQ(bendy_sample_curve(model, k, c, 0.5, values.data(), values.size(), nullptr), BENDY_OK);
        }
        read_clip(model, k);
    }
    for (std::uint32_t k = 0; k < bendy_chain_count(model); ++k) {
        auto chain = sized<bendy_chain>();
        add_name(bendy_get_chain(model, k, &chain, nullptr), chain);
    }
    for (std::uint32_t k = 0; k < bendy_morph_target_count(model); ++k) {
        auto target = sized<bendy_morph_target>();
        add_name(bendy_get_morph_target(model, k, &target, nullptr), target);
    }
    for (std::uint32_t k = 0; k < bendy_material_count(model); ++k) {
        auto material = sized<bendy_material>();
        add_name(bendy_get_material(model, k, &material, nullptr), material);
        sum += std::strlen(material.extensions) + std::strlen(material.extras) + std::strlen(material.more);
    }
    for (std::uint32_t k = 0; k < bendy_texture_count(model); ++k) {
        auto texture = sized<bendy_texture>();
        add_name(bendy_get_texture(model, k, &texture, nullptr), texture);
        for (std::uint32_t i = 0; i < texture.images; ++i) sum += read_image(model, k, i);
    }
    for (std::uint32_t k = 0; k < bendy_constraint_count(model); ++k) {
        const std::array<double, 4> turned{0.6, 0.0, 0.0, 0.8};
        std::array<double, 4> clamped{};
        double violation = 0.0;
        EXPECT_EQ(bendy_clamp_rotation(model, k, turned.data(), clamped.data(), &violation, nullptr), BENDY_OK);
    }
    return sum;
}

/// A mesh' streams; every index must be one of its vertices.
void read_mesh(const bendy_model* model, std::uint32_t number) {
    auto mesh = sized<bendy_mesh>();
    ASSERT_EQ(bendy_get_mesh(model, number, &mesh, nullptr), BENDY_OK);
    std::vector<std::uint32_t> indices(mesh.indices + std::size_t{1});
    ASSERT_EQ(bendy_get_indices(model, number, indices.data(), indices.size(), nullptr), BENDY_OK);
    for (const std::uint32_t index : indices) ASSERT_TRUE(index < mesh.vertices || index == 0);
    std::vector<float> uv(std::size_t{2} * mesh.vertices + 1);
    bendy_get_texture_coords(model, number, 0, uv.data(), uv.size(), nullptr);
    read_streams(model, number);
    for (std::uint32_t k = 0; k < mesh.targets; ++k) {
        auto target = sized<bendy_morph_target>();
        ASSERT_EQ(bendy_get_morph_target(model, mesh.first_morph_target + k, &target, nullptr), BENDY_OK);
        std::vector<float> shifts(std::size_t{3} * target.vertices + 1);
        ASSERT_EQ(bendy_get_displacements(model, mesh.first_morph_target + k, nullptr, shifts.data(), shifts.data(),
                                          shifts.data(), target.vertices, nullptr),
                  BENDY_OK);
    }
    std::vector<std::uint32_t> joints(std::size_t{mesh.vertices} + mesh.bones + 1);
    if (mesh.influences == 0) {
        ASSERT_EQ(bendy_get_movers(model, number, joints.data(), joints.size(), nullptr), BENDY_OK);
        return;
    }
    std::vector<float> matrices(std::size_t{16} * mesh.bones);
    ASSERT_EQ(bendy_get_bind_palette(model, number, joints.data(), matrices.data(), mesh.bones, nullptr), BENDY_OK);
    std::vector<std::uint32_t> bones(std::size_t{mesh.vertices} * mesh.influences + 1);
    std::vector<float> weights(bones.size());
    ASSERT_EQ(bendy_get_influences(model, number, bones.data(), weights.data(), bones.size(), nullptr), BENDY_OK);
    for (const std::uint32_t bone : bones) ASSERT_TRUE(bone < mesh.bones || bone == 0);
}

void pose_all(const ModelHandle& model) {
    const PoseHandle pose = new_pose(model);
    const LodHandle lod(bendy_lod_new(model.get(), nullptr));
    const BoundsHandle bounds(bendy_bounds_new(model.get(), nullptr));
    bendy_box box{};
    ASSERT_EQ(bendy_bounds_of_pose(bounds.get(), pose.get(), &box, nullptr), BENDY_OK);
    const BindingHandle binding(bendy_binding_new(model.get(), model.get(), nullptr, nullptr));
    ASSERT_TRUE(bendy_clip_count(model.get()) == 0 ||
                bendy_sample_bound(pose.get(), binding.get(), 0, 0.6f, nullptr) == BENDY_OK);
    std::vector<float> numbers((bendy_vertex_count(model.get()) + 1) * 10);
    bendy_vertices out = BENDY_VERTICES_INIT;
    out.capacity = bendy_vertex_count(model.get());
    out.positions = numbers.data();
    out.normals = numbers.data() + 3;
    out.tangents = numbers.data() + 6;
    out.position_stride = out.normal_stride = out.tangent_stride = 40;
    for (const float share : {1.0f, 0.0f}) {
        ASSERT_EQ(bendy_lod_set_share(lod.get(), share, nullptr), BENDY_OK);
        for (std::uint32_t clip = 0; clip < bendy_clip_count(model.get()); ++clip)
            ASSERT_EQ(bendy_sample(pose.get(), clip, 0.6f, nullptr), BENDY_OK);
        const std::array<float, 3> target{0.3f, 0.9f, 0.2f};
        for (std::uint32_t chain = 0; chain < bendy_chain_count(model.get()); ++chain)
            bendy_reach(pose.get(), chain, target.data(), nullptr, nullptr, nullptr, nullptr);
        for (const std::uint32_t method : {BENDY_SKIN_LINEAR, BENDY_SKIN_DUAL_QUATERNION}) {
            bendy_skin_options options = BENDY_SKIN_OPTIONS_INIT;
            options.lod = lod.get();
            options.method = method;
            ASSERT_EQ(bendy_skin(pose.get(), &options, &out, nullptr), BENDY_OK);
        }
    }
}

/// Whether the bytes are a model, which then has been used.
bool try_out(Bytes bytes) {
    bendy_open_options options = BENDY_OPEN_OPTIONS_INIT;
    options.sums_later = 1;
    bendy_error error = BENDY_ERROR_INIT;
    const ModelHandle model(bendy_open_copy(bytes.data(), bytes.size(), &options, &error));
    if (model == nullptr) {
        EXPECT_GE(error.status, BENDY_MALFORMED);
        EXPECT_LE(error.offset, bytes.size());
        EXPECT_NE(error.message[0], '\0');
        return false;
    }
    read_all(model.get());
    for (std::uint32_t mesh = 0; mesh < bendy_mesh_count(model.get()); ++mesh) read_mesh(model.get(), mesh);
    pose_all(model);
    return true;
}

TEST(CDamagedFile, AnyFieldWithAnExtremeNumberIsRefusedOrHarmless) {
    const Buffer good = sample_file();
    int accepted = 0;
    int refused = 0;
    for (std::size_t at = 0; at + 4 <= good.size(); at += 4) {
        for (const std::uint32_t number : {0u, 0xffff'ffffu, 0x7fc0'0000u /* nan */}) {
            Buffer file = good;
            patch(file, at, number);
            ++(try_out(file) ? accepted : refused);
            if (testing::Test::HasFailure()) FAIL() << "offset " << at << ", number " << number;
        }
    }
    EXPECT_GT(accepted, 100);
    EXPECT_GT(refused, 100);
}

TEST(CDamagedFile, AnyEarlyEndIsRefused) {
    const Buffer good = sample_file();
    for (std::size_t size = 0; size < good.size(); ++size) {
        bendy_error error = BENDY_ERROR_INIT;
        ASSERT_EQ(bendy_open_copy(good.data(), size, nullptr, &error), nullptr);
        ASSERT_EQ(error.status, BENDY_MALFORMED) << size;
    }
}

}  // namespace
}  // namespace bendy::test::damaged_file_test
