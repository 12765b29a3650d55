#include "keep_only.h"

#include "clip_tracks.h"
#include "renumber.h"

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

class ObjectUpdater {
public:
    ObjectUpdater(const Source& source, const Kept& kept, std::size_t object, Rewrite& rewrite, Log& log)
        : tree_(source.tree),
          document_(source.document),
          object_(source.document.objects[object]),
          kept_(kept),
          here_(kept.objects[object]),
          materials_(renumbered(kept.materials)),
          textures_(renumbered(kept.textures)),
          rewrite_(rewrite),
          log_(log) {
        numbers_.joints = renumbered(here_.joints);
        numbers_.chains = renumbered(here_.chains);
        std::vector<bool> meshes;
        for (const Kept::Mesh& mesh : here_.meshes) {
            meshes.push_back(mesh.stays);
            numbers_.vertices.push_back(renumbered(mesh.vertices));
        }
        numbers_.meshes = renumbered(meshes);
    }

    Result<void, Problem> update() {
        find_index_runs();
        repair_skins();
        for (std::size_t k = 0; k < object_.chains.size(); ++k) {
            if (!here_.chains[k]) rewrite_.remove(object_.chains[k].chunk);
        }
        for (std::size_t p = 0; p < object_.meshes.size(); ++p) {
            const MeshView& mesh = object_.meshes[p];
            if (here_.meshes[p].stays) {
                update_mesh(tree_, mesh, here_.meshes[p], numbers_, numbers_.vertices[p], runs_[p], rewrite_);
            } else {
                rewrite_.remove(mesh.chunk);
            }
        }
        if (object_.collapse) update_collapse(*object_.collapse, here_, numbers_, rewrite_);
        renumber();
        return update_clips();
    }

private:
    [[nodiscard]] bool keeps(std::uint32_t joint, std::uint32_t mesh) const {
        return here_.joints[joint] && here_.polygons[joint] && here_.meshes[mesh].stays;
    }

