#pragma once

#include "collapse/surface.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// A surface as it was before anything was collapsed, in every shape, to ask how far a place is from it. One tree of
/// boxes over the triangles, halved along the longest side at rest; each shape has its own boxes.
class Original {
public:
    /// \param places of the vertices, by shape; must outlive this
    Original(const Surface& surface, std::span<const std::vector<glm::vec3>> places);

    /// The squared distance of a place from the surface in a shape, if it is above `enough`; else anything up to
    /// `enough`. \param near a triangle, by its number in the surface, to begin with: the nearer, the sooner done;
    /// becomes the nearest that was met
    [[nodiscard]] float distance_squared(std::size_t shape, const glm::vec3& place, float enough,
                                         std::uint32_t& near) const;

private:
    struct Box {
        glm::vec3 low, high;
    };
    /// The nodes of a subtree follow one another: the left child is the next node.
    struct Node {
        std::uint32_t right = 0;
        std::uint32_t first = 0;
        std::uint32_t count = 0;  ///< of triangles in order_; 0: has children
    };

    [[nodiscard]] glm::vec3 centre(std::uint32_t triangle) const;
    void build();
    [[nodiscard]] int longest_side(std::uint32_t first, std::uint32_t count) const;
    void fit_boxes();

    std::span<const std::vector<glm::vec3>> places_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
    std::vector<std::vector<Box>> boxes_;  // by shape, then node
};

}  // namespace bendy::converter
