#pragma once

#include "format/packed_samples.h"
#include "runtime/build_model.h"

#include <cstdint>
#include <string>

namespace bendy::test {

/// A chain of joints, each a metre from its parent, with the clip "packed": samples of make_samples.
inline ModelSpec packed_spec(std::uint32_t joints, std::uint32_t frames, std::uint32_t segment_frames) {
    ModelSpec spec;
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
        JointSpec made{joint == 0 ? kNone : joint - 1, {}, {}, std::to_string(joint)};
        made.rest.translation[1] = 1.0f;
        spec.joints.push_back(made);
    }
    ClipRecord info;
    info.start = 0.5f;
    info.end = 0.5f + static_cast<float>(frames) / 24.0f;
    const std::string name = "packed";
    const auto payload = write_packed(make_samples(joints, frames, segment_frames)).value();
    spec.more.push_back(make_container(
        FourCC("CYCL"), {make_leaf(FourCC("NAME"), std::as_bytes(std::span(name))),
                         make_leaf(FourCC("CINF"), bytes_of(info)), make_leaf(FourCC("PACK"), payload)}));
    return spec;
}

}  // namespace bendy::test
