#include "place_clips.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <optional>
#include <utility>

namespace bendy::edit {
namespace {

std::span<const MaterialView> head_materials(const Source& source) {
    return std::span(source.document.materials).first(source.document.global_materials);
}

/// Returns an unused name: "Run.001", as Blender does.
std::string numbered(std::string_view name, const std::set<std::string, std::less<>>& taken, unsigned& last) {
    std::string numbered;
    do {
        std::array<char, 16> digits{};
        std::snprintf(digits.data(), digits.size(), ".%03u", ++last);
        numbered = std::string(name) + digits.data();
    } while (taken.contains(numbered));
    return numbered;
}

}  // namespace

std::vector<std::uint32_t> pair_names(std::span<const std::string_view> there, std::span<const std::string_view> here) {
    std::map<std::string_view, std::vector<std::uint32_t>> by_name;
    for (auto k = static_cast<std::uint32_t>(here.size()); k-- > 0;)
        by_name[here[k]].push_back(k);  // in reverse, because the last one is taken first
    std::vector<std::uint32_t> pairs(there.size(), kNone);
    for (std::size_t k = 0; k < there.size(); ++k) {
        const auto found = by_name.find(there[k]);
        if (there[k].empty() || found == by_name.end() || found->second.empty()) continue;
        pairs[k] = found->second.back();
        found->second.pop_back();
    }
    return pairs;
}

Result<ClipFiles, Problem> open_clip_files(Bytes file, Bytes other, Log& log) {
    auto here = open_source(file);
    if (!here) return here.error();
    auto there = open_source(other);
    if (!there) return Problem{"the other file: " + there.error().message};
    if (here->document.objects.empty()) return Problem{"there is no object that could have clips"};
    const auto& objects = there->document.objects;
    const auto has_clips = [](const ObjectView& object) { return !object.clips.empty(); };
    const auto from = std::find_if(objects.begin(), objects.end(), has_clips);
    if (from == objects.end()) return Problem{"the other file has no clips"};
    if (std::any_of(std::next(from), objects.end(), has_clips))
        log.warnings.emplace_back("only the clips of its first object that has some are taken");
    const auto object = static_cast<std::size_t>(from - objects.begin());
    return ClipFiles{*std::move(here), *std::move(there), object};
}

ClipPlacer::ClipPlacer(const ClipFiles& files, std::vector<std::uint32_t> joints, std::vector<std::uint32_t> meshes,
                       SameName same_name, Log& log)
    : files_(files),
      joints_(std::move(joints)),
      meshes_(std::move(meshes)),
      materials_(pair_names(names_of(head_materials(files.there)), names_of(head_materials(files.here)))),
      textures_(pair_names(names_of(files.there.document.textures), names_of(files.here.document.textures))),
      lists_here_(files.here.document.extensions),
      lists_there_(files.there.document.extensions),
      same_name_(same_name),
      log_(log),
      rewrite_(files.here.tree),
      sending_(files.there.tree) {
    for (const ClipView& clip : files.to().clips) {
        taken_.emplace(clip.name);
        places_.try_emplace(std::string(clip.name), clip.chunk);
    }
    numbers_.of(Entity::joint) = joints_;
    numbers_.of(Entity::mesh) = meshes_;
    numbers_.of(Entity::material) = materials_;
    numbers_.of(Entity::texture) = textures_;
}

Result<TrackCounts, Problem> ClipPlacer::change(const ClipView& clip, const TrackMap& map) {
    const ChunkTree& tree = files_.there.tree;
    auto counts = remap_tracks(tree, files_.from(), clip, map, sending_);
    if (!counts) return counts;
    renumber_leaves(
        tree, clip.chunk, numbers_, nullptr,
        [&](std::uint32_t chunk, const Renumbered& now) {
            const std::string leaf = name_of_leaf(tree, chunk);
            if (now.payload || now.lost.empty() || leaf.empty()) return;
            log_.warnings.push_back(leaf + " is left out: there is no " + std::string(name_of(now.lost.back().entity)) +
                                    " of that name here");
        },
        sending_);
    for (const CurveView& curve : clip.curves) {
        if (curve.kind == CurveTarget::nothing) point_here(curve);
    }
    return counts;
}

/// A pointer into a list of HEAD's extensions, such as that of the lights, leads to the element of the same name here.
void ClipPlacer::point_here(const CurveView& curve) {
    const auto element_here = [&](std::string_view before, std::string_view after,
                                  std::uint32_t element) -> std::optional<std::uint32_t> {
        const std::vector<std::string>& there = lists_there_.list(before).names;
        const extensions::NamedList& here = lists_here_.list(after);
        const bool is_alike = there.size() == here.names.size() && there[element] == here.names[element];
        if (is_alike) return element;
        const auto found = here.first.find(there[element]);
        return found == here.first.end() ? std::nullopt : std::optional(found->second);
    };
    const auto path = lists_there_.with_elements(curve.path, element_here);
    if (path == curve.path) return;
    if (!path) {
        log_.warnings.push_back(name_of_leaf(files_.there.tree, curve.chunk) + " is left out: it is not clear what " +
                                std::string(curve.path) + " is in this file");
        return sending_.remove(curve.chunk);
    }
    CurveView pointed = curve;
    pointed.path = *path;
    sending_.replace(curve.chunk, write_curve(pointed));
}

void ClipPlacer::add_curve(const ClipView& clip, Bytes payload) {
    sending_.append(clip.chunk, whole_leaf(FourCC("CURV"), payload));
}

bool ClipPlacer::has_more(const ClipView& clip) const {
    return has_references_left(files_.there.tree, clip.chunk, sending_);
}

std::size_t ClipPlacer::curves(const ClipView& clip) const {
    std::size_t curves = 0;
    const ChunkTree& tree = files_.there.tree;
    for (const std::uint32_t child : tree.children(clip.chunk))
        curves += tree[child].id == FourCC("CURV") && !sending_.is_removed(child) ? 1 : 0;
    return curves;
}

Result<ClipPlacer::Placed, Problem> ClipPlacer::put(const ClipView& clip) {
    std::string name(clip.name);
    const bool is_taken = !name.empty() && taken_.contains(name);
    if (is_taken && same_name_ == SameName::error) return Problem{"there is a clip \"" + name + "\" already"};
    const auto place = places_.find(name);
    const bool replaces = is_taken && same_name_ == SameName::replace && place != places_.end();
    if (is_taken && !replaces) {
        name = numbered(name, taken_, last_numbers_[name]);
        sending_.replace(files_.there.tree.find(clip.chunk, FourCC("NAME")), as_byte_span(name));
    }
    if (!name.empty()) taken_.insert(name);
    Buffer chunk = sending_.write(clip.chunk);
    if (replaces) {
        rewrite_.replace_whole(place->second, std::move(chunk));
        places_.erase(place);  // a second clip of this name gets a place of its own
    } else if (files_.to().clips.empty()) {
        rewrite_.append(files_.to().chunk, std::move(chunk));
    } else {
        rewrite_.insert_after(files_.to().clips.back().chunk, std::move(chunk));
    }
    return Placed{std::move(name), replaces};
}

Edited ClipPlacer::finish() {
    put_bound();
    return edit::finish(rewrite_);
}

void ClipPlacer::put_bound() {
    const auto& theirs = files_.there.document.bound;
    if (!theirs) return;
    const std::uint32_t chunk = files_.here.tree.find(0, FourCC("BNDS"));
    log_.warnings.emplace_back("its clips are encoded for size; the error that is stated was measured on its own skin");
    if (chunk == kNone) {
        BoundRecord bound = *theirs;
        rewrite_.insert_after(files_.here.tree.find(0, FourCC("VERS")), whole_leaf(FourCC("BNDS"), bytes_of(bound)));
        return;
    }
    BoundRecord bound = *files_.here.document.bound;
    bound.max_error = std::max(bound.max_error, theirs->max_error);
    bound.measured_error = std::max(bound.measured_error, theirs->measured_error);
    rewrite_.overwrite(chunk, 0, bytes_of(bound));
}

}  // namespace bendy::edit
