#include <bendy/runtime/lod.h>

#include <algorithm>
#include <cmath>
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

/// Returns for each triangle of `indices` the number of vertices at which two of its corners merge: the triangle exists
/// while more vertices than that are alive. A triangle with two equal corners from the start disappears first, at
/// vertices - 1; one that never disappears has 0. O(n log n) in triangles and vertices, whatever the targets are.
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

}  // namespace

Lod::Lod(const Model& model) : model_(model), meshes_(model.meshes().size()), place_(model.meshes().size(), kNone) {
    if (const CollapseView* collapse = model.collapse()) {
        for (std::uint32_t place = 0; place < collapse->meshes.size(); ++place) {
            place_[collapse->meshes[place].mesh] = place;
            meshes_[collapse->meshes[place].mesh].collapse = &collapse->meshes[place];
        }
    }
    submeshes_.assign(model.submeshes().begin(), model.submeshes().end());
    first_submesh_.assign(meshes_.size() + 1, 0);
    for (const Submesh& submesh : submeshes_) ++first_submesh_[submesh.mesh + std::size_t{1}];
    std::partial_sum(first_submesh_.begin(), first_submesh_.end(), first_submesh_.begin());
    for (std::uint32_t mesh = 0; mesh < meshes_.size(); ++mesh) prepare(mesh);
    for (const Submesh& submesh : model.submeshes()) {
        const std::uint64_t count = submesh.topology == Topology::triangles ? submesh.count / 3 : 0;
        all_triangles_ += count;
        if (place_[submesh.mesh] == kNone) fixed_triangles_ += count;
    }
    set_share(1.0f);
}

/// Prepares the levels of a mesh. Only triangles that are drawn are counted.
void Lod::prepare(std::uint32_t mesh) {
    const Mesh& source = model_.meshes()[mesh];
    MeshLevel& state = meshes_[mesh];
    state.vertices = source.vertices;
    if (source.indices) {
        state.all.resize(source.indices->elements);
        for (std::uint32_t k = 0; k < state.all.size(); ++k) state.all[k] = source.indices->index(k, 0);
    }
    state.indices = state.all;
    state.corners = state.all.size();
    if (state.collapse == nullptr) return;
    state.now.resize(source.vertices);
    state.targets.reserve(source.vertices - state.collapse->base);
    for (std::uint32_t v = state.collapse->base; v < source.vertices; ++v)
        state.targets.push_back(state.collapse->target(v));
    std::iota(state.now.begin(), state.now.begin() + static_cast<std::ptrdiff_t>(state.collapse->base), 0u);
    state.counts.assign(std::size_t{source.vertices} - state.collapse->base + 1, 0);
    std::vector<std::uint32_t> corners;
    const auto submeshes =
        model_.submeshes().subspan(first_submesh_[mesh], first_submesh_[mesh + 1] - first_submesh_[mesh]);
    for (const Submesh& submesh : submeshes) {
        const auto part = std::span(state.all).subspan(submesh.first, submesh.count);
        if (submesh.topology == Topology::triangles) corners.insert(corners.end(), part.begin(), part.end());
    }
    state.thresholds = find_triangle_thresholds(*state.collapse, corners);
    for (const std::uint32_t threshold : state.thresholds)
        ++state.counts[std::max(threshold + 1, state.collapse->base) - state.collapse->base];
    std::partial_sum(state.counts.begin(), state.counts.end(), state.counts.begin());
}

/// A level is a row of the file's table, or a fraction between two of them; 0: full detail. Beyond the table, down to
/// base.
std::uint32_t Lod::vertices_at(std::uint32_t mesh, double level) const {
    const MeshCollapseView& collapse = *meshes_[mesh].collapse;
    const CollapseView& table = *model_.collapse();
    const auto row = [&](std::uint32_t at) {
        if (at == 0) return collapse.vertices;
        return at <= table.levels ? table.alive(at - 1, place_[mesh]) : collapse.base;
    };
    const double whole = std::floor(level);
    const auto before = static_cast<std::uint32_t>(whole);
    const double from = row(before);
    const double to = row(std::min(before, table.levels) + 1);
    auto vertices = static_cast<std::uint32_t>(std::lround(from + (level - whole) * (to - from)));
    vertices = std::clamp(vertices, collapse.base, collapse.vertices);
    // Vertices that belong together are not separated.
    while (vertices > collapse.base && vertices < collapse.vertices && collapse.is_joined(vertices)) ++vertices;
    return vertices;
}

