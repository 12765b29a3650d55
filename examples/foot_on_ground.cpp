// Foot placement: a walk that was animated on a flat floor, on uneven ground.
//
//     bendy convert mannequin.glb && foot_on_ground mannequin.bendy
//
// Each frame: sample the clip, lower the hips until the lower foot can stand, then let each leg's chain reach for the
// ankle's position in the clip, raised by the ground below. The legs' constraints apply: knees bend forward only.
#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace {

/// Returns the height of the ground in metres: gentle waves, up to 8 cm above or below the clip's floor.
float ground(const glm::vec3& at) {
    return 0.08f * std::sin(3.0f * at.x + 1.0f) * std::cos(2.0f * at.z);
}

glm::vec3 position_of(bendy::Pose& pose, std::uint32_t joint) {
    return {pose.model_space()[joint][3]};
}

}  // namespace

int main(int argc, char** argv) {
    const char* file = argc > 1 ? argv[1] : "mannequin.bendy";
    const auto model = bendy::Model::open(file);
    if (!model) {
        std::fprintf(stderr, "%s: %s\n", file, bendy::describe(model.error()).c_str());
        return 1;
    }
    const std::array legs{model->chain("IK_LeftLeg"), model->chain("IK_RightLeg")};
    const bendy::Clip* walk = model->clip("Walk");
    const std::uint32_t hips = model->joint("mixamorig:Hips");
    if (legs[0] == nullptr || legs[1] == nullptr || walk == nullptr || hips == bendy::kNone) {
        std::fprintf(stderr, "%s: no Walk, no legs or no hips\n", file);
        return 1;
    }

    bendy::Pose pose(*model);
    float worst_before = 0.0f;
    float worst_after = 0.0f;
    std::puts("  time   left ankle off by, mm   right ankle off by, mm     (clip alone, with IK)");
    constexpr int kFrames = 20;
    for (int frame = 0; frame < kFrames; ++frame) {
        const float seconds = walk->start + (walk->end - walk->start) * static_cast<float>(frame) / kFrames;
        if (!bendy::sample(pose, walk, seconds)) return 1;
        std::array<glm::vec3, 2> targets{};
        float lowest = 0.0f;
        for (std::size_t leg = 0; leg < legs.size(); ++leg) {
            const glm::vec3 ankle = position_of(pose, legs[leg]->record.effector);
            targets[leg] = ankle + glm::vec3(0.0f, ground(ankle), 0.0f);
            lowest = std::min(lowest, ground(ankle));
        }
        bendy::JointTransform lowered = pose.local(hips);
        lowered.translation.y += lowest;
        pose.set_local(hips, lowered);
        std::printf("%6.2f", seconds);
        for (std::size_t leg = 0; leg < legs.size(); ++leg) {
            const float before = std::abs(ground(targets[leg]));
            const auto result = bendy::reach(pose, legs[leg], targets[leg]);
            if (!result) return std::puts(bendy::error_text(result.error())), 1;
            worst_before = std::max(worst_before, before);
            worst_after = std::max(worst_after, result->distance);
            std::printf("%14.1f %8.3f", before * 1000.0f, result->distance * 1000.0f);
        }
        std::puts("");
    }
    std::printf("worst: %.1f mm with the clip alone, %.3f mm with IK\n", worst_before * 1000.0f, worst_after * 1000.0f);
    return worst_after < 0.001f ? 0 : 1;
}
