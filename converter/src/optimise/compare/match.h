#pragma once

#include "optimise/collapse/find_shapes.h"

#include <bendy/converter/scene.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace bendy::converter {

/// Matches the items of two lists by name; duplicates of a name are matched in order.
struct MatchedNames {
    std::vector<std::uint32_t> b_of;  ///< per item of A; kNone: no match
    std::vector<std::uint32_t> a_of;  ///< per item of B
};

MatchedNames match_names(std::span<const std::string> a, std::span<const std::string> b);

/// Matches the remaining items in order: those that were renamed, or lost their names.
void match_the_rest(MatchedNames& names);

/// Matches joints by name, under matched parents.
MatchedNames match_joints(std::span<const Joint> a, std::span<const Joint> b);

/// Compares the looks of the vertices of two meshes: the streams, besides positions, that both have.
class Looks {
public:
    enum class Kind : std::uint8_t { direction, tangent, numbers };
    struct Paired {
        std::string name;  ///< "normals", "texture coordinates 0"
        Kind kind = Kind::numbers;
        std::uint32_t components = 3;
        const float* a = nullptr;
        const float* b = nullptr;
        std::uint32_t a_stride = 3;
        std::uint32_t b_stride = 3;
        double allowed = 0.0;  ///< degrees for directions, else a difference of numbers
    };

    Looks(const Mesh& a, const Mesh& b);

    [[nodiscard]] const std::vector<Paired>& streams() const { return streams_; }
    /// Names of streams that only one of the meshes has.
    [[nodiscard]] const std::vector<std::string>& only_in_a() const { return only_in_a_; }
    [[nodiscard]] const std::vector<std::string>& only_in_b() const { return only_in_b_; }

    /// How far apart two vertices are in a stream, in the unit of `allowed`; 180 if the handedness differs.
    static double apart(const Paired& stream, std::uint32_t a, std::uint32_t b);

    /// The sum over all streams of the distance between two vertices, relative to what is allowed.
    [[nodiscard]] double unlikeness(std::uint32_t a, std::uint32_t b) const;

private:
    void pair_streams(const std::string& kind, const std::vector<Stream>& a, const std::vector<Stream>& b,
                      double allowed);

    std::vector<Paired> streams_;
    std::vector<std::string> only_in_a_, only_in_b_;
};

struct Polygon {
    std::array<std::uint32_t, 3> vertices{};
    std::uint32_t corners = 3;  ///< 2: a line; 1: a point
    std::uint32_t material = kNone;
};

/// Matched polygons of two meshes.
struct MatchedPolygons {
    struct Corner {
        std::uint32_t a, b;  ///< vertices
        friend bool operator==(const Corner& x, const Corner& y) { return x.a == y.a && x.b == y.b; }
        friend bool operator<(const Corner& x, const Corner& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; }
    };
    std::vector<Corner> corners;  ///< of all matched polygons, each pair once, sorted
    std::vector<Polygon> only_in_a, only_in_b;
    bool gave_up = false;  ///< too many polygons lie within the tolerance of one another
};

/// Pairs polygons of the same material one to one, in any order and with any vertices. First those whose corners
/// coincide in all shapes within the tolerance, preferring the most alike; as many as possible get a partner. The rest
/// are paired with polygons at the same rest position, or else with the nearest, up to a tenth of the mesh's extent
/// away. Polygons without a partner are listed, unless they are smaller than the tolerance.
/// \param shapes_a     as find_shapes returns them, for both meshes on the same skeleton; surplus shapes of one are
///                     ignored
/// \param material_of  for each of B's materials, A's number; kNone: A has no such material
MatchedPolygons match_polygons(const Mesh& a, const Mesh& b, std::span<const Shape> shapes_a,
                               std::span<const Shape> shapes_b, std::span<const std::uint32_t> material_of,
                               const Looks& looks, double tolerance);

}  // namespace bendy::converter
