#include "made_models.h"

#include "runtime/build_model.h"

#include <bendy/format/diagnostics.h>

#include <cstdio>
#include <cstdlib>
#include <random>

namespace bendy::bench {
namespace {

std::unique_ptr<const MadeModel> open(std::vector<std::byte> bytes) {
    Result<Model> model = Model::from_memory(bytes);
    if (!model) {
        std::fprintf(stderr, "%s\n", describe_with_place(model.error(), bytes).c_str());
        std::abort();
    }
    return std::make_unique<const MadeModel>(MadeModel{std::move(bytes), *std::move(model)});
}

}  // namespace

std::unique_ptr<const MadeModel> make_pool(std::uint32_t vertices) {
    constexpr std::uint32_t kJoints = 64;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    test::ModelSpec spec;
    std::vector<std::uint32_t> joints;
    for (std::uint32_t joint = 0; joint < kJoints; ++joint) {
        test::JointSpec own;
        own.parent = joint == 0 ? kNone : (joint - 1) / 2;
        own.rest = test::turned(30.0 * number(random), joint % 3);
        own.rest.translation = {number(random), number(random), number(random)};
        spec.joints.push_back(own);
        joints.push_back(joint);
    }
    test::PoolSpec pool;
    const glm::vec3 normal(0.0f, 0.6f, 0.8f);
    std::vector<std::uint8_t> bones;
    std::vector<float> weights;
    for (std::uint32_t v = 0; v < vertices; ++v) {
        pool.positions.emplace_back(number(random), number(random), number(random));
        pool.normals.push_back(normal);
        pool.tangents.emplace_back(1.0f, 0.0f, 0.0f, 1.0f);
        const auto near = static_cast<std::uint32_t>(std::uint64_t{v} * kJoints / vertices);
        for (std::uint32_t k = 0; k < 4; ++k) {
            bones.push_back(static_cast<std::uint8_t>((near + random() % 6) % kJoints));
            weights.push_back(0.25f);
        }
    }
    pool.more.push_back(test::make_leaf(FourCC("BONE"), test::stream_payload<std::uint8_t>(4, bones)));
    pool.more.push_back(test::make_leaf(FourCC("WGHT"), test::stream_payload<float>(4, weights)));
    pool.more.push_back(test::palette_leaf(joints, std::vector<glm::mat4>(kJoints, glm::mat4(1.0f))));
    spec.pools.push_back(pool);
    return open(test::build_file(spec));
}

std::unique_ptr<const MadeModel> make_chain(Solver solver, bool is_limited) {
    test::ModelSpec spec;
    for (std::uint32_t joint = 0; joint < 3; ++joint) {
        test::JointSpec own;
        own.parent = joint == 0 ? kNone : joint - 1;
        own.rest = test::turned(joint == 1 ? 25.0 : 5.0, 0);
        own.rest.translation = {0.0f, joint == 0 ? 0.0f : 0.5f, 0.0f};
        if (is_limited && joint == 1) {
            LimitRecord limit;
            limit.model = static_cast<std::uint8_t>(LimitModel::hinge);
            limit.rotation_min[0] = -0.5f;
            limit.rotation_max[0] = 2.6f;
            own.limits.push_back(limit);
        }
        spec.joints.push_back(own);
    }
    ChainRecord chain;
    chain.solver = static_cast<std::uint8_t>(solver);
    chain.effector = solver == Solver::aim ? 0 : 2;
    chain.pole_vector = {0.0f, 0.0f, 1.0f};
    spec.chains.push_back(chain);
    return open(test::build_file(spec));
}

}  // namespace bendy::bench
