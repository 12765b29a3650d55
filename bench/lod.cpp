// bendy_bench_lod FILE.glb...: the distance of simplified characters from the full ones, compared with meshoptimizer's
// simplifier at the same triangle counts. It is the two-sided Hausdorff distance, sampled at every vertex and at 20,000
// points spread by area on either surface, at rest and in three poses of the clips.

#include "optimise/collapse/distances.h"

#include <bendy/converter/convert.h>
#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace {

using bendy::converter::closest_point;
using Indices = std::vector<std::uint32_t>;

constexpr std::size_t kSamples = 20'000;

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A tree of boxes around triangles: finds the distance of a point from the nearest triangle.
class Surface {
public:
    Surface(std::span<const glm::vec3> places, const Indices& indices) : places_(places), indices_(indices) {
        order_.resize(indices.size() / 3);
        std::iota(order_.begin(), order_.end(), 0u);
        if (!order_.empty()) build();
    }

    [[nodiscard]] float distance_squared(const glm::vec3& p, float best) const {
        struct Far {
            std::uint32_t node;
            float distance;
        };
        std::array<Far, 64> open;  // one for each halving of fewer than 2^32 triangles
        std::size_t waiting = 0;
        if (!nodes_.empty()) open[waiting++] = {0, 0.0f};
        while (waiting != 0) {
            const Far next = open[--waiting];
            if (next.distance >= best) continue;
            const Node& node = nodes_[next.node];
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                const std::uint32_t t = order_[i];
                best = std::min(best, closest_point(p, corner(t, 0), corner(t, 1), corner(t, 2)).distance_squared);
            }
            if (node.count != 0) continue;
            const Far left{node.left, box_distance(nodes_[node.left], p)};
            const Far right{node.right, box_distance(nodes_[node.right], p)};
            const bool is_left_first = left.distance <= right.distance;
            open[waiting++] = is_left_first ? right : left;
            open[waiting++] = is_left_first ? left : right;
        }
        return best;
    }

    /// Returns every used vertex, and points spread by area.
    [[nodiscard]] std::vector<glm::vec3> samples() const {
        std::vector<glm::vec3> list;
        std::vector<bool> is_used(places_.size());
        for (const std::uint32_t vertex : indices_) {
            if (!is_used[vertex]) list.push_back(places_[vertex]);
            is_used[vertex] = true;
        }
        double whole = 0.0;
        for (std::uint32_t t = 0; t < order_.size(); ++t) whole += area(t);
        double owed = 0.0;
        float u = 0.5f;
        float v = 0.5f;
        for (std::uint32_t t = 0; t < order_.size(); ++t) {
            owed += kSamples * area(t) / whole;
            while (owed >= 1.0) {
                owed -= 1.0;
                u = std::fmod(u + 0.7548776662f, 1.0f);
                v = std::fmod(v + 0.5698402909f, 1.0f);
                const float x = u + v > 1.0f ? 1.0f - u : u;
                const float y = u + v > 1.0f ? 1.0f - v : v;
                list.push_back((1.0f - x - y) * corner(t, 0) + x * corner(t, 1) + y * corner(t, 2));
            }
        }
        return list;
    }

private:
    struct Node {
        glm::vec3 low, high;
        std::uint32_t first, count;  // of a leaf
        std::uint32_t left = 0, right = 0;
    };

    [[nodiscard]] const glm::vec3& corner(std::uint32_t t, std::uint32_t k) const {
        return places_[indices_[std::size_t{t} * 3 + k]];
    }
    [[nodiscard]] double area(std::uint32_t t) const {
        return 0.5 * glm::length(glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
    }
    [[nodiscard]] glm::vec3 centre(std::uint32_t t) const { return corner(t, 0) + corner(t, 1) + corner(t, 2); }

    /// Halves the triangles until few are left; the depth is the logarithm of their number.
    void build() {
        struct Range {
            std::uint32_t first, count, parent;
        };
        std::vector<Range> open{{0, static_cast<std::uint32_t>(order_.size()), 0}};
        while (!open.empty()) {
            const auto [first, count, parent] = open.back();
            open.pop_back();
            const auto number = static_cast<std::uint32_t>(nodes_.size());
            if (number != 0) (nodes_[parent].left == 0 ? nodes_[parent].left : nodes_[parent].right) = number;
            const Node node = around(first, count);
            nodes_.push_back(node);
            if (count <= 4) continue;
            nodes_.back().count = 0;
            const glm::vec3 size = node.high - node.low;
            const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
            const auto begin = order_.begin() + first;
            std::nth_element(begin, begin + count / 2, begin + count,
                             [&](std::uint32_t a, std::uint32_t b) { return centre(a)[axis] < centre(b)[axis]; });
            open.push_back({first + count / 2, count - count / 2, number});
            open.push_back({first, count / 2, number});
        }
    }

    [[nodiscard]] Node around(std::uint32_t first, std::uint32_t count) const {
        Node node{glm::vec3(std::numeric_limits<float>::max()), glm::vec3(std::numeric_limits<float>::lowest()), first,
                  count};
        for (std::uint32_t i = first; i < first + count; ++i) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                node.low = glm::min(node.low, corner(order_[i], k));
                node.high = glm::max(node.high, corner(order_[i], k));
            }
        }
        return node;
    }

    [[nodiscard]] float box_distance(const Node& node, const glm::vec3& p) const {
        const glm::vec3 out = glm::max(glm::max(node.low - p, p - node.high), glm::vec3(0.0f));
        return glm::dot(out, out);
    }

    std::span<const glm::vec3> places_;
    const Indices& indices_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

