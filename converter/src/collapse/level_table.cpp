#include "collapse/level_table.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace bendy::converter {
namespace {

constexpr std::size_t kMostLevels = 32;
constexpr double kStep = 0.9;  // of the vertices that can go, so many are left at the next level

struct Move {
    float error;
    std::uint32_t mesh;
    bool is_joined;
};

}  // namespace

std::vector<LodLevel> make_levels(std::span<const Mesh> meshes, std::span<const Sequence> sequences) {
    std::vector<Move> moves;
    for (std::uint32_t mesh = 0; mesh < sequences.size(); ++mesh) {
        for (const VertexMove& move : sequences[mesh].moves) moves.push_back({move.error, mesh, move.is_joined});
    }
    if (moves.empty()) return {};
    std::stable_sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) { return a.error < b.error; });
    LodLevel level;
    for (const Mesh& mesh : meshes) level.alive.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    std::vector<LodLevel> levels{level};
    double next = kStep * static_cast<double>(moves.size());
    for (std::size_t done = 0; done < moves.size();) {
        level.error = moves[done].error;
        --level.alive[moves[done].mesh];
        const std::size_t left = moves.size() - ++done;
        const bool is_last = left == 0;
        if (!is_last && moves[done].is_joined) continue;
        if (!is_last && (static_cast<double>(left) > next || levels.size() + 1 >= kMostLevels)) continue;
        next = kStep * static_cast<double>(left);
        levels.push_back(level);
    }
    return levels;
}

}  // namespace bendy::converter
