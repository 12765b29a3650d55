#include "mend.h"

#include "cycle_tracks.h"
#include "renumber.h"

#include <bendy/edit/names.h>
#include <bendy/format/records.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <utility>

namespace bendy::edit {
namespace {

bool is_all(const std::vector<bool>& stays) {
    return std::find(stays.begin(), stays.end(), false) == stays.end();
}

class ObjectMender {
public:
    ObjectMender(const Source& source, const Staying& staying, std::size_t object, Rewrite& rewrite, Log& log)
        : tree_(source.tree),
          document_(source.document),
          object_(source.document.objects[object]),
          staying_(staying),
          here_(staying.objects[object]),
          materials_(renumbered(staying.materials)),
          textures_(renumbered(staying.textures)),
          rewrite_(rewrite),
          log_(log) {
        numbers_.joints = renumbered(here_.joints);
        numbers_.chains = renumbered(here_.chains);
        std::vector<bool> pools;
        for (const Staying::Pool& pool : here_.pools) {
            pools.push_back(pool.stays);
            numbers_.vertices.push_back(renumbered(pool.vertices));
        }
        numbers_.pools = renumbered(pools);
    }

    Result<void, Problem> mend() {
        find_index_runs();
        mend_skins();
        for (std::size_t k = 0; k < object_.chains.size(); ++k) {
            if (!here_.chains[k]) rewrite_.remove(object_.chains[k].chunk);
        }
        for (std::size_t p = 0; p < object_.pools.size(); ++p) {
            const PoolView& pool = object_.pools[p];
            if (here_.pools[p].stays) {
                mend_pool(tree_, pool, here_.pools[p], numbers_, numbers_.vertices[p], runs_[p], rewrite_);
            } else {
                rewrite_.remove(pool.chunk);
            }
        }
        if (object_.collapse) mend_collapse(*object_.collapse, here_, numbers_, rewrite_);
        renumber();
        return mend_cycles();
    }

private:
    [[nodiscard]] bool keeps(std::uint32_t joint, std::uint32_t pool) const {
        return here_.joints[joint] && here_.polygons[joint] && here_.pools[pool].stays;
    }

    /// Of the pools that lose vertices: the runs of their index lists that stay, and where they start from now on.
    void find_index_runs() {
        runs_.resize(object_.pools.size());
        for (const PolygonView& polygons : object_.skeleton.polygons) {
            if (polygons.count != 0 && keeps(polygons.joint, polygons.pool))
                runs_[polygons.pool].push_back({polygons.first, polygons.count});
        }
        for (std::size_t p = 0; p < runs_.size(); ++p) {
            std::sort(runs_[p].begin(), runs_[p].end(),
                      [](const IndexRun& a, const IndexRun& b) { return a.first < b.first; });
            std::uint32_t at = 0;
            for (const IndexRun& run : runs_[p]) {
                starts_[{p, run.first}] = at;
                at += run.count;
            }
        }
    }

    void mend_skins() {
        for (std::uint32_t j = 0; j < object_.skeleton.joints.size(); ++j) {
            const JointView& joint = object_.skeleton.joints[j];
            if (!here_.joints[j]) {
                if (joint.parent == kNone || here_.joints[joint.parent]) rewrite_.remove(joint.chunk);
                continue;
            }
            if (here_.polygons[j] && staying_.local_materials) continue;
            for (const std::uint32_t child : tree_.children(joint.chunk)) {
                if (tree_[child].id == FourCC("MATE")) rewrite_.remove(child);
            }
        }
    }

    /// What the references do not say: polygons go with a joint or a mesh, or stay and begin elsewhere in INDX.
    [[nodiscard]] bool mend_range(std::uint32_t chunk, const RecordLayout& layout, std::span<std::byte> record) const {
        const bool is_table_row = layout.name == "JointPolygons";
        if (!is_table_row && layout.name != "PolygonRecord") return true;
        const std::size_t at = is_table_row ? offsetof(JointPolygons, polygons) : 0;
        PolygonRecord range;
        std::memcpy(&range, record.data() + at, sizeof range);
        std::uint32_t joint = 0;
        if (is_table_row) {
            std::memcpy(&joint, record.data(), sizeof joint);
        } else {
            joint = owners_.at(chunk);
        }
        if (!keeps(joint, range.pool)) return false;
        if (numbers_.vertices[range.pool].empty()) return true;
        range.first = range.count == 0 ? 0 : starts_.at({range.pool, range.first});
        std::memcpy(record.data() + at, &range, sizeof range);
        return true;
    }

    void renumber() {
        for (const PolygonView& polygons : object_.skeleton.polygons)
            owners_.try_emplace(polygons.chunk, polygons.joint);
        NewNumbers numbers;
        numbers.of(Entity::joint) = numbers_.joints;
        numbers.of(Entity::chain) = numbers_.chains;
        numbers.of(Entity::mesh) = numbers_.pools;
        numbers.of(Entity::material) = materials_;
        numbers.of(Entity::texture) = textures_;
        numbers.own_materials = staying_.local_materials;
        renumber_leaves(
            tree_, object_.chunk, numbers,
            [this](std::uint32_t chunk, const RecordLayout& layout, std::span<std::byte> record) {
                return mend_range(chunk, layout, record);
            },
            [this](std::uint32_t chunk, const Renumbered& now) { tell(chunk, now); }, rewrite_);
    }

