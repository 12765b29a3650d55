#include "kept_vertices.h"

#include <algorithm>

namespace bendy::edit {
namespace {

/// Adds what vertices that stay collapse to; true if that adds any.
bool add_collapse_targets(const PoolCollapseView& collapse, std::vector<bool>& stays) {
    bool adds = false;
    for (std::uint32_t v = collapse.vertices; v-- > collapse.base;) {  // targets are below: one pass
        if (!stays[v] || stays[collapse.target(v)]) continue;
        stays[collapse.target(v)] = true;
        adds = true;
    }
    return adds;
}

}  // namespace

void keep_used_vertices(const ObjectView& object, Staying::Object& staying) {
    for (Staying::Pool& pool : staying.pools) pool.stays = false;
    for (const PolygonView& polygons : object.skeleton.polygons) {
        if (polygons.count == 0 || !staying.polygons[polygons.joint]) continue;
        const PoolView& pool = object.pools[polygons.pool];
        Staying::Pool& here = staying.pools[polygons.pool];
        here.stays = true;
        here.vertices.resize(pool.vertices, false);
        for (std::uint32_t k = 0; k < polygons.count; ++k)
            here.vertices[pool.indices->index(polygons.first + k, 0)] = true;
    }
    if (object.collapse) {
        for (const PoolCollapseView& collapse : object.collapse->pools) {
            Staying::Pool& here = staying.pools[collapse.pool];
            if (!here.stays) continue;
            const std::vector<bool> used = here.vertices;
            if (!add_collapse_targets(collapse, here.vertices) || !object.pools[collapse.pool].is_rigid()) continue;
            here.vertices = used;
            here.keeps_levels = false;
        }
    }
}

void keep_joints_of_vertices(const ObjectView& object, Staying::Object& staying) {
    for (std::size_t p = 0; p < object.pools.size(); ++p) {
        const PoolView& pool = object.pools[p];
        if (!staying.pools[p].stays || pool.is_rigid()) continue;
        const std::vector<bool>& vertices = staying.pools[p].vertices;
        for (std::uint32_t v = 0; v < vertices.size(); ++v) {
            if (!vertices[v]) continue;
            for (std::uint32_t k = 0; k < pool.bones->components; ++k) {
                if (pool.weights->number(v, k) != 0.0f)
                    staying.joints[pool.palette.joints[pool.bones->index(v, k)]] = true;
            }
        }
    }
}

}  // namespace bendy::edit
