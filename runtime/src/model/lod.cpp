#include <bendy/runtime/lod.h>

#include "find_deaths.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bendy {

Lod::Lod(const Model& model) : model_(model), pools_(model.pools().size()), place_(model.pools().size(), kNone) {
    if (const CollapseView* collapse = model.collapse()) {
        for (std::uint32_t place = 0; place < collapse->pools.size(); ++place) {
            place_[collapse->pools[place].pool] = place;
            pools_[collapse->pools[place].pool].collapse = &collapse->pools[place];
        }
    }
    draws_.assign(model.draws().begin(), model.draws().end());
    first_draw_.assign(pools_.size() + 1, 0);
    for (const Draw& draw : draws_) ++first_draw_[draw.pool + std::size_t{1}];
    std::partial_sum(first_draw_.begin(), first_draw_.end(), first_draw_.begin());
    for (std::uint32_t pool = 0; pool < pools_.size(); ++pool) prepare(pool);
    for (const Draw& draw : model.draws()) {
        const std::uint64_t count = draw.topology == Topology::triangles ? draw.count / 3 : 0;
        all_triangles_ += count;
        if (place_[draw.pool] == kNone) fixed_triangles_ += count;
    }
    set_share(1.0f);
}

/// What a pool's levels are made of. Only the triangles that are drawn are counted.
void Lod::prepare(std::uint32_t pool) {
    const Pool& source = model_.pools()[pool];
    PoolLevel& state = pools_[pool];
    state.vertices = source.vertices;
    if (source.indices) {
        state.all.resize(source.indices->elements);
        for (std::uint32_t k = 0; k < state.all.size(); ++k) state.all[k] = source.indices->index(k, 0);
    }
    state.indices = state.all;
    state.corners = state.all.size();
    if (state.collapse == nullptr) return;
    state.now.resize(source.vertices);
    state.targets.reserve(source.vertices - state.collapse->base);
    for (std::uint32_t v = state.collapse->base; v < source.vertices; ++v)
        state.targets.push_back(state.collapse->target(v));
    std::iota(state.now.begin(), state.now.begin() + state.collapse->base, 0u);
    state.counts.assign(std::size_t{source.vertices} - state.collapse->base + 1, 0);
    std::vector<std::uint32_t> corners;
    const auto draws = model_.draws().subspan(first_draw_[pool], first_draw_[pool + 1] - first_draw_[pool]);
    for (const Draw& draw : draws) {
        const auto part = std::span(state.all).subspan(draw.first, draw.count);
        if (draw.topology == Topology::triangles) corners.insert(corners.end(), part.begin(), part.end());
    }
    state.deaths = find_deaths(*state.collapse, corners);
    for (const std::uint32_t death : state.deaths)
        ++state.counts[std::max(death + 1, state.collapse->base) - state.collapse->base];
    std::partial_sum(state.counts.begin(), state.counts.end(), state.counts.begin());
}

/// A level is a row of the file's table, or a number between two of them; 0 full detail. Past the table, down to base.
std::uint32_t Lod::vertices_at(std::uint32_t pool, double level) const {
    const PoolCollapseView& collapse = *pools_[pool].collapse;
    const CollapseView& table = *model_.collapse();
    const auto row = [&](std::uint32_t at) {
        if (at == 0) return collapse.vertices;
        return at <= table.levels ? table.alive(at - 1, place_[pool]) : collapse.base;
    };
    const double whole = std::floor(level);
    const auto before = static_cast<std::uint32_t>(whole);
    const double from = row(before);
    const double to = row(std::min(before, table.levels) + 1);
    auto vertices = static_cast<std::uint32_t>(std::lround(from + (level - whole) * (to - from)));
    vertices = std::clamp(vertices, collapse.base, collapse.vertices);
    // Those that go together are not parted.
    while (vertices > collapse.base && vertices < collapse.vertices && collapse.is_joined(vertices)) ++vertices;
    return vertices;
}

std::uint64_t Lod::triangles_at(double level) const {
    std::uint64_t triangles = fixed_triangles_;
    for (std::uint32_t number = 0; number < pools_.size(); ++number) {
        const PoolLevel& pool = pools_[number];
        if (pool.collapse != nullptr) triangles += pool.counts[vertices_at(number, level) - pool.collapse->base];
    }
    return triangles;
}

void Lod::set_share(float triangles) {
    double level = 0.0;
    const CollapseView* collapse = model_.collapse();
    if (collapse != nullptr && !std::isnan(triangles) && triangles < 1.0f) {
        // Fewer triangles as the level rises: the first level that is not above the wanted number.
        const double wanted = std::max(triangles, 0.0f) * static_cast<double>(all_triangles_);
        double low = 0.0;
        double high = collapse->levels + 1.0;
        constexpr int kSteps = 40;  // finer than any number of vertices
        for (int step = 0; step < kSteps; ++step) {
            const double middle = 0.5 * (low + high);
            (static_cast<double>(triangles_at(middle)) > wanted ? low : high) = middle;
        }
        level = high;
    }
    triangles_ = fixed_triangles_;
    for (std::uint32_t number = 0; number < pools_.size(); ++number) {
        PoolLevel& pool = pools_[number];
        if (pool.collapse == nullptr) continue;
        pool.vertices = vertices_at(number, level);
        triangles_ += pool.counts[pool.vertices - pool.collapse->base];
    }
    error_ = 0.0f;
    if (collapse != nullptr && collapse->levels != 0 && level > 0.0) {
        const auto row = static_cast<std::uint32_t>(std::ceil(level));
        error_ = collapse->error(std::min(row, collapse->levels) - 1);
    }
    for (std::uint32_t number = 0; number < pools_.size(); ++number) {
        if (pools_[number].collapse != nullptr) make_list(number);
    }
}

/// The index list and the draws of a pool at its number of vertices.
void Lod::make_list(std::uint32_t pool) {
    PoolLevel& state = pools_[pool];
    const PoolCollapseView& collapse = *state.collapse;
    const std::uint32_t alive = state.vertices;
    const std::span<const Draw> draws = model_.draws();
    for (std::uint32_t v = collapse.base; v < alive; ++v) state.now[v] = v;
    for (std::uint32_t v = alive; v < collapse.vertices; ++v)
        state.now[v] = state.now[state.targets[v - collapse.base]];

    std::uint32_t* out = state.indices.data();
    const std::uint32_t* death = state.deaths.data();
    for (std::uint32_t k = first_draw_[pool]; k < first_draw_[pool + 1]; ++k) {
        const Draw& source = draws[k];
        Draw& draw = draws_[k];
        draw.first = static_cast<std::uint32_t>(out - state.indices.data());
        const std::uint32_t end = source.first + source.count;
        if (source.topology == Topology::triangles) {
            for (std::uint32_t at = source.first; at < end; at += 3, ++death) {
                if (*death >= alive && *death != 0) continue;
                *out++ = state.now[state.all[at]];
                *out++ = state.now[state.all[at + 1]];
                *out++ = state.now[state.all[at + 2]];
            }
        } else {
            for (std::uint32_t at = source.first; at < end; ++at) *out++ = state.now[state.all[at]];
        }
        draw.count = static_cast<std::uint32_t>(out - state.indices.data()) - draw.first;
    }
    state.corners = static_cast<std::size_t>(out - state.indices.data());
}

}  // namespace bendy
