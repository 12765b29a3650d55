#include "quake_normals.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace bendy::converter::md2 {
namespace {

struct Face {
    std::array<glm::dvec3, 3> corners;
    int cuts = 0;  ///< that are left to be made
};

/// A regular icosahedron, as the books on OpenGL draw it.
std::vector<Face> icosahedron() {
    const double x = std::sqrt((5.0 - std::sqrt(5.0)) / 10.0);
    const double z = std::sqrt((5.0 + std::sqrt(5.0)) / 10.0);
    const std::array<glm::dvec3, 12> corners{{{-x, 0, z},
                                              {x, 0, z},
                                              {-x, 0, -z},
                                              {x, 0, -z},
                                              {0, z, x},
                                              {0, z, -x},
                                              {0, -z, x},
                                              {0, -z, -x},
                                              {z, x, 0},
                                              {-z, x, 0},
                                              {z, -x, 0},
                                              {-z, -x, 0}}};
    constexpr std::array<std::array<std::size_t, 3>, 20> kFaces{
        {{0, 4, 1}, {0, 9, 4},  {9, 5, 4},  {4, 5, 8},  {4, 8, 1},  {8, 10, 1}, {8, 3, 10},
         {5, 3, 8}, {5, 2, 3},  {2, 7, 3},  {7, 10, 3}, {7, 6, 10}, {7, 11, 6}, {11, 0, 6},
         {0, 1, 6}, {6, 1, 10}, {9, 0, 11}, {9, 11, 2}, {9, 2, 5},  {7, 2, 11}}};
    constexpr int kCuts = 2;
    std::vector<Face> faces;
    faces.reserve(kFaces.size());
    for (const auto& [a, b, c] : kFaces) faces.push_back({{corners[a], corners[b], corners[c]}, kCuts});
    return faces;
}

}  // namespace

std::vector<glm::vec3> quake_normals() {
    constexpr double kSame = 1e-9;
    std::vector<glm::dvec3> met;
    std::vector<Face> open = icosahedron();
    std::reverse(open.begin(), open.end());  // the last one is taken first
    while (!open.empty()) {
        const Face face = open.back();
        open.pop_back();
        const auto& [a, b, c] = face.corners;
        if (face.cuts == 0) {
            for (const glm::dvec3& corner : face.corners) {
                const auto is_same = [&](const glm::dvec3& other) { return glm::distance(corner, other) < kSame; };
                if (std::none_of(met.begin(), met.end(), is_same)) met.push_back(corner);
            }
            continue;
        }
        const glm::dvec3 ab = (a + b) * 0.5;
        const glm::dvec3 bc = (b + c) * 0.5;
        const glm::dvec3 ca = (c + a) * 0.5;
        const int cuts = face.cuts - 1;
        open.push_back({{ab, bc, ca}, cuts});
        open.push_back({{c, ca, bc}, cuts});
        open.push_back({{b, ab, bc}, cuts});
        open.push_back({{a, ab, ca}, cuts});
    }
    std::vector<glm::vec3> normals;
    normals.reserve(met.size());
    for (const glm::dvec3& corner : met) normals.emplace_back(glm::normalize(corner));
    return normals;
}

}  // namespace bendy::converter::md2
