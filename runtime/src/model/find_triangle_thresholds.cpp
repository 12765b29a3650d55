#include "find_triangle_thresholds.h"

#include <cstddef>
#include <numeric>
#include <utility>

namespace bendy {
namespace {

/// Lists of triangle corners, one for each vertex that stands in for others; when lists are merged, the shorter is
/// appended to the longer.
class Corners {
public:
    Corners(std::uint32_t vertices, std::span<const std::uint32_t> indices)
        : label_(indices.begin(), indices.end()),
          next_(indices.size(), kNone),
          first_(vertices, kNone),
          last_(vertices, kNone),
          count_(vertices, 0),
          list_of_(vertices) {
        std::iota(list_of_.begin(), list_of_.end(), 0u);
        for (std::uint32_t corner = 0; corner < label_.size(); ++corner) append(label_[corner], corner);
    }

    /// Merges `vertex` into `target`; calls visit(triangle) for each triangle that contains both.
    template <class Visit>
    void join(std::uint32_t vertex, std::uint32_t target, const Visit& visit) {
        std::uint32_t shorter = list_of_[vertex];
        std::uint32_t longer = list_of_[target];
        if (count_[shorter] > count_[longer]) std::swap(shorter, longer);
        for (std::uint32_t corner = first_[shorter]; corner != kNone; corner = next_[corner]) {
            label_[corner] = longer;
            const std::size_t triangle = corner / 3;
            const std::size_t at = triangle * 3;
            const std::size_t k = corner - at;
            if (label_[at + (k + 1) % 3] == longer || label_[at + (k + 2) % 3] == longer) visit(triangle);
        }
        if (first_[shorter] != kNone) {
            if (first_[longer] == kNone) {
                first_[longer] = first_[shorter];
            } else {
                next_[last_[longer]] = first_[shorter];
            }
            last_[longer] = last_[shorter];
            count_[longer] += count_[shorter];
        }
        list_of_[target] = longer;
    }

private:
    void append(std::uint32_t list, std::uint32_t corner) {
        if (first_[list] == kNone) {
            first_[list] = corner;
        } else {
            next_[last_[list]] = corner;
        }
        last_[list] = corner;
        ++count_[list];
    }

    std::vector<std::uint32_t> label_, next_;          // by corner
    std::vector<std::uint32_t> first_, last_, count_;  // by list
    std::vector<std::uint32_t> list_of_;               // by vertex
};

}  // namespace

std::vector<std::uint32_t> find_triangle_thresholds(const MeshCollapseView& collapse,
                                                    std::span<const std::uint32_t> indices) {
    std::vector<std::uint32_t> thresholds(indices.size() / 3, 0);
    std::vector<bool> is_collapsed(thresholds.size());
    for (std::size_t triangle = 0; triangle < thresholds.size(); ++triangle) {
        const auto corners = indices.subspan(triangle * 3, 3);
        if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) continue;
        thresholds[triangle] = collapse.vertices - 1;
        is_collapsed[triangle] = true;
    }
    Corners lists(collapse.vertices, indices.first(thresholds.size() * 3));
    for (std::uint32_t vertex = collapse.vertices; vertex-- > collapse.base;) {
        lists.join(vertex, collapse.target(vertex), [&](std::size_t triangle) {
            if (is_collapsed[triangle]) return;
            is_collapsed[triangle] = true;
            thresholds[triangle] = vertex;
        });
    }
    return thresholds;
}

}  // namespace bendy