float one_sided(const Surface& from, const Surface& to) {
    float worst = 0.0f;
    for (const glm::vec3& p : from.samples())
        worst = std::max(worst, to.distance_squared(p, std::numeric_limits<float>::max()));
    return std::sqrt(worst);
}

float hausdorff(std::span<const glm::vec3> places, const Indices& a, const Indices& b) {
    const Surface first(places, a);
    const Surface second(places, b);
    return std::max(one_sided(first, second), one_sided(second, first));
}

/// Returns the triangles of a level, as indices into the vertices of all meshes together.
Indices triangles_of(const bendy::Model& model, const bendy::Lod& lod) {
    Indices list;
    for (const bendy::Submesh& submesh : lod.submeshes()) {
        if (submesh.topology != bendy::Topology::triangles) continue;
        for (std::uint32_t k = 0; k < submesh.count; ++k) {
            list.push_back(lod.indices(submesh.mesh)[submesh.first + k] +
                           static_cast<std::uint32_t>(model.first_vertex(submesh.mesh)));
        }
    }
    return list;
}

/// A mesh without duplicate vertices.
struct Welded {
    Indices indices;
    std::vector<glm::vec3> places;
    std::vector<std::uint32_t> vertices;  // their numbers in the mesh
};

/// Merges vertices for meshoptimizer: those equal in every attribute, or if `by_place`, in position.
Welded weld(const bendy::Mesh& mesh, const Indices& indices, std::span<const glm::vec3> places, bool by_place) {
    std::vector<float> numbers;
    std::size_t width = 3;
    for (std::uint32_t v = 0; v < mesh.vertices; ++v) {
        const std::size_t before = numbers.size();
        numbers.insert(numbers.end(), {places[v].x, places[v].y, places[v].z});
        const auto add = [&](const bendy::StreamView& stream) {
            for (std::uint32_t k = 0; k < stream.components; ++k) numbers.push_back(stream.number(v, k));
        };
        if (!by_place) {
            if (mesh.normals) add(*mesh.normals);
            for (const auto& stream : mesh.texture_coords) add(stream);
            for (const auto& stream : mesh.colours) add(stream);
        }
        width = numbers.size() - before;
    }
    std::vector<std::uint32_t> remap(mesh.vertices);
    const std::size_t unique = meshopt_generateVertexRemap(remap.data(), indices.data(), indices.size(), numbers.data(),
                                                           mesh.vertices, width * sizeof(float));
    std::vector<std::uint32_t> first(unique, bendy::kNone);
    for (std::uint32_t v = 0; v < mesh.vertices; ++v) {
        if (remap[v] != bendy::kNone && first[remap[v]] == bendy::kNone) first[remap[v]] = v;
    }
    Welded welded;
    for (const std::uint32_t v : indices) welded.indices.push_back(remap[v]);
    for (const std::uint32_t v : first) welded.places.push_back(places[v]);
    welded.vertices = std::move(first);
    return welded;
}

/// Simplifies each mesh separately with meshoptimizer, to `share` of its triangles.
Indices simplify(const bendy::Model& model, const bendy::Lod& full, float share) {
    Indices list;
    for (std::uint32_t mesh = 0; mesh < model.meshes().size(); ++mesh) {
        Indices indices;
        for (const bendy::Submesh& submesh : full.submeshes()) {
            if (submesh.topology != bendy::Topology::triangles || submesh.mesh != mesh) continue;
            const auto part = full.indices(mesh).subspan(submesh.first, submesh.count);
            indices.insert(indices.end(), part.begin(), part.end());
        }
        if (indices.empty()) continue;
        const auto goal = static_cast<std::size_t>(share * static_cast<float>(indices.size()) / 3.0f) * 3;
        // Rest positions, because rounding in a pose would separate vertices that have the same position.
        const auto places =
            bendy::view_at<glm::vec3>(model.meshes()[mesh].positions.data, 0, model.meshes()[mesh].vertices);
        Indices out;
        for (const bool by_place : {false, true}) {
            const Welded welded = weld(model.meshes()[mesh], indices, places, by_place);
            Indices attempt(indices.size());
            attempt.resize(meshopt_simplify(attempt.data(), welded.indices.data(), welded.indices.size(),
                                            &welded.places.front().x, welded.places.size(), sizeof(glm::vec3), goal,
                                            1e6f, 0, nullptr));
            for (std::uint32_t& vertex : attempt) vertex = welded.vertices[vertex];
            if (by_place && attempt.size() >= out.size()) break;
            out = std::move(attempt);
            if (out.size() <= goal + goal / 10) break;
        }
        for (const std::uint32_t vertex : out)
            list.push_back(vertex + static_cast<std::uint32_t>(model.first_vertex(mesh)));
    }
    return list;
}

