#include <bendy/runtime/lod.h>

namespace bendy {

Lod::Lod(const Model& model) : model_(&model), pools_(model.pools().size()) {
    for (std::uint32_t pool = 0; pool < pools_.size(); ++pool) {
        const Pool& source = model.pools()[pool];
        PoolLevel& level = pools_[pool];
        level.vertices = source.vertices;
        if (!source.indices) continue;
        level.indices.resize(source.indices->elements);
        for (std::uint32_t k = 0; k < source.indices->elements; ++k) level.indices[k] = source.indices->index(k, 0);
    }
    set_share(1.0f);
}

void Lod::set_share(float /*triangles*/) {
    draws_.assign(model_->draws().begin(), model_->draws().end());
    triangles_ = 0;
    for (const Draw& draw : draws_) triangles_ += draw.topology == Topology::triangles ? draw.count / 3 : 0;
}

}  // namespace bendy
