#pragma once

#include "optimise/collapse/deviation.h"
#include "optimise/collapse/distances.h"
#include "optimise/collapse/surface.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace bendy::converter {

/// The triangles around a vertex of a surface, and how they change when it collapses onto a neighbour.
class Fan {
public:
    struct Neighbour {
        std::uint32_t point;
        std::uint32_t before = 0;  ///< number of triangles in which the edge from the fan's point leads to it
        std::uint32_t after = 0;   ///< and in which it leads away from it
    };
    struct Move {  ///< for each vertex at a point
        std::uint32_t from, to;
    };

    /// All must outlive this.
    /// \param places  of the points
    Fan(Surface& surface, const ShapedPlaces& places, const Appearance& appearance);

    /// Finds the triangles at a point and its neighbours; false if the fan is not simple (non-manifold).
    bool find(std::uint32_t point);
    /// Computes the moves and the remaining triangles of the current fan; false if the point cannot move to the target.
    bool prepare(std::uint32_t point, std::uint32_t target);
    /// Performs the collapse: the remaining triangles become the target's.
    void move_to(std::uint32_t target);

    [[nodiscard]] const std::vector<std::uint32_t>& corners() const { return corners_; }
    [[nodiscard]] const std::vector<Neighbour>& neighbours() const { return neighbours_; }
    [[nodiscard]] const std::vector<Move>& moves() const { return moves_; }
    /// The remaining triangles of the fan, moved, with their numbers.
    [[nodiscard]] const std::vector<std::pair<std::uint32_t, Surface::Triangle>>& left() const { return left_; }
    [[nodiscard]] bool crosses_seam() const { return crosses_seam_; }
    /// The destination of a vertex; the vertex itself if it does not move.
    [[nodiscard]] std::uint32_t moved(std::uint32_t vertex) const {
        for (const Move& move : moves_) {
            if (move.from == surface_.alike[vertex]) return move.to;
        }
        return vertex;
    }

private:
    [[nodiscard]] glm::vec3 place(std::size_t shape, std::uint32_t point) const { return places_.place(shape, point); }
    [[nodiscard]] bool is_connected() const;
    [[nodiscard]] float apart(std::uint32_t a, std::uint32_t b) const;
    bool keeps_topology(std::uint32_t point, std::uint32_t target);
    bool find_moves(std::uint32_t target);
    bool add_move(const Move& move);
    [[nodiscard]] std::uint32_t most_alike(std::uint32_t vertex) const;
    bool find_left(std::uint32_t point, std::uint32_t target);
    [[nodiscard]] bool turns_over(const Surface::Triangle& before, const Surface::Triangle& after) const;

    Surface& surface_;
    const ShapedPlaces& places_;
    const Appearance& appearance_;
    std::vector<std::uint32_t> corner_count_;  ///< by point
    std::vector<std::uint32_t> corners_, target_corners_;
    std::vector<Neighbour> neighbours_;
    bool is_border_ = false;
    bool crosses_seam_ = false;
    std::vector<Move> moves_;
    std::vector<std::pair<std::uint32_t, Surface::Triangle>> left_;
    std::vector<std::uint32_t> marks_;  ///< by point
    std::uint32_t mark_ = 0;
};

}  // namespace bendy::converter