    /// For the meshes that lose vertices, finds the runs of their index lists that stay, and the new starts of those
    /// runs.
    void find_index_runs() {
        runs_.resize(object_.meshes.size());
        for (const SubmeshView& submesh : object_.skeleton.submeshes) {
            if (submesh.count != 0 && keeps(submesh.joint, submesh.mesh))
                runs_[submesh.mesh].push_back({submesh.first, submesh.count});
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

    void repair_skins() {
        for (std::uint32_t j = 0; j < object_.skeleton.joints.size(); ++j) {
            const JointView& joint = object_.skeleton.joints[j];
            if (!here_.joints[j]) {
                if (joint.parent == kNone || here_.joints[joint.parent]) rewrite_.remove(joint.chunk);
                continue;
            }
            if (here_.polygons[j] && kept_.local_materials) continue;
            for (const std::uint32_t child : tree_.children(joint.chunk)) {
                if (tree_[child].id == FourCC("MATE")) rewrite_.remove(child);
            }
        }
    }

    /// Handles what the references do not say: polygons are removed with a joint or a mesh, or stay and begin elsewhere
    /// in INDX.
    [[nodiscard]] bool mend_range(std::uint32_t chunk, const RecordLayout& layout, std::span<std::byte> record) const {
        const bool is_table_row = layout.name == "JointSubmesh";
        if (!is_table_row && layout.name != "SubmeshRecord") return true;
        const std::size_t at = is_table_row ? offsetof(JointSubmesh, submesh) : 0;
        SubmeshRecord range;
        std::memcpy(&range, record.data() + at, sizeof range);
        std::uint32_t joint = 0;
        if (is_table_row) {
            std::memcpy(&joint, record.data(), sizeof joint);
        } else {
            joint = owners_.at(chunk);
        }
        if (!keeps(joint, range.mesh)) return false;
        if (numbers_.vertices[range.mesh].empty()) return true;
        range.first = range.count == 0 ? 0 : starts_.at({range.mesh, range.first});
        std::memcpy(record.data() + at, &range, sizeof range);
        return true;
    }

    void renumber() {
        for (const SubmeshView& submesh : object_.skeleton.submeshes) owners_.try_emplace(submesh.chunk, submesh.joint);
        NewNumbers numbers;
        numbers.of(Entity::joint) = numbers_.joints;
        numbers.of(Entity::chain) = numbers_.chains;
        numbers.of(Entity::mesh) = numbers_.meshes;
        numbers.of(Entity::material) = materials_;
        numbers.of(Entity::texture) = textures_;
        numbers.own_materials = kept_.local_materials;
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
                return object_.meshes[lost.number].name;
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

    /// Reports what a chain loses, and which named leaves are removed.
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
        log_.warnings.push_back(leaf + " is removed with its " + std::string(bendy::name_of(lost.entity)) + ", \"" +
                                std::string(name_of(lost)) + '"');
    }

    [[nodiscard]] bool changes_tracks() const {
        if (!is_all(here_.joints)) return true;
        return std::any_of(here_.meshes.begin(), here_.meshes.end(),
                           [](const Kept::Mesh& mesh) { return !mesh.stays || !is_all(mesh.targets); });
    }

    Result<void, Problem> update_clips() {
        TrackMap map;
        map.joints = numbers_.joints;
        map.joint_count = static_cast<std::uint32_t>(std::count(here_.joints.begin(), here_.joints.end(), true));
        for (std::size_t p = 0; p < here_.meshes.size(); ++p) {
            WeightMap& weights = map.weights.emplace_back();
            weights.mesh = numbers_.meshes[p];
            for (std::uint32_t t = 0; t < here_.meshes[p].targets.size(); ++t) {
                if (!here_.meshes[p].targets[t]) continue;
                weights.first_frame_there += t < object_.meshes[p].first_frame ? 1 : 0;
                weights.from.push_back(t);
            }
            weights.first_frame = object_.meshes[p].first_frame;
        }
        std::vector<std::string_view> names;
        std::vector<std::size_t> emptied;
        const bool is_changed = changes_tracks();
        for (std::size_t k = 0; k < object_.clips.size(); ++k) {
            const ClipView& clip = object_.clips[k];
            names.push_back(clip.name);
            if (!here_.clips[k]) {
                rewrite_.remove(clip.chunk);
            } else if (is_changed) {
                const auto counts = remap_tracks(tree_, object_, clip, map, rewrite_);
                if (!counts) return counts.error();
                if (counts->stay != 0 || counts->go == 0) continue;
                if (has_references_left(tree_, clip.chunk, rewrite_)) continue;
                rewrite_.remove(clip.chunk);
                emptied.push_back(k);
            }
        }
        if (!emptied.empty())
            log_.warnings.push_back("no track is left of, so these go: clips " + list_names(names, emptied));
        return {};
    }

    const ChunkTree& tree_;
    const Document& document_;
    const ObjectView& object_;
    const Kept& kept_;
    const Kept::Object& here_;
    std::vector<std::uint32_t> materials_, textures_;
    Rewrite& rewrite_;
    Log& log_;
    ObjectNumbers numbers_;
    std::vector<std::vector<IndexRun>> runs_;
    std::map<std::uint32_t, std::uint32_t> owners_;                          // of POLY chunks: the joints that own them
    std::map<std::pair<std::size_t, std::uint32_t>, std::uint32_t> starts_;  // new start, by mesh and old start
};

}  // namespace

Kept everything(const Document& document) {
    Kept kept;
    kept.textures.assign(document.textures.size(), true);
    kept.materials.assign(document.global_materials, true);
    for (const ObjectView& object : document.objects) {
        Kept::Object& here = kept.objects.emplace_back();
        here.joints.assign(object.skeleton.joints.size(), true);
        here.polygons.assign(object.skeleton.joints.size(), true);
        here.chains.assign(object.chains.size(), true);
        here.clips.assign(object.clips.size(), true);
        for (const MeshView& mesh : object.meshes) {
            here.meshes.emplace_back();
            here.meshes.back().targets.assign(mesh.targets.size(), true);
        }
    }
    return kept;
}

Result<void, Problem> keep_only(const Source& source, const Kept& kept, Rewrite& rewrite, Log& log) {
    update_textures(source, kept, rewrite);
    for (std::size_t m = 0; m < kept.materials.size(); ++m) {
        if (!kept.materials[m]) rewrite.remove(source.document.materials[m].chunk);
    }
    for (std::size_t k = 0; k < kept.objects.size(); ++k) {
        if (!kept.objects[k].stays) {
            rewrite.remove(source.document.objects[k].chunk);
            continue;
        }
        if (const auto updated = ObjectUpdater(source, kept, k, rewrite, log).update(); !updated)
            return updated.error();
    }
    update_extensions(source, kept, rewrite, log);
    return {};
}

}  // namespace bendy::edit