std::uint64_t Lod::triangles_at(double level) const {
    std::uint64_t triangles = fixed_triangles_;
    for (std::uint32_t number = 0; number < meshes_.size(); ++number) {
        const MeshLevel& mesh = meshes_[number];
        if (mesh.collapse != nullptr) triangles += mesh.counts[vertices_at(number, level) - mesh.collapse->base];
    }
    return triangles;
}

void Lod::set_share(float triangles) {
    double level = 0.0;
    const CollapseView* collapse = model_.collapse();
    if (collapse != nullptr && !std::isnan(triangles) && triangles < 1.0f) {
        // Triangles decrease as the level rises: finds the first level that does not exceed the wanted number.
        const double wanted = std::max(triangles, 0.0f) * static_cast<double>(all_triangles_);
        double low = 0.0;
        double high = collapse->levels + 1.0;
        constexpr int kSteps = 40;  // finer than any number of vertices
        for (int step = 0; step < kSteps; ++step) {
            const double middle = 0.5 * (low + high);
            (static_cast<double>(triangles_at(middle)) > wanted ? low : high) = middle;
        }
        level = high;
    }
    triangles_ = fixed_triangles_;
    for (std::uint32_t number = 0; number < meshes_.size(); ++number) {
        MeshLevel& mesh = meshes_[number];
        if (mesh.collapse == nullptr) continue;
        mesh.vertices = vertices_at(number, level);
        triangles_ += mesh.counts[mesh.vertices - mesh.collapse->base];
    }
    error_ = 0.0f;
    if (collapse != nullptr && collapse->levels != 0 && level > 0.0) {
        const auto row = static_cast<std::uint32_t>(std::ceil(level));
        error_ = collapse->error(std::min(row, collapse->levels) - 1);
    }
    for (std::uint32_t number = 0; number < meshes_.size(); ++number) {
        if (meshes_[number].collapse != nullptr) make_list(number);
    }
}

/// Builds the index list and the submeshes of a mesh for its number of vertices.
void Lod::make_list(std::uint32_t mesh) {
    MeshLevel& state = meshes_[mesh];
    const MeshCollapseView& collapse = *state.collapse;
    const std::uint32_t alive = state.vertices;
    const std::span<const Submesh> draws = model_.submeshes();
    for (std::uint32_t v = collapse.base; v < alive; ++v) state.now[v] = v;
    for (std::uint32_t v = alive; v < collapse.vertices; ++v)
        state.now[v] = state.now[state.targets[v - collapse.base]];

    std::uint32_t* out = state.indices.data();
    const std::uint32_t* threshold = state.thresholds.data();
    for (std::uint32_t k = first_submesh_[mesh]; k < first_submesh_[mesh + 1]; ++k) {
        const Submesh& source = draws[k];
        Submesh& submesh = submeshes_[k];
        submesh.first = static_cast<std::uint32_t>(out - state.indices.data());
        const std::uint32_t end = source.first + source.count;
        if (source.topology == Topology::triangles) {
            for (std::uint32_t at = source.first; at < end; at += 3, ++threshold) {
                if (*threshold >= alive && *threshold != 0) continue;
                *out++ = state.now[state.all[at]];
                *out++ = state.now[state.all[at + 1]];
                *out++ = state.now[state.all[at + 2]];
            }
        } else {
            for (std::uint32_t at = source.first; at < end; ++at) *out++ = state.now[state.all[at]];
        }
        submesh.count = static_cast<std::uint32_t>(out - state.indices.data()) - submesh.first;
    }
    state.corners = static_cast<std::size_t>(out - state.indices.data());
}

}  // namespace bendy
