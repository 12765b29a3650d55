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

/// Returns the next runs of entries whose vertices are below `last`, as many as there is room for.
/// \param touched  the vertices of all entries, which ascend
/// \param entry    the first one; moved behind the runs
/// \param first    the vertex that the runs call 0
template <class Index>
std::span<const MorphRun> next_runs(std::span<const Index> touched, std::size_t& entry, std::size_t first,
                                    std::size_t last, std::span<MorphRun> room) {
    std::size_t count = 0;
    while (count < room.size() && entry < touched.size() && touched[entry] < last) {
        const std::size_t vertex = touched[entry];
        const auto part = touched.subspan(entry, std::min(touched.size() - entry, last - vertex));
        std::size_t length = 0;
        const auto goes_on = [&](std::size_t more) {
            return length + more <= part.size() && part[length + more - 1] == vertex + length + more - 1;
        };
        while (goes_on(8)) length += 8;
        while (goes_on(4)) length += 4;  // a loop: a conditional move would wait for the last run
        while (goes_on(1)) ++length;
        room[count++] = {static_cast<std::uint32_t>(entry), static_cast<std::uint32_t>(vertex - first),
                         static_cast<std::uint32_t>(length)};
        entry += length;
    }
    return room.first(count);
}

Integers integers_of(const StreamView& stream) {
    const bool is_signed = stream.type == ComponentType::i8 || stream.type == ComponentType::i16;
    return {stream.data.data(), static_cast<std::uint32_t>(component_size(stream.type)), is_signed};
}

/// Whether a stream has vectors of integers in boxes.
bool is_boxed(const StreamView& stream, std::size_t components) {
    return stream.boxes.size() == components && stream.components == components && !stream.is_octahedral &&
           stream.list.empty() && stream.type != ComponentType::f32;
}

}  // namespace

template <class Vector>
void ActiveTarget::add(const std::optional<StreamView>& shifts, std::span<const MorphRun> runs,
                       std::span<Vector> vectors) const {
    if (!shifts || vectors.empty()) return;
    const KernelTable& kernels = kernel_table();
    DisplaceBlock block{runs.data(), runs.size(), weight_, &vectors.front().x, Vector::length(), nullptr, {}, {}, {}};
    if (shifts->type == ComponentType::f32) {
        block.floats = shifts->as<float>().data();
        return kernels.displace(block);
    }
    if (is_boxed(*shifts, 3) && shifts->type != ComponentType::u32) {
        block.integers = integers_of(*shifts);
        for (std::size_t c = 0; c < 3; ++c) {
            block.minimum[c] = shifts->boxes[c].minimum;
            block.step[c] = shifts->boxes[c].step;
        }
        return kernels.displace(block);
    }
    std::array<glm::vec3, 64> decoded;
    MorphRun part{};
    block.runs = &part;
    block.count = 1;
    block.floats = &decoded.front().x;
    for (const MorphRun& run : runs) {
        for (std::uint32_t k = 0; k < run.count; k += part.count) {
            part = {0, run.vertex + k, std::min<std::uint32_t>(run.count - k, decoded.size())};
            decode(*shifts, run.entry + k, std::span(decoded).first(part.count));
            kernels.displace(block);
        }
    }
}

void ActiveTarget::displace(std::size_t first, std::size_t count, const Vertices& vertices) {
    if (target_->is_frame()) {
        const auto add_of = [&](const std::optional<StreamView>& shape, auto vectors) {
            if (shape && !vectors.empty()) add_frame(*target_->places, *shape, weight_, first, vectors);
        };
        add_of(target_->positions, vertices.positions);
        add_of(target_->normals, vertices.normals);
        add_of(target_->tangents, vertices.tangents);
        return;
    }
    const auto add_all = [&](std::span<const MorphRun> runs) {
        add(target_->positions, runs, vertices.positions);
        add(target_->normals, runs, vertices.normals);
        add(target_->tangents, runs, vertices.tangents);
    };
    if (!target_->vertices) {
        const MorphRun run{static_cast<std::uint32_t>(first), 0, static_cast<std::uint32_t>(count)};
        return add_all({&run, 1});
    }
    with_indices(*target_->vertices, [&](const auto& touched) {
        if (first != last_) {
            const auto begin = std::lower_bound(touched.begin(), touched.end(), first);
            entry_ = static_cast<std::size_t>(begin - touched.begin());
        }
        last_ = first + count;
        std::array<MorphRun, 64> room;
        for (;;) {
            const auto runs = next_runs(touched, entry_, first, last_, room);
            if (runs.empty()) return;
            add_all(runs);
        }
    });
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
    // Without a stream in the mesh, normals and tangents are zero.
    const Vertices shifted{
        out.positions.empty() ? out.positions : out.positions.first(vertices),
        mesh.normals && !out.normals.empty() ? out.normals.first(vertices) : std::span<glm::vec3>(),
        mesh.tangents && !out.tangents.empty() ? out.tangents.first(vertices) : std::span<glm::vec4>()};
    for (std::size_t k = 0; k < mesh.targets.size(); ++k) {
        if (weights[k] == 0.0f) continue;
        ActiveTarget(mesh.targets[k], weights[k]).displace(0, vertices, shifted);
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
    if (!is_boxed(part, kNumbers)) return false;
    BoxedBlock block{integers, kNumbers * out.size(), {}, {}, &out.front().x};
    for (std::size_t c = 0; c < kNumbers; ++c) {
        const auto [minimum, step] = part.boxes[c];
        for (std::size_t k = c; k < BoxedBlock::kPattern; k += kNumbers) {
            block.minimum[k] = minimum;
            block.step[k] = step;
        }
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
