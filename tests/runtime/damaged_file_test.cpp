#include <bendy/runtime.h>

#include "runtime/build_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <vector>

// What is not refused must be harmless: this is most worth running under AddressSanitizer and
// UndefinedBehaviorSanitizer.
namespace bendy {
namespace {

using test::Buffer;

std::uint64_t touch(std::string_view text) {
    std::uint64_t sum = 0;
    for (const char c : text) sum += static_cast<unsigned char>(c);
    return sum;
}

/// Reads all that a model gives, as a program that draws it does; comes back with a number so that nothing is optimised
/// away.
std::uint64_t read_all(const Model& model) {
    std::uint64_t sum = touch(model.name());
    for (std::uint32_t joint = 0; joint < model.joints().size(); ++joint) {
        const Joint& view = model.joints()[joint];
        sum += touch(view.name) + touch(view.extras);
        EXPECT_TRUE(view.parent == kNone || view.parent < joint);
    }
    for (const Constraint& constraint : model.constraints()) EXPECT_LT(constraint.joint, model.joints().size());
    for (const Chain& chain : model.chains()) {
        sum += touch(chain.name) + touch(chain.extras);
        EXPECT_LE(chain.start, chain.effector);
        EXPECT_LE(chain.links, model.longest_chain());
    }
    for (const Draw& draw : model.draws()) {
        const Pool& pool = model.pools()[draw.pool];
        EXPECT_TRUE(draw.material == kNone || draw.material < model.materials().size());
        for (std::uint32_t k = 0; k < draw.count; ++k) {
            const std::uint32_t vertex = pool.indices->index(draw.first + k, 0);
            EXPECT_LT(vertex, pool.vertices);
            sum += vertex;
        }
    }
    for (const PolygonView& polygons : model.polygons()) EXPECT_LT(polygons.joint, model.joints().size());
    for (const Pool& pool : model.pools()) {
        sum += touch(pool.name) + touch(pool.extras);
        for (const auto& streams : {pool.texture_coords, pool.colours}) {
            for (const StreamView& stream : streams) {
                for (std::uint32_t e = 0; e < pool.vertices; ++e)
                    sum += stream.number(e, stream.components - 1) > 0.5f ? 1 : 0;
            }
        }
        for (const AttributeView& attribute : pool.attributes) {
            sum += touch(attribute.name);
            for (std::uint32_t e = 0; e < pool.vertices; ++e) sum += attribute.values.number(e, 0) > 0.5f ? 1 : 0;
        }
        for (const TargetView& target : pool.targets) sum += touch(target.name);
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
void reach_with_all(const Model& model, Pose& pose) {
    for (const Chain& chain : model.chains()) {
        for (unsigned solver = 0; solver < kSolvers; ++solver) {
            ReachOptions options;
            options.solver = static_cast<Solver>(solver);
            options.iterations = 3;
            options.restarts = 1;
            const ReachTarget target({0.3f, 0.9f, 0.2f}, glm::quat(0.6f, 0.0f, 0.8f, 0.0f));
            reach(&chain, target, pose, options);
            reach(&chain, glm::vec3(0.1f, 1.2f, -0.3f), pose, options);
        }
    }
}

/// Poses and skins the model at every cycle's ends, in its middle, and at times that make no sense.
void pose_all(const Model& model) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Pose pose(model);
    std::vector<glm::vec3> positions(model.vertex_count());
    std::vector<glm::vec3> normals(model.vertex_count());
    std::vector<glm::vec4> tangents(model.vertex_count());
    const Vertices vertices{positions, normals, tangents};
    EXPECT_TRUE(skin(model, pose, vertices));
    constrain(pose);
    reach_with_all(model, pose);
    EXPECT_TRUE(skin(model, pose, vertices));
    for (const Cycle& cycle : model.cycles()) {
        const float middle = cycle.start + 0.4f * (cycle.end - cycle.start);
        for (const float seconds : {cycle.start, middle, cycle.end, -1.0f, 1e30f, kInfinity, -kInfinity,
                                    std::numeric_limits<float>::quiet_NaN()}) {
            sample(&cycle, seconds, pose);
            EXPECT_TRUE(skin(model, pose, vertices));
        }
    }
}

/// 1 if the bytes are a model, which then has been used; 0 if they are refused.
int try_out(Bytes bytes, const OpenOptions& options = {}) {
    const Result<Model> model = Model::from_memory(bytes, options);
    if (!model) return 0;
    EXPECT_LT(read_all(*model), std::numeric_limits<std::uint64_t>::max());
    pose_all(*model);
    return 1;
}

TEST(DamagedFile, AnyBitWithSumsRepairedIsRefusedOrHarmless) {
    const Buffer good = test::sample_file();
    int accepted = 0;
    int refused = 0;
    for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
        Buffer file = good;
        file[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
        if (!test::resum(file)) {
            ++refused;
            EXPECT_FALSE(Model::from_memory(file).has_value());
            continue;
        }
        try_out(file) == 1 ? ++accepted : ++refused;
        if (testing::Test::HasFailure()) FAIL() << "bit " << bit;
    }
    EXPECT_GT(accepted, 100);  // letters, colours, positions, ...
    EXPECT_GT(refused, 100);
}

TEST(DamagedFile, AnyBitIsRefusedByTheSums) {
    const Buffer good = test::sample_file();
    for (std::size_t bit = 0; bit < good.size() * 8; bit += 3) {
        Buffer file = good;
        file[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
        ASSERT_FALSE(Model::from_memory(file).has_value()) << bit;
    }
}

TEST(DamagedFile, AnyFieldWithAnExtremeNumberIsRefusedOrHarmless) {
    const Buffer good = test::sample_file();
    constexpr std::array<std::uint32_t, 11> kNumbers{0,
                                                     1,
                                                     2,
                                                     0x7fff'ffff,
                                                     0x8000'0000,
                                                     0xffff'ffff,
                                                     0xffff'fffe,
                                                     0x7f80'0000 /* inf */,
                                                     0x7fc0'0000 /* nan */,
                                                     0x7f7f'ffff /* max */,
                                                     0x0001'0000};
    OpenOptions options;
    options.sums = Sums::later;
    for (std::size_t at = 0; at + 4 <= good.size(); at += 4) {
        for (const std::uint32_t number : kNumbers) {
            Buffer file = good;
            test::patch(file, at, number);
            try_out(file, options);
            if (testing::Test::HasFailure()) FAIL() << "offset " << at << ", number " << number;
        }
    }
}

TEST(DamagedFile, ManyChangesAtOnceAreRefusedOrHarmless) {
    const Buffer good = test::sample_file();
    std::mt19937 random(5);
    OpenOptions options;
    options.sums = Sums::later;
    int accepted = 0;
    for (int round = 0; round < 3000; ++round) {
        Buffer file = good;
        const auto changes = 1 + random() % 6;
        for (unsigned long change = 0; change < changes; ++change)
            file[random() % file.size()] = static_cast<std::byte>(random() % 4 == 0 ? random() % 256 : random() % 8);
        accepted += try_out(file, options);
        if (testing::Test::HasFailure()) FAIL() << "round " << round;
    }
    EXPECT_GT(accepted, 10);
}

}  // namespace
}  // namespace bendy