    [[nodiscard]] std::string_view name_of(const Lost& lost) const {
        switch (lost.entity) {
            case Entity::joint:
                return object_.skeleton.joints[lost.number].name;
            case Entity::mesh:
                return object_.pools[lost.number].name;
            case Entity::chain:
                return object_.chains[lost.number].name;
            case Entity::material:
                return document_.materials[lost.number].name;
            case Entity::texture:
                return document_.textures[lost.number].name;
            default:
                return {};
        }
    }

    /// What a chain loses, and which leaves go that have a name.
    void tell(std::uint32_t chunk, const Renumbered& now) {
        if (tree_[chunk].id == FourCC("KINF")) {
            const std::uint32_t name = tree_.find(tree_[chunk].parent, FourCC("NAME"));
            for (const Lost& lost : now.lost) {
                log_.warnings.push_back("chain \"" + std::string(name == kNone ? "" : as_text(tree_.payload(name))) +
                                        "\" loses its " + std::string(lost.field) + ", \"" +
                                        std::string(name_of(lost)) + '"');
            }
            return;
        }
        if (now.payload || now.lost.empty()) return;
        const std::string leaf = name_of_leaf(tree_, chunk);
        if (leaf.empty()) return;
        const Lost& lost = now.lost.back();
        log_.warnings.push_back(leaf + " goes with its " + std::string(bendy::name_of(lost.entity)) + ", \"" +
                                std::string(name_of(lost)) + '"');
    }

    [[nodiscard]] bool changes_tracks() const {
        if (!is_all(here_.joints)) return true;
        return std::any_of(here_.pools.begin(), here_.pools.end(),
                           [](const Staying::Pool& pool) { return !pool.stays || !is_all(pool.targets); });
    }

    Result<void, Problem> mend_cycles() {
        TracksGo go;
        go.joints = numbers_.joints;
        go.joint_count = static_cast<std::uint32_t>(std::count(here_.joints.begin(), here_.joints.end(), true));
        for (std::size_t p = 0; p < here_.pools.size(); ++p) {
            WeightsGo& weights = go.weights.emplace_back();
            weights.pool = numbers_.pools[p];
            for (std::uint32_t t = 0; t < here_.pools[p].targets.size(); ++t) {
                if (!here_.pools[p].targets[t]) continue;
                weights.first_frame_there += t < object_.pools[p].first_frame ? 1 : 0;
                weights.from.push_back(t);
            }
            weights.first_frame = object_.pools[p].first_frame;
        }
        std::vector<std::string_view> names;
        std::vector<std::size_t> emptied;
        const bool is_changed = changes_tracks();
        for (std::size_t k = 0; k < object_.cycles.size(); ++k) {
            const CycleView& cycle = object_.cycles[k];
            names.push_back(cycle.name);
            if (!here_.cycles[k]) {
                rewrite_.remove(cycle.chunk);
            } else if (is_changed) {
                const auto counts = send_tracks(tree_, object_, cycle, go, rewrite_);
                if (!counts) return counts.error();
                if (counts->stay != 0 || counts->go == 0) continue;
                if (has_references_left(tree_, cycle.chunk, rewrite_)) continue;
                rewrite_.remove(cycle.chunk);
                emptied.push_back(k);
            }
        }
        if (!emptied.empty())
            log_.warnings.push_back("no track is left of, so these go: cycles " + list_names(names, emptied));
        return {};
    }

    const ChunkTree& tree_;
    const Document& document_;
    const ObjectView& object_;
    const Staying& staying_;
    const Staying::Object& here_;
    std::vector<std::uint32_t> materials_, textures_;
    Rewrite& rewrite_;
    Log& log_;
    ObjectNumbers numbers_;
    std::vector<std::vector<IndexRun>> runs_;
    std::map<std::uint32_t, std::uint32_t> owners_;                          // of POLY chunks: their joints
    std::map<std::pair<std::size_t, std::uint32_t>, std::uint32_t> starts_;  // of pool and former start
};

}  // namespace

Staying everything(const Document& document) {
    Staying staying;
    staying.textures.assign(document.textures.size(), true);
    staying.materials.assign(document.global_materials, true);
    for (const ObjectView& object : document.objects) {
        Staying::Object& here = staying.objects.emplace_back();
        here.joints.assign(object.skeleton.joints.size(), true);
        here.polygons.assign(object.skeleton.joints.size(), true);
        here.chains.assign(object.chains.size(), true);
        here.cycles.assign(object.cycles.size(), true);
        for (const PoolView& pool : object.pools) {
            here.pools.emplace_back();
            here.pools.back().targets.assign(pool.targets.size(), true);
        }
    }
    return staying;
}

Result<void, Problem> mend(const Source& source, const Staying& staying, Rewrite& rewrite, Log& log) {
    mend_textures(source, staying, rewrite, log);
    for (std::size_t m = 0; m < staying.materials.size(); ++m) {
        if (!staying.materials[m]) rewrite.remove(source.document.materials[m].chunk);
    }
    for (std::size_t k = 0; k < staying.objects.size(); ++k) {
        if (!staying.objects[k].stays) {
            rewrite.remove(source.document.objects[k].chunk);
            continue;
        }
        if (const auto mended = ObjectMender(source, staying, k, rewrite, log).mend(); !mended) return mended.error();
    }
    return {};
}

}  // namespace bendy::edit
