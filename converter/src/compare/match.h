#pragma once

#include "collapse/find_shapes.h"

#include <bendy/converter/scene.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace bendy::converter {

/// Which things of two lists are the same by name; of several with one name the first is the first.
struct MatchedNames {
    std::vector<std::uint32_t> b_of;  ///< of each of A's; kNone: has none
    std::vector<std::uint32_t> a_of;  ///< of each of B's
};

MatchedNames match_names(std::span<const std::string> a, std::span<const std::string> b);

/// What is left then goes together in order: things that were renamed, or have lost their names.
void match_the_rest(MatchedNames& names);

/// Joints: by name under parents that go together.
MatchedNames match_joints(std::span<const Joint> a, std::span<const Joint> b);

/// What is seen of the vertices of two meshes besides their places: the streams that both have.
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
        double allowed = 0.0;  ///< degrees of directions, differences of numbers
    };

    Looks(const Mesh& a, const Mesh& b);

    [[nodiscard]] const std::vector<Paired>& streams() const { return streams_; }
    /// Names of streams that only one of the meshes has.
    [[nodiscard]] const std::vector<std::string>& only_in_a() const { return only_in_a_; }
    [[nodiscard]] const std::vector<std::string>& only_in_b() const { return only_in_b_; }

    /// How far apart two vertices are in a stream, in the unit of `allowed`; 180 where a handedness differs.
    static double apart(const Paired& stream, std::uint32_t a, std::uint32_t b);

    /// The sum over all streams of how far apart two vertices are, what is allowed being 1.
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

/// Which polygons of two meshes are the same.
struct MatchedPolygons {
    struct Corner {
        std::uint32_t a, b;  ///< vertices
        friend bool operator==(const Corner& x, const Corner& y) { return x.a == y.a && x.b == y.b; }
        friend bool operator<(const Corner& x, const Corner& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; }
    };
    std::vector<Corner> corners;  ///< of all pairs, each once, sorted
    std::vector<Polygon> only_in_a, only_in_b;
    bool gave_up = false;  ///< too many lie within the tolerance of one another
};

/// Pairs polygons of the same material one to one, whatever their order and their vertices: those whose corners lie
/// together in all shapes, at best within the tolerance, the more alike the better. Where several lie within it, as
/// many as possible get a partner. What is left then is paired with what rests at the same place, or else is nearest,
/// up to a tenth of the mesh's extent away; what has no partner at all is named, but for polygons that are smaller than
/// the tolerance. \param shapes_a     as find_shapes has them, for both meshes on the same skeleton: more of one are
/// left aside \param material_of  A's number of each of B's materials; kNone: A has none like it
MatchedPolygons match_polygons(const Mesh& a, const Mesh& b, std::span<const Shape> shapes_a,
                               std::span<const Shape> shapes_b, std::span<const std::uint32_t> material_of,
                               const Looks& looks, double tolerance);

}  // namespace bendy::converter
