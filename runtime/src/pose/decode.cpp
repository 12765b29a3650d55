#include "decode.h"

#include "kernels/pose_kernels.h"

namespace bendy {
namespace {

StreamView part_of(const StreamView& stream, std::size_t first, std::size_t count) {
    StreamView part = stream;
    const std::size_t bytes = std::size_t{stream.components} * component_size(stream.type);
    part.data = stream.data.subspan(first * bytes, count * bytes);
    part.elements = static_cast<std::uint32_t>(count);
    return part;
}

Integers integers_of(const StreamView& part) {
    const bool is_signed = part.type == ComponentType::i8 || part.type == ComponentType::i16;
    return {part.data.data(), static_cast<std::uint32_t>(component_size(part.type)), is_signed};
}

/// Decodes the forms that compact files have; false for any other.
template <class Vector>
bool decode_with(const PoseKernels& kernels, const StreamView& part, std::span<Vector> out) {
    constexpr auto kNumbers = static_cast<std::size_t>(Vector::length());
    const Integers integers = integers_of(part);
    if (part.is_octahedral && part.normalised && part.boxes.empty() && integers.is_signed &&
        part.components == kNumbers - 1) {
        kernels.decode_directions({integers, out.size(), part.components, &out.front().x});
        return true;
    }
    if (part.boxes.size() != kNumbers || part.components != kNumbers || part.is_octahedral || !part.list.empty() ||
        part.type == ComponentType::f32) {
        return false;
    }
    BoxedBlock block{integers, kNumbers * out.size(), {}, {}, &out.front().x};
    for (std::size_t k = 0; k < BoxedBlock::kPattern; ++k) {
        block.minimum[k] = part.boxes[k % kNumbers].minimum;
        block.step[k] = part.boxes[k % kNumbers].step;
    }
    kernels.decode_boxed(block);
    return true;
}

template <class Vector>
void decode_any(const StreamView& stream, std::size_t first, std::span<Vector> out) {
    if (out.empty()) return;
    const StreamView part = part_of(stream, first, out.size());
    const PoseKernels* const kernels = pose_kernels();
    if (kernels == nullptr || !decode_with(*kernels, part, out)) part.decode(out);
}

}  // namespace

void decode(const StreamView& stream, std::size_t first, std::span<glm::vec3> out) {
    decode_any(stream, first, out);
}

void decode(const StreamView& stream, std::size_t first, std::span<glm::vec4> out) {
    decode_any(stream, first, out);
}

}  // namespace bendy
