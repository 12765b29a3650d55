#include <bendy/runtime/morph_targets.h>

#include "active_target.h"
#include "kernels/kernel_table.h"
#include "model/frame_shape.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace bendy {
namespace {

/// Calls visit with the numbers of a stream of touched vertices.
template <class Visit>
void with_indices(const StreamView& stream, const Visit& visit) {
    if (stream.type == ComponentType::u8) {
        visit(stream.as<std::uint8_t>());
    } else if (stream.type == ComponentType::u16) {
        visit(stream.as<std::uint16_t>());
    } else {
        visit(stream.as<std::uint32_t>());
    }
}

/// Adds to successive vertices. Vectors of three numbers are treated as one array of numbers, which suits lanes.
inline void add_dense(std::span<const glm::vec3> shifts, float weight, std::span<glm::vec3> vectors) {
    if (shifts.empty()) return;
    const float* const from = &shifts.front().x;
    float* const to = &vectors.front().x;
    for (std::size_t i = 0; i < shifts.size() * 3; ++i) to[i] += weight * from[i];
}

template <class Vector>
void add_one(const glm::vec3& shift, float weight, Vector& vector) {
    vector.x += weight * shift.x;
    vector.y += weight * shift.y;
    vector.z += weight * shift.z;
}

void add_dense(std::span<const glm::vec3> shifts, float weight, std::span<glm::vec4> vectors) {
    for (std::size_t i = 0; i < shifts.size(); ++i) add_one(shifts[i], weight, vectors[i]);
}

/// \param entry  of the first of `shifts`
/// \param first  the vertex of the first of `vectors`
template <class Vector>
void add_some(const MorphTargetView& target, std::uint32_t entry, std::span<const glm::vec3> shifts, float weight,
              std::size_t first, std::span<Vector> vectors) {
    if (!target.vertices) return add_dense(shifts, weight, vectors.subspan(entry - first, shifts.size()));
    with_indices(*target.vertices, [&](const auto& indices) {
        const auto touched = indices.subspan(entry, shifts.size());
        constexpr std::size_t kRun = 4;
        std::size_t i = 0;
        while (i + kRun <= shifts.size()) {
            const std::size_t vertex = touched[i] - first;
            if (touched[i + kRun - 1] - touched[i] == kRun - 1) {  // they ascend
                add_dense(shifts.subspan(i, kRun), weight, vectors.subspan(vertex, kRun));
                i += kRun;
            } else {
                add_one(shifts[i++], weight, vectors[vertex]);
            }
        }
        for (; i < shifts.size(); ++i) add_one(shifts[i], weight, vectors[touched[i] - first]);
    });
}

template <class Vector>
void add_entries(const MorphTargetView& target, const StreamView& shifts, float weight, std::uint32_t begin,
                 std::uint32_t end, std::size_t first, std::span<Vector> vectors) {
    if (target.is_frame()) return add_frame(*target.places, shifts, weight, first, vectors);
    if (shifts.type == ComponentType::f32) {
        const auto entries = view_at<glm::vec3>(shifts.data, 0, shifts.elements).subspan(begin, end - begin);
        return add_some(target, begin, entries, weight, first, vectors);
    }
    std::array<glm::vec3, 64> decoded;
    while (begin < end) {
        const std::size_t count = std::min<std::size_t>(end - begin, decoded.size());
        const auto some = std::span(decoded).first(count);
        decode(shifts, begin, some);
        add_some(target, begin, std::span<const glm::vec3>(some), weight, first, vectors);
        begin += static_cast<std::uint32_t>(count);
    }
}

}  // namespace

