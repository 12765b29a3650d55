#include "mend.h"

#include "cycle_tracks.h"

#include <bendy/edit/names.h>
#include <bendy/format/records.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <string>
#include <tuple>
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
          object_(source.document.objects[object]),
          staying_(staying),
          here_(staying.objects[object]),
          materials_(renumbered(staying.materials)),
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
        mend_polygons();
        mend_joint_table();
        mend_joint_names();
        mend_chains();
        for (std::size_t p = 0; p < object_.pools.size(); ++p) {
            const PoolView& pool = object_.pools[p];
            if (here_.pools[p].stays) {
                mend_pool(tree_, pool, here_.pools[p], numbers_, numbers_.vertices[p], runs_[p], rewrite_);
            } else {
                rewrite_.remove(pool.chunk);
            }
        }
        if (object_.collapse) mend_collapse(*object_.collapse, here_, numbers_, rewrite_);
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

    /// As the record is from now on.
    void mend_record(PolygonRecord& record) const {
        if (record.material != kNone) {
            if ((record.material & kLocalMaterial) == 0) {
                record.material = materials_[record.material];
            } else if (!staying_.local_materials) {
                record.material = kNone;
            }
        }
        if (!numbers_.vertices[record.pool].empty()) {
            record.first = record.count == 0 ? 0 : starts_.at({record.pool, record.first});
        }
        record.pool = numbers_.pools[record.pool];
    }

    void mend_polygons() {
        for (const PolygonView& polygons : object_.skeleton.polygons) {
            if (!(tree_[polygons.chunk].id == FourCC("POLY"))) continue;
            if (!keeps(polygons.joint, polygons.pool)) {
                rewrite_.remove(polygons.chunk);
                continue;
            }
            const Bytes before = tree_.payload(polygons.chunk);
            PolygonRecord record;
            copy_at(before, 0, record);
            mend_record(record);
            if (std::memcmp(before.data(), &record, sizeof record) == 0) continue;
            Buffer payload(before.begin(), before.end());
            std::memcpy(payload.data(), &record, sizeof record);
            rewrite_.replace(polygons.chunk, payload);
        }
    }

    void mend_joint_table() {
        const std::uint32_t chunk = tree_.find(object_.chunk, FourCC("JNTS"));
        if (chunk == kNone) return;
        const Bytes before = tree_.payload(chunk);
        JointsRecord record;
        copy_at(before, 0, record);
        const std::uint64_t ranges_at = sizeof record + std::uint64_t{record.joints} * sizeof(RestRecord);
        Buffer payload(sizeof record);
        for (std::uint32_t j = 0; j < record.joints; ++j) {
            if (!here_.joints[j]) continue;
            const Bytes rest = before.subspan(sizeof record + std::size_t{j} * sizeof(RestRecord), sizeof(RestRecord));
            payload.insert(payload.end(), rest.begin(), rest.end());
        }
        std::uint32_t ranges = 0;
        for (std::uint32_t k = 0; k < record.polygons; ++k) {
            JointPolygons range;
            copy_at(before, ranges_at + std::uint64_t{k} * sizeof range, range);
            if (!keeps(range.joint, range.polygons.pool)) continue;
            range.joint = numbers_.joints[range.joint];
            mend_record(range.polygons);
            append(payload, range);
            ++ranges;
        }
        record.joints = static_cast<std::uint32_t>(std::count(here_.joints.begin(), here_.joints.end(), true));
        record.polygons = ranges;
        std::memcpy(payload.data(), &record, sizeof record);
        if (!std::equal(payload.begin(), payload.end(), before.begin(), before.end())) rewrite_.replace(chunk, payload);
    }

    void mend_joint_names() {
        const std::uint32_t chunk = tree_.find(object_.chunk, FourCC("JNAM"));
        if (chunk == kNone || is_all(here_.joints)) return;
        std::string_view names = as_text(tree_.payload(chunk));
        std::string staying;
        for (const bool stays : here_.joints) {
            const std::size_t end = names.find('\0') + 1;
            if (stays) staying += names.substr(0, end);
            names.remove_prefix(end);
        }
        rewrite_.replace(chunk, as_byte_span(staying));
    }

    void mend_chains() {
        for (std::size_t k = 0; k < object_.chains.size(); ++k) {
            const ChainView& chain = object_.chains[k];
            if (here_.chains[k]) {
                mend_chain(chain);
            } else {
                rewrite_.remove(chain.chunk);
            }
        }
        for (const PullView& pull : object_.skeleton.pulls) {
            const std::uint32_t now = numbers_.chains[pull.chain];
            if (now == pull.chain) continue;
            if (now == kNone) {
                rewrite_.remove(pull.chunk);
                continue;
            }
            const Bytes before = tree_.payload(pull.chunk);
            Buffer payload(before.begin(), before.end());
            std::memcpy(payload.data() + offsetof(PullRecord, chain), &now, sizeof now);
            rewrite_.replace(pull.chunk, payload);
        }
    }

    void mend_chain(const ChainView& chain) {
        ChainRecord record = chain.record;
        const auto number = [&](std::uint32_t joint) { return joint == kNone ? kNone : numbers_.joints[joint]; };
        record.start = number(record.start);
        record.effector = number(record.effector);
        record.target = number(record.target);
        record.pole = number(record.pole);
        for (const auto& [before, now, what] : {std::tuple(chain.record.target, record.target, "target"),
                                                std::tuple(chain.record.pole, record.pole, "pole")}) {
            if (before != kNone && now == kNone) {
                log_.warnings.push_back("chain \"" + std::string(chain.name) + "\" loses its " + what + ", \"" +
                                        std::string(object_.skeleton.joints[before].name) + '"');
            }
        }
        if (std::memcmp(&record, &chain.record, offsetof(ChainRecord, solver)) == 0) return;
        const std::uint32_t chunk = tree_.find(chain.chunk, FourCC("KINF"));
        const Bytes before = tree_.payload(chunk);
        Buffer payload(before.begin(), before.end());
        std::memcpy(payload.data(), &record, offsetof(ChainRecord, solver));
        rewrite_.replace(chunk, payload);
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
                rewrite_.remove(cycle.chunk);
                emptied.push_back(k);
            }
        }
        if (!emptied.empty())
            log_.warnings.push_back("no track is left of, so these go: cycles " + list_names(names, emptied));
        return {};
    }

    const ChunkTree& tree_;
    const ObjectView& object_;
    const Staying& staying_;
    const Staying::Object& here_;
    std::vector<std::uint32_t> materials_;
    Rewrite& rewrite_;
    Log& log_;
    ObjectNumbers numbers_;
    std::vector<std::vector<IndexRun>> runs_;
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