std::vector<std::vector<glm::vec3>> make_poses(const bendy::Model& model) {
    std::vector<std::vector<glm::vec3>> shapes;
    bendy::Pose pose(model);
    const auto add = [&] {
        std::vector<glm::vec3> places(model.vertex_count());
        (void)bendy::skin(pose, {.out = {.positions = places}});
        shapes.push_back(std::move(places));
    };
    add();
    const auto clips = model.clips();
    for (std::size_t k = 0; k < 3 && !clips.empty(); ++k) {
        const bendy::Clip& clip = clips[k * (clips.size() - 1) / 2];
        const float share = 0.25f * static_cast<float>(k + 1);
        pose.set_rest();
        (void)bendy::sample(pose, &clip, clip.start + share * (clip.end - clip.start));
        add();
    }
    return shapes;
}

float extent_of(std::span<const glm::vec3> places) {
    glm::vec3 low = places.front();
    glm::vec3 high = low;
    for (const glm::vec3& p : places) low = glm::min(low, p), high = glm::max(high, p);
    return glm::length(high - low);
}

double switching_time(bendy::Lod& lod) {
    constexpr int kTimes = 10;
    double worst = 0.0;  // over the levels, of the best time of each, to exclude disturbance by other programs
    for (int level = 1; level < 9; ++level) {
        double best = 1e9;
        for (int i = 0; i < kTimes; ++i) {
            lod.set_share(1.0f);
            const double start = seconds();
            lod.set_share(static_cast<float>(level) / 9.0f);
            best = std::min(best, seconds() - start);
        }
        worst = std::max(worst, best);
    }
    return worst;
}

void measure(const char* path) {
    bendy::converter::ConvertOptions options;
    options.lod = true;
    bendy::converter::Report report;
    const std::clock_t start = std::clock();
    const auto bytes = bendy::converter::convert(path, options, report);
    const double taken = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    if (!bytes) {
        std::fprintf(stderr, "%s: %s\n", path, bytes.error().message.c_str());
        return;
    }
    const auto model = bendy::Model::from_memory(*bytes);
    if (!model || model->vertex_count() == 0) return;
    bendy::Lod lod(*model);
    const std::vector<std::vector<glm::vec3>> shapes = make_poses(*model);
    const float extent = extent_of(shapes[0]);
    const Indices full = triangles_of(*model, lod);
    if (full.empty()) return;
    lod.set_share(0.0f);
    const std::uint64_t fewest = lod.triangles();
    const std::string name = std::filesystem::path(path).stem().string();
    std::printf("| %s | %zu | %.2f s of processor, at least %llu, switch %.3f ms per 100,000 | | | | | |\n",
                name.c_str(), full.size() / 3, taken, static_cast<unsigned long long>(fewest),
                1e3 * switching_time(lod) * 1e5 / (static_cast<double>(full.size()) / 3.0));
    for (const float share : {0.5f, 0.25f, 0.1f}) {
        lod.set_share(1.0f);
        const Indices theirs = simplify(*model, lod, share);
        lod.set_share(static_cast<float>(theirs.size()) / static_cast<float>(full.size()));
        const Indices ours = triangles_of(*model, lod);
        std::printf("| | %.0f %% | %zu / %zu |", 100.0 * share, ours.size() / 3, theirs.size() / 3);
        for (const auto& places : shapes) {
            const float a = hausdorff(places, full, ours);
            const float b = hausdorff(places, full, theirs);
            std::printf(" %.2f / %.2f %% = %.2f |", 100.0 * a / extent, 100.0 * b / extent, a / b);
        }
        std::printf("\n");
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    std::printf(
        "| model | triangles | ours / theirs | at rest | pose 1 | pose 2 | pose 3 |\n|---|---|---|---|---|---|---|\n");
    for (int i = 1; i < argc; ++i) measure(argv[i]);
    return argc > 1 ? 0 : 2;
}