void ActiveTarget::seek(std::size_t first, std::size_t count) {
    const bool goes_on = first >= last_;
    first_ = first;
    last_ = first + count;
    if (!target_->vertices || target_->is_frame()) {
        begin_ = static_cast<std::uint32_t>(first);
        end_ = static_cast<std::uint32_t>(last_);
        return;
    }
    with_indices(*target_->vertices, [&](const auto& touched) {
        // They ascend, so that no more than `count` of them can be in the range.
        auto begin = touched.begin() + (goes_on ? end_ : 0);
        if (begin != touched.end() && *begin < first) begin = std::lower_bound(begin, touched.end(), first);
        auto end = begin;
        if (begin != touched.end() && *begin < last_) {
            const auto left = static_cast<std::size_t>(touched.end() - begin);
            end = std::lower_bound(begin, begin + static_cast<std::ptrdiff_t>(std::min(left, count)), last_);
        }
        begin_ = static_cast<std::uint32_t>(begin - touched.begin());
        end_ = static_cast<std::uint32_t>(end - touched.begin());
    });
}

void ActiveTarget::add(const StreamView& shifts, std::span<glm::vec3> vectors) const {
    add_entries(*target_, shifts, weight_, begin_, end_, first_, vectors);
}

void ActiveTarget::add(const StreamView& shifts, std::span<glm::vec4> vectors) const {
    add_entries(*target_, shifts, weight_, begin_, end_, first_, vectors);
}

std::span<ActiveTarget> find_active_targets(const MeshView& mesh, std::span<const float> weights,
                                            std::span<ActiveTarget> room) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < mesh.targets.size(); ++k) {
        if (weights[k] != 0.0f) room[count++] = ActiveTarget(mesh.targets[k], weights[k]);
    }
    return room.first(count);
}

namespace {

/// Decodes the vectors of a stream; zeros if the mesh does not have it.
template <class Vector>
void fill(const std::optional<StreamView>& stream, std::uint32_t vertices, std::span<Vector> out) {
    if (out.empty()) return;
    if (!stream) {
        std::fill_n(out.begin(), vertices, Vector(0.0f));
        return;
    }
    stream->decode(out.first(vertices));
}

}  // namespace

Result<void, CallError> apply_morph_targets(const Mesh& mesh, std::span<const float> weights, const Vertices& out) {
    return apply_morph_targets(mesh, weights, mesh.vertices, out);
}

Result<void, CallError> apply_morph_targets(const Mesh& mesh, std::span<const float> weights, std::uint32_t vertices,
                                            const Vertices& out) {
    if (vertices > mesh.vertices) return CallError::out_of_range;
    const auto too_short = [&](const auto& span) { return !span.empty() && span.size() < vertices; };
    if (too_short(out.positions) || too_short(out.normals) || too_short(out.tangents))
        return CallError::output_too_short;
    if (weights.size() < mesh.targets.size()) return CallError::wrong_size;

    fill<glm::vec3>(mesh.positions, vertices, out.positions);
    fill<glm::vec3>(mesh.normals, vertices, out.normals);
    fill<glm::vec4>(mesh.tangents, vertices, out.tangents);
    const float share = rest_share(mesh, weights);
    if (have_frames(mesh, &MorphTargetView::positions) && !out.positions.empty())
        lighten(share, out.positions.first(vertices));
    if (have_frames(mesh, &MorphTargetView::normals) && mesh.normals && !out.normals.empty())
        lighten(share, out.normals.first(vertices));
    for (std::size_t k = 0; k < mesh.targets.size(); ++k) {
        if (weights[k] == 0.0f) continue;
        const MorphTargetView& target = mesh.targets[k];
        ActiveTarget active(target, weights[k]);
        active.seek(0, vertices);
        const auto add = [&](const std::optional<StreamView>& shifts, const auto& vectors) {
            if (shifts && !vectors.empty()) active.add(*shifts, vectors.first(vertices));
        };
        add(target.positions, out.positions);
        if (mesh.normals) add(target.normals, out.normals);
        if (mesh.tangents) add(target.tangents, out.tangents);
    }
    return {};
}

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
bool decode_with(const KernelTable& kernels, const StreamView& part, std::span<Vector> out) {
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
    if (!decode_with(kernel_table(), part, out)) part.decode(out);
}

}  // namespace

void decode(const StreamView& stream, std::size_t first, std::span<glm::vec3> out) {
    decode_any(stream, first, out);
}

void decode(const StreamView& stream, std::size_t first, std::span<glm::vec4> out) {
    decode_any(stream, first, out);
}

}  // namespace bendy
