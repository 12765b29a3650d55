#include "staging.h"

#include "model/frame_shape.h"
#include "pose/active_target.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace bendy {
namespace {

template <class T>
void widen_as(const StreamView& weights, std::size_t first, std::size_t count, float* out) {
    const std::size_t n = weights.components;
    const std::span<const T> from = weights.as<T>().subspan(first * n, count * n);
    if (weights.boxes.empty()) {
        constexpr auto kLargest = static_cast<float>(std::numeric_limits<T>::max());
        for (std::size_t at = 0; at < from.size(); ++at) out[at] = static_cast<float>(from[at]) / kLargest;
        return;
    }
    for (std::size_t at = 0; at < from.size(); at += n) {
        for (std::size_t c = 0; c < n; ++c)
            out[at + c] = weights.boxes[c].minimum + weights.boxes[c].step * static_cast<float>(from[at + c]);
    }
}

void widen(const StreamView& weights, std::size_t first, std::size_t count, float* out) {
    if (weights.type == ComponentType::u8) return widen_as<std::uint8_t>(weights, first, count, out);
    widen_as<std::uint16_t>(weights, first, count, out);
}

/// Whether SkinBlock::normals8 can have the stream.
bool is_octahedral8(const StreamView& stream) {
    return stream.is_octahedral && stream.normalised && stream.boxes.empty() && stream.components == 2 &&
           stream.type == ComponentType::i8;
}

SkinOutput moved_on(const SkinOutput& out, std::size_t vertices) {
    return {out.data == nullptr ? nullptr : out.data + vertices * out.stride, out.stride};
}

}  // namespace

Staging::Staging(const Mesh& mesh, const SkinPlan* plan, bool unfolds, std::span<const float> weights,
                 std::span<ActiveTarget> room, const SkinBlock& wanted)
    : mesh_(mesh), plan_(plan), active_(find_active_targets(mesh, weights, room)), positions_(mesh.positions) {
    const bool is_shifted = !active_.empty();
    rest_share_ = is_shifted ? rest_share(mesh, weights) : 1.0f;
    const auto in_place = [&](const std::optional<StreamView>& stream, const SkinOutput& out) {
        return out.data == nullptr || (stream && stream->type == ComponentType::f32 && !is_shifted);
    };
    positions_in_place_ = in_place(positions_, wanted.out_positions);
    normals_in_place_ = in_place(mesh.normals, wanted.out_normals);
    tangents_in_place_ = in_place(mesh.tangents, wanted.out_tangents);
    has_normals8_ = unfolds && !normals_in_place_ && !is_shifted && mesh.normals && is_octahedral8(*mesh.normals);
    normals_in_place_ = normals_in_place_ || has_normals8_;
    if (plan_ != nullptr && plan_->first.empty()) plan_ = nullptr;
    weights_in_place_ =
        !mesh.weights || mesh.weights->type == ComponentType::f32 || (plan_ != nullptr && plan_->is_complete);
    const std::size_t numbers = (positions_in_place_ ? 0u : 3u) + (normals_in_place_ ? 0u : 3u) +
                                (tangents_in_place_ ? 0u : 4u) + (weights_in_place_ ? 0u : mesh.weights->components);
    capacity_ = numbers == 0 ? std::numeric_limits<std::size_t>::max() : kNumbers / numbers;
    // Whatever the outputs, so that a vertex has the same bits beside any others.
    const bool fits_groups = weights_in_place_ || (kStreams + mesh.weights->components) * SkinPlan::kGroup <= kNumbers;
    if (!fits_groups) plan_ = nullptr;
    for (const std::size_t whole : {kAligned, SkinPlan::kGroup}) {
        if (capacity_ >= whole) {
            capacity_ -= capacity_ % whole;
            break;
        }
    }
}

template <class Vector>
const float* Staging::bring(const std::optional<StreamView>& stream, std::optional<StreamView> MorphTargetView::*shifts,
                            std::size_t first, std::size_t count, bool in_place, float*& scratch,
                            std::span<Vector>& shifted) const {
    constexpr auto kNumbersEach = static_cast<std::size_t>(Vector::length());
    if (in_place) return stream->as<float>().data() + first * kNumbersEach;
    float* const numbers = std::exchange(scratch, scratch + count * kNumbersEach);
    const std::span<Vector> vectors(reinterpret_cast<Vector*>(numbers), count);  // NOLINT(*-reinterpret-cast)
    if (!stream) {
        std::fill(vectors.begin(), vectors.end(), Vector(0.0f));
        if (shifts != &MorphTargetView::positions) return numbers;  // displacements without a stream to displace
    } else {
        decode(*stream, first, vectors);
    }
    if (have_frames(mesh_, shifts)) lighten(rest_share_, vectors);
    shifted = vectors;
    return numbers;
}

void Staging::fill(std::size_t first, const SkinBlock& wanted, SkinBlock& block) {
    const std::size_t count = block.vertices;
    assert(count <= capacity_);
    float* scratch = scratch_.data();
    Vertices shifted;
    block.out_positions = moved_on(wanted.out_positions, first);
    block.out_normals = moved_on(wanted.out_normals, first);
    block.out_tangents = moved_on(wanted.out_tangents, first);
    if (wanted.out_positions.data != nullptr) {
        block.positions = bring<glm::vec3>(positions_, &MorphTargetView::positions, first, count, positions_in_place_,
                                           scratch, shifted.positions);
    }
    block.normals8 = has_normals8_ ? mesh_.normals->as<std::int8_t>().data() + 2 * first : nullptr;
    if (wanted.out_normals.data != nullptr && !has_normals8_) {
        block.normals = bring<glm::vec3>(mesh_.normals, &MorphTargetView::normals, first, count, normals_in_place_,
                                         scratch, shifted.normals);
    }
    if (wanted.out_tangents.data != nullptr) {
        block.tangents = bring<glm::vec4>(mesh_.tangents, &MorphTargetView::tangents, first, count, tangents_in_place_,
                                          scratch, shifted.tangents);
    }
    for (ActiveTarget& active : active_) active.displace(first, count, shifted);
    if (!mesh_.bones) return;
    const StreamView& bones = *mesh_.bones;
    const StreamView& weights = *mesh_.weights;
    const std::size_t at = first * bones.components;
    block.influences = bones.components;
    if (bones.type == ComponentType::u8) {
        block.bones8 = bones.as<std::uint8_t>().data() + at;
    } else {
        block.bones16 = bones.as<std::uint16_t>().data() + at;
    }
    if (plan_ != nullptr) {
        assert(first % SkinPlan::kGroup == 0);
        block.plan_first = plan_->first.data() + first / SkinPlan::kGroup;
        block.plan_bones = plan_->bones.data();
        block.plan_weights = plan_->weights.empty() ? nullptr : plan_->weights.front().of;
        if (plan_->is_complete) return;
    }
    block.weights = weights_in_place_ ? weights.as<float>().data() + at : scratch;
    if (weights_in_place_) return;
    const std::size_t step = plan_ != nullptr ? SkinPlan::kGroup : count;
    for (std::size_t k = 0; k < count; k += step) {
        if (plan_ != nullptr && block.plan_first[k / step] != block.plan_first[k / step + 1]) continue;  // in the plan
        widen(weights, first + k, std::min(step, count - k), scratch + k * weights.components);
    }
}

}  // namespace bendy
