#include "collapse/samples.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bendy::converter {
namespace {

// How far, in extents of the mesh, a point may be off before it is as bad as another normal, colour or coordinate.
constexpr float kNormal = 0.0015f;  // a normal that differs by 1
constexpr float kColour = 0.005f;   // a colour that differs by 1
constexpr float kSlide = 0.02f;     // a texture that slides by 1 extent
constexpr std::size_t kMostCoords = 2;
constexpr std::size_t kMostColours = 1;
/// A mesh with fewer vertices gets further samples, up to so many in all.
constexpr std::size_t kFewestSamples = 6000;

float area_of(std::span<const glm::vec3> places, const std::array<std::uint32_t, 3>& v) {
    return 0.5f * glm::length(glm::cross(places[v[1]] - places[v[0]], places[v[2]] - places[v[0]]));
}

/// Extents of the mesh per unit of texture coordinates, on average.
float texture_scale(const Surface& surface, std::span<const glm::vec3> shape, const Stream& stream) {
    double surface_area = 0.0;
    double texture_area = 0.0;
    const auto coords = [&](std::uint32_t v) {
        return glm::vec2(stream.values[std::size_t{v} * 2], stream.values[std::size_t{v} * 2 + 1]);
    };
    for (const Surface::Triangle& triangle : surface.triangles) {
        surface_area += area_of(shape, triangle.vertices);
        const glm::vec2 a = coords(triangle.vertices[1]) - coords(triangle.vertices[0]);
        const glm::vec2 b = coords(triangle.vertices[2]) - coords(triangle.vertices[0]);
        texture_area += 0.5f * std::abs(a.x * b.y - a.y * b.x);
    }
    const double scale = std::sqrt(surface_area / texture_area);
    return std::isfinite(scale) ? static_cast<float>(scale) : 0.0f;
}

class Sampler {
public:
    Sampler(const Surface& surface, std::span<const std::vector<glm::vec3>> places, const Appearance& appearance)
        : surface_(surface), places_(places), appearance_(appearance), samples_(places.size()) {
        samples_.places.reserve(std::max<std::size_t>(surface.points(), kFewestSamples));
        samples_.components = appearance.components;
        samples_.first.assign(surface.triangles.size(), kNone);
    }

    Samples run() {
        add_vertices();
        add_inner();
        return std::move(samples_);
    }

private:
    void add(std::uint32_t triangle, const glm::vec3& weights) {
        const auto& v = surface_.triangles[triangle].vertices;
        samples_.places.add([&](std::size_t s) {
            return weights.x * places_[s][v[0]] + weights.y * places_[s][v[1]] + weights.z * places_[s][v[2]];
        });
        for (std::uint32_t k = 0; k < appearance_.components; ++k) {
            samples_.appearance.push_back(weights.x * appearance_.of(v[0])[k] + weights.y * appearance_.of(v[1])[k] +
                                          weights.z * appearance_.of(v[2])[k]);
        }
        samples_.next.push_back(kNone);
        samples_.hold(triangle, static_cast<std::uint32_t>(samples_.next.size() - 1));
    }

    void add_vertices() {
        std::vector<bool> is_done(surface_.points());
        for (std::uint32_t triangle = 0; triangle < surface_.triangles.size(); ++triangle) {
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t point = surface_.triangles[triangle].points[static_cast<std::size_t>(k)];
                if (is_done[point]) continue;
                is_done[point] = true;
                glm::vec3 weights(0.0f);
                weights[k] = 1.0f;
                add(triangle, weights);
            }
        }
    }

    void add_inner() {
        const std::size_t done = samples_.next.size();
        if (done >= kFewestSamples) return;
        double whole = 0.0;
        for (const Surface::Triangle& triangle : surface_.triangles) whole += area_of(places_[0], triangle.vertices);
        if (!(whole > 0.0)) return;
        const double per_area = static_cast<double>(kFewestSamples - done) / whole;
        double owed = 0.0;
        float u = 0.5f;  // Roberts' R2 sequence: even, and the same in each run
        float v = 0.5f;
        for (std::uint32_t triangle = 0; triangle < surface_.triangles.size(); ++triangle) {
            owed += per_area * area_of(places_[0], surface_.triangles[triangle].vertices);
            while (owed >= 1.0) {
                owed -= 1.0;
                u += 0.7548776662f;
                v += 0.5698402909f;
                u -= u >= 1.0f ? 1.0f : 0.0f;
                v -= v >= 1.0f ? 1.0f : 0.0f;
                const bool folds = u + v > 1.0f;
                const float x = folds ? 1.0f - u : u;
                const float y = folds ? 1.0f - v : v;
                add(triangle, {1.0f - x - y, x, y});
            }
        }
    }

    const Surface& surface_;
    std::span<const std::vector<glm::vec3>> places_;
    const Appearance& appearance_;
    Samples samples_;
};

}  // namespace

Appearance make_appearance(const Mesh& mesh, const Surface& surface, std::span<const glm::vec3> shape) {
    struct Source {
        const float* values;
        std::uint32_t components;
        float scale;
    };
    std::vector<Source> sources;
    if (!mesh.normals.empty()) sources.push_back({&mesh.normals.front().x, 3, kNormal});
    for (std::size_t k = 0; k < std::min(mesh.texture_coords.size(), kMostCoords); ++k) {
        const Stream& stream = mesh.texture_coords[k];
        if (stream.components != 2 || stream.values.empty()) continue;
        sources.push_back({stream.values.data(), 2, kSlide * texture_scale(surface, shape, stream)});
    }
    for (std::size_t k = 0; k < std::min(mesh.colours.size(), kMostColours); ++k) {
        if (mesh.colours[k].values.empty()) continue;
        sources.push_back({mesh.colours[k].values.data(), mesh.colours[k].components, kColour});
    }
    Appearance appearance;
    for (const Source& source : sources) appearance.components += source.components;
    appearance.values.reserve(std::size_t{appearance.components} * mesh.positions.size());
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        for (const Source& source : sources) {
            for (std::uint32_t k = 0; k < source.components; ++k)
                appearance.values.push_back(source.scale * source.values[vertex * source.components + k]);
        }
    }
    return appearance;
}

Samples make_samples(const Surface& surface, std::span<const std::vector<glm::vec3>> places,
                     const Appearance& appearance) {
    return Sampler(surface, places, appearance).run();
}

}  // namespace bendy::converter
