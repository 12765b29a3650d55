#pragma once

#include <bendy/runtime.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

// Using all that a model gives, so that a sanitizer sees what is done with it.
namespace bendy::test {

inline std::uint64_t touch(std::string_view text) {
    std::uint64_t sum = 0;
    for (const char c : text) sum += static_cast<unsigned char>(c);
    return sum;
}

/// Reads all that a model gives, as a program that draws it does; comes back with a number so that nothing is optimised
/// away.
inline std::uint64_t read_all(const Model& model) {
    std::uint64_t sum = touch(model.name());
    for (std::uint32_t joint = 0; joint < model.joints().size(); ++joint) {
        const Joint& view = model.joints()[joint];
        sum += touch(view.name) + touch(view.extras);
        EXPECT_TRUE(view.parent == kNone || view.parent < joint);
    }
    for (const Constraint& constraint : model.constraints()) EXPECT_LT(constraint.joint, model.joints().size());
    for (const Chain& chain : model.chains()) {
        sum += touch(chain.name) + touch(chain.extras);
        EXPECT_LE(chain.record.start, chain.record.effector);
        EXPECT_LE(chain.links, model.longest_chain());
    }
    for (const Submesh& submesh : model.submeshes()) {
        const Mesh& mesh = model.meshes()[submesh.mesh];
        EXPECT_TRUE(submesh.material == kNone || submesh.material < model.materials().size());
        for (std::uint32_t k = 0; k < submesh.count; ++k) {
            const std::uint32_t vertex = mesh.indices->index(submesh.first + k, 0);
            EXPECT_LT(vertex, mesh.vertices);
            sum += vertex;
        }
    }
    for (const SubmeshView& submesh : model.joint_submeshes()) EXPECT_LT(submesh.joint, model.joints().size());
    for (const Mesh& mesh : model.meshes()) {
        sum += touch(mesh.name) + touch(mesh.extras);
        for (const auto& streams : {mesh.texture_coords, mesh.colours}) {
            for (const StreamView& stream : streams) {
                for (std::uint32_t e = 0; e < mesh.vertices; ++e)
                    sum += stream.number(e, stream.components - 1) > 0.5f ? 1 : 0;
            }
        }
        for (const AttributeView& attribute : mesh.attributes) {
            sum += touch(attribute.name);
            for (std::uint32_t e = 0; e < mesh.vertices; ++e) sum += attribute.values.number(e, 0) > 0.5f ? 1 : 0;
        }
        for (const MorphTargetView& target : mesh.targets) sum += touch(target.name);
    }
    for (const Material& material : model.materials()) {
        sum += touch(material.name) + touch(material.extensions) + touch(material.extras);
        const std::uint32_t texture = material.surface.base_colour_texture.texture;
        EXPECT_TRUE(texture == kNone || texture < model.textures().size());
    }
    for (const Texture& texture : model.textures()) {
        sum += touch(texture.name) + touch(texture.extras);
        for (const ImageView& image : texture.images) {
            sum += touch(image.uri) + touch(as_text(image.bytes));
            if (image.same) sum += model.textures()[image.same->texture].images[image.same->image].bytes.size();
        }
    }
    return sum;
}

/// Every chain with every solver: whatever the numbers are, this ends, and what comes out is a status.
inline void reach_with_all(const Model& model, Pose& pose) {
    ReachState state(model);
    for (const Chain& chain : model.chains()) {
        for (unsigned solver = 0; solver < kSolvers; ++solver) {
            ReachOptions options;
            options.solver = static_cast<Solver>(solver);
            options.iterations = 3;
            options.restarts = 1;
            const ReachTarget target({0.3f, 0.9f, 0.2f}, glm::quat(0.6f, 0.0f, 0.8f, 0.0f));
            (void)reach(pose, &chain, target, options);
            options.state = &state;
            (void)reach(pose, &chain, target, options);
            (void)reach(pose, &chain, glm::vec3(0.1f, 1.2f, -0.3f), options);
        }
    }
}

/// All that is made of a model beside its poses, from numbers of any kind.
inline void play_all(const Model& model) {
    Pose pose(model);
    Pose scratch(model);
    Binding binding(model, model);
    const Bounds bounds(model);
    std::vector<glm::vec3> positions(model.vertex_count());
    std::vector<glm::vec3> normals(model.vertex_count());
    std::vector<glm::vec4> tangents(model.vertex_count());
    const auto last = static_cast<std::uint32_t>(model.joints().size()) - 1;
    const RootPath path(model, last);
    Crossfade fade;
    for (const Clip& clip : model.clips()) {
        fade.play(clip, 0.1f);
        for (const double step : {0.0, 0.03, 0.4, -7.0, 1e30}) {
            fade.advance(step);
            static_cast<void>(path.over(clip, fade.playing().back().played));
            (void)sample(pose, fade, scratch);
            EXPECT_TRUE(path.extract(pose));
            (void)sample(scratch, binding, &clip, static_cast<float>(step));
            EXPECT_TRUE(skin(pose, {.method = SkinningMethod::dual_quaternion, .out = {positions, normals, tangents}}));
            static_cast<void>(bounds.of(pose));
            if (!model.joints().empty()) (void)socket_matrix(pose, {last});
        }
    }
    EXPECT_TRUE(skin(pose, {.method = SkinningMethod::dual_quaternion, .out = {positions, normals, tangents}}));
    EXPECT_EQ(binding.joints().size(), model.joints().size());
}

/// Poses and skins the model at every clip's ends, in its middle, and at times that make no sense.
inline void pose_all(const Model& model) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Pose pose(model);
    std::vector<glm::vec3> positions(model.vertex_count());
    std::vector<glm::vec3> normals(model.vertex_count());
    std::vector<glm::vec4> tangents(model.vertex_count());
    const Vertices vertices{positions, normals, tangents};
    EXPECT_TRUE(skin(pose, {.out = vertices}));
    constrain(pose);
    reach_with_all(model, pose);
    EXPECT_TRUE(skin(pose, {.out = vertices}));
    for (const Clip& clip : model.clips()) {
        const float middle = clip.start + 0.4f * (clip.end - clip.start);
        for (const float seconds : {clip.start, middle, clip.end, -1.0f, 1e30f, kInfinity, -kInfinity,
                                    std::numeric_limits<float>::quiet_NaN()}) {
            (void)sample(pose, &clip, seconds);
            EXPECT_TRUE(skin(pose, {.out = vertices}));
        }
    }
}

}  // namespace bendy::test
