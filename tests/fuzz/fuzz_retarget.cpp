// Retargeting: a character and a human that is built here, each on the other; clips of the character on itself.
#include "check.h"

#include "runtime/human_model.h"

#include <bendy/format/document.h>
#include <bendy/motion/retarget_clips.h>
#include <bendy/runtime/retarget.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace bendy;

void disturb(Pose& pose, std::mt19937& random) {
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    const auto count = static_cast<std::uint32_t>(pose.model().joints().size());
    for (std::uint32_t joint = 0; joint < count; ++joint) {
        JointTransform local = pose.local(joint);
        local.rotation = glm::quat(number(random), number(random), number(random), number(random));
        if (random() % 8 == 0) local.translation *= number(random);
        if (random() % 256 == 0) local.translation.x = std::numeric_limits<float>::infinity();
        if (random() % 256 == 0) local.rotation.w = std::numeric_limits<float>::quiet_NaN();
        pose.set_local(joint, local);
    }
}

void put_on(const Model& target, const Model& source, std::mt19937& random) {
    RetargetOptions options;
    options.rest_poses = random() % 4 == 0 ? RestPoses::alike : RestPoses::measured;
    options.limits = static_cast<Limits>(random() % 3);
    options.plants_feet = random() % 2 == 0;
    auto retargeting = Retarget::make(source, target, options);
    if (!retargeting) return fuzz::check(!error_text(retargeting.error()).empty(), "it is refused for a reason");
    Pose from(source), to(target);
    RetargetState state;
    for (int frame = 0; frame < 3; ++frame) {
        const auto done = retarget(to, *retargeting, from, state);
        fuzz::check(done.has_value() || done.error() == CallError::not_finite, "the poses are those of the models");
        (void)to.model_space();
        disturb(from, random);
    }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 16) return 0;
    static const test::Owned human(test::HumanModel(test::HumanSpec{.thigh = 0.3, .spine = 2, .axes = 5}).file());
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    const std::vector<std::byte> file(bytes, bytes + size);
    std::mt19937 random(data[4]);
    OpenOptions options;
    options.sums = Sums::later;
    const auto model = Model::from_memory(file, options);
    if (!model) return 0;
    put_on(*human, *model, random);
    put_on(*model, *human, random);
    motion::RetargetClips how;
    how.same_name = edit::SameName::number;
    edit::Log log;
    const auto edited = motion::retarget_clips(file, file, how, log);
    if (edited) {
        fuzz::check(validate(*edited).empty(), "what comes out is valid");
    } else {
        fuzz::check(!edited.error().message.empty(), "what is refused is refused for a reason");
    }
    return 0;
}
