#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace bendy::converter {

/// Four floats that are reckoned with at once: an extension that GCC and clang share. Each lane rounds as a float does.
using FourFloats = float __attribute__((vector_size(16)));
inline constexpr std::size_t kFour = 4;

/// Places of points in several shapes, those of one point beside one another: first at rest, then in the other shapes,
/// by axis, so that four shapes are looked at together. What is beyond the last shape repeats the rest.
class ShapedPlaces {
public:
    explicit ShapedPlaces(std::size_t shapes) : posed_(shapes - 1), lanes_((posed_ + kFour - 1) / kFour * kFour) {}

    /// How many shapes there are besides the rest, in fours; and with their padding.
    [[nodiscard]] std::size_t fours() const { return lanes_ / kFour; }
    [[nodiscard]] std::size_t lanes() const { return lanes_; }

    void reserve(std::size_t points) { floats_.reserve(points * stride()); }

    /// \param place_in gives the place in a shape by its number; 0: at rest
    template <class PlaceIn>
    void add(const PlaceIn& place_in) {
        const glm::vec3 rest = place_in(std::size_t{0});
        const std::size_t first = floats_.size();
        floats_.resize(first + stride());
        for (int axis = 0; axis < 3; ++axis) floats_[first + static_cast<std::size_t>(axis)] = rest[axis];
        for (std::size_t s = 0; s < lanes_; ++s) {
            const glm::vec3 place = s < posed_ ? place_in(s + 1) : rest;
            for (int axis = 0; axis < 3; ++axis)
                floats_[first + kFour + static_cast<std::size_t>(axis) * lanes_ + s] = place[axis];
        }
    }

    [[nodiscard]] glm::vec3 rest(std::size_t point) const {
        const float* at = floats_.data() + point * stride();
        return {at[0], at[1], at[2]};
    }
    /// In a shape; 0: at rest.
    [[nodiscard]] glm::vec3 place(std::size_t shape, std::size_t point) const {
        if (shape == 0) return rest(point);
        const float* at = posed(point) + shape - 1;
        return {at[0], at[lanes_], at[2 * lanes_]};
    }
    /// In the shapes besides the rest: `lanes` x, then y, then z.
    [[nodiscard]] const float* posed(std::size_t point) const { return floats_.data() + point * stride() + kFour; }

private:
    [[nodiscard]] std::size_t stride() const { return kFour + 3 * lanes_; }

    std::size_t posed_;
    std::size_t lanes_;
    std::vector<float> floats_;
};

}  // namespace bendy::converter
