#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <string>
#include <vector>

namespace bendy::converter {

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

}  // namespace bendy::converter
