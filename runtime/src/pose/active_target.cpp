#include "active_target.h"

#include "decode.h"
#include "model/frame_shape.h"

#include <algorithm>
#include <array>

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

/// Of successive vertices. Vectors of three numbers are one array of numbers, which suits lanes.
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

}  // namespace bendy
