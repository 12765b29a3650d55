#include <bendy/edit/edit.h>

#include "clip_tracks.h"
#include "place_clips.h"
#include "rewrite.h"

#include <bendy/format/names.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>

namespace bendy::edit {
namespace {

/// For each joint there, finds the joint here with the same name. A name that only one joint has is enough. Among
/// several, it is the one whose parent matches the parent; the others are paired in order if both sides have as many.
std::vector<std::uint32_t> pair_joints(const SkeletonView& there, const SkeletonView& here) {
    struct Same {
        std::vector<std::uint32_t> there, here;
    };
    std::map<std::string_view, Same> by_name;
    std::map<std::pair<std::string_view, std::uint32_t>, std::vector<std::uint32_t>> by_parent;  // in reverse order
    for (auto k = static_cast<std::uint32_t>(here.joints.size()); k-- > 0;) {
        const JointView& joint = here.joints[k];
        by_name[joint.name].here.push_back(k);
        by_parent[{joint.name, joint.parent}].push_back(k);
    }
    for (auto k = static_cast<std::uint32_t>(there.joints.size()); k-- > 0;)
        by_name[there.joints[k].name].there.push_back(k);
    // Joints without a name are paired in order if their parents have equally many of them.
    std::map<std::uint32_t, std::size_t> nameless_here, nameless_there;  // by parent
    for (const JointView& joint : here.joints) nameless_here[joint.parent] += joint.name.empty() ? 1 : 0;
    for (const JointView& joint : there.joints) nameless_there[joint.parent] += joint.name.empty() ? 1 : 0;
    std::vector<std::uint32_t> pairs(there.joints.size(), kNone);
    std::vector<bool> is_taken(here.joints.size());
    const auto pair = [&](std::uint32_t k, std::uint32_t with) {
        pairs[k] = with;
        is_taken[with] = true;
    };
    for (std::uint32_t k = 0; k < pairs.size(); ++k) {
        const JointView& joint = there.joints[k];
        const Same& same = by_name[joint.name];
        if (!joint.name.empty() && same.there.size() == 1 && same.here.size() == 1) {
            pair(k, same.here.front());
            continue;
        }
        if (joint.parent != kNone && pairs[joint.parent] == kNone) continue;
        const auto found = by_parent.find({joint.name, joint.parent == kNone ? kNone : pairs[joint.parent]});
        if (found == by_parent.end() || found->second.empty()) continue;
        if (joint.name.empty() && nameless_there[joint.parent] != nameless_here[found->first.second]) continue;
        pair(k, found->second.back());
        found->second.pop_back();
    }
    for (auto& [name, same] : by_name) {
        if (name.empty()) continue;
        std::erase_if(same.there, [&](std::uint32_t k) { return pairs[k] != kNone; });
        std::erase_if(same.here, [&](std::uint32_t k) { return is_taken[k]; });
        if (same.there.size() != same.here.size()) continue;
        for (std::size_t k = 0; k < same.there.size(); ++k) pair(same.there[k], same.here[k]);
    }
    return pairs;
}

bool are_equal(const RestRecord& a, const RestRecord& b) {
    return a.rotation == b.rotation && a.translation == b.translation && a.scale == b.scale && a.shear == b.shear;
}

WeightMap pair_targets(const MeshView& there, const MeshView& here, std::uint32_t mesh) {
    WeightMap map;
    map.mesh = mesh;
    const auto names_there = names_of(there.targets);
    const auto names_here = names_of(here.targets);
    auto pairs = pair_names(names_here, names_there);
    const auto has_name = [](std::string_view name) { return !name.empty(); };
    const bool any_named = std::any_of(names_there.begin(), names_there.end(), has_name) ||
                           std::any_of(names_here.begin(), names_here.end(), has_name);
    if (!any_named && names_there.size() == names_here.size()) {
        for (std::uint32_t k = 0; k < pairs.size(); ++k) pairs[k] = k;
    }
    const bool fits = std::any_of(pairs.begin(), pairs.end(), [](std::uint32_t k) { return k != kNone; });
    if (!fits) return {};
    map.from = std::move(pairs);
    map.first_frame = there.first_frame;
    map.first_frame_there = here.first_frame;
    for (const MorphTargetView& target : here.targets) map.at_rest.push_back(target.rest_weight);
    return map;
}

/// The difference between two rest transforms.
struct RestDifference {
    double metres = 0.0;
    double degrees = 0.0;
    double scale = 0.0;  ///< the largest factor by which a scale differs, minus 1

    /// Returns true if it is more than rounding.
    [[nodiscard]] bool is_noticeable() const { return metres > 1e-5 || degrees > 0.01 || scale > 1e-4; }
    /// For finding the largest: a degree, a centimetre and a hundredth of scale count the same.
    [[nodiscard]] double weight() const { return metres * 100.0 + degrees + scale * 100.0; }
};

RestDifference rest_difference(const RestRecord& a, const RestRecord& b) {
    RestDifference difference;
    double square = 0.0;
    double dot = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double moved = double{a.translation[c]} - b.translation[c];
        square += moved * moved;
        const double larger = std::max(std::abs(double{a.scale[c]}), std::abs(double{b.scale[c]}));
        if (larger > 0.0)
            difference.scale = std::max(difference.scale, std::abs(double{a.scale[c]} - b.scale[c]) / larger);
    }
    std::array<double, 4> apart{};
    for (std::size_t c = 0; c < 4; ++c) dot += double{a.rotation[c]} * b.rotation[c];
    for (std::size_t c = 0; c < 4; ++c) apart[c] = a.rotation[c] - (dot < 0.0 ? -1.0 : 1.0) * b.rotation[c];
    double chord = 0.0;
    for (const double number : apart) chord += number * number;
    difference.metres = std::sqrt(square);
    difference.degrees = 4.0 * std::asin(std::min(1.0, std::sqrt(chord) / 2.0)) * 180.0 / std::numbers::pi;
    return difference;
}

/// Returns "moved by 12 mm, turned by 3.1 degrees".
std::string describe(const RestDifference& difference) {
    std::string text;
    const auto add = [&](bool is_there, const char* format, double number) {
        if (!is_there) return;
        std::array<char, 64> part{};
        std::snprintf(part.data(), part.size(), format, number);
        text += (text.empty() ? "" : ", ") + std::string(part.data());
    };
    add(difference.metres > 1e-5, "moved by %.3g mm", difference.metres * 1e3);
    add(difference.degrees > 0.01, "turned by %.3g degrees", difference.degrees);
    add(difference.scale > 1e-4, "scaled by %.3g %%", difference.scale * 100.0);
    return text;
}

/// Maps the tracks of an object's clips to another object.
class Pairing {
public:
    Pairing(const ObjectView& there, const ObjectView& here) : there_(there), here_(here) {
        map_.joints = pair_joints(there.skeleton, here.skeleton);
        map_.joint_count = static_cast<std::uint32_t>(here.skeleton.joints.size());
        map_.decoded.resize(map_.joints.size());
        for (std::size_t j = 0; j < map_.joints.size(); ++j) {
            if (map_.joints[j] == kNone) continue;
            const RestRecord& rest = here.skeleton.joints[map_.joints[j]].rest;
            map_.decoded[j] = !are_equal(rest, there.skeleton.joints[j].rest);
        }
        auto meshes = pair_names(names_of(there.meshes), names_of(here.meshes));
        if (there.meshes.size() == 1 && here.meshes.size() == 1) meshes[0] = 0;
        for (std::size_t p = 0; p < meshes.size(); ++p) {
            map_.weights.push_back(
                meshes[p] == kNone ? WeightMap{} : pair_targets(there.meshes[p], here.meshes[meshes[p]], meshes[p]));
        }
    }

    [[nodiscard]] const TrackMap& map() const { return map_; }
    /// For each mesh there, the one here.
    [[nodiscard]] std::vector<std::uint32_t> meshes() const {
        std::vector<std::uint32_t> meshes;
        for (const WeightMap& weights : map_.weights) meshes.push_back(weights.mesh);
        return meshes;
    }

    /// Joints and meshes that the clips animate and that are missing here; joints whose rest poses differ.
    void warn(std::span<const bool> is_animated, Log& log) const {
        const Unpaired unpaired = find_unpaired(is_animated);
        const auto list = [&](const std::vector<std::size_t>& joints) {
            return counted(joints.size(), "joint") + ": " + list_names(names_of(there_.skeleton.joints), joints, 20);
        };
        if (!unpaired.missing.empty()) {
            log.warnings.push_back("there is no joint here for the tracks of " + list(unpaired.missing) +
                                   explain(unpaired.missing.front()));
        }
        if (!unpaired.shared.empty()) {
            log.warnings.push_back("it is not clear which joints here are meant by the tracks of " +
                                   list(unpaired.shared) + "; " + explain_shared(unpaired.shared.front()));
        }
        warn_of_rests(log);
    }

    /// Animated joints there without a counterpart here.
    struct Unpaired {
        std::vector<std::size_t> missing;  ///< no joint here has their name
        std::vector<std::size_t> shared;   ///< several joints here have their name
    };
    [[nodiscard]] Unpaired find_unpaired(std::span<const bool> is_animated) const {
        std::set<std::string_view> here;
        for (const JointView& joint : here_.skeleton.joints) here.insert(joint.name);
        Unpaired unpaired;
        for (std::size_t j = 0; j < map_.joints.size(); ++j) {
            if (!is_animated[j] || map_.joints[j] != kNone) continue;
            const std::string_view name = there_.skeleton.joints[j].name;
            (!name.empty() && here.contains(name) ? unpaired.shared : unpaired.missing).push_back(j);
        }
        return unpaired;
    }

    /// Says which joints share a name with one there, and how to fix it.
    [[nodiscard]] std::string explain_shared(std::size_t animated) const {
        const std::string_view name = there_.skeleton.joints[animated].name;
        const auto numbers_in = [&](const ObjectView& object) {
            std::vector<std::size_t> numbers;
            for (std::size_t j = 0; j < object.skeleton.joints.size(); ++j) {
                if (object.skeleton.joints[j].name == name) numbers.push_back(j);
            }
            return numbers;
        };
        const auto here = numbers_in(here_);
        const auto there = numbers_in(there_);
        constexpr std::size_t kShown = 4;
        const auto count = [&](const std::vector<std::size_t>& numbers, const char* where) {
            std::string text = counted(numbers.size(), "joint") + ' ' + where;
            for (std::size_t k = 0; k < std::min(numbers.size(), kShown); ++k)
                text += (k == 0 ? " (#" : ", #") + std::to_string(numbers[k]);
            return text + (numbers.size() > kShown ? ", ...)" : ")");
        };
        const bool is_ours = here.size() > 1;
        return '"' + std::string(name) + "\" is the name of " + count(here, "here") + " and of " +
               count(there, "in the other file") + "; rename all but one " +
               (is_ours ? "here first, as in #" + std::to_string(here.back()) + "=NEW"
                        : "there first, as in #" + std::to_string(there.back()) + "=NEW");
    }

    /// Suggests a rename if the names of joints differ systematically.
    [[nodiscard]] std::string explain(std::size_t animated) const {
        const std::string_view name = there_.skeleton.joints[animated].name;
        const std::string_view nearest = nearest_name(names_of(here_.skeleton.joints), name);
        return nearest.empty() ? ""
                               : " (is its \"" + std::string(name) + "\" the \"" + std::string(nearest) +
                                     "\" here? renaming fixes that)";
    }

    /// Where the clips move joints: how many times as far from their parents these joints rest there.
    struct Scale {
        double times = 1.0;     ///< the median
        std::size_t joint = 0;  ///< there, one of that scale
    };
    [[nodiscard]] Scale scale(std::span<const bool> is_moved) const {
        std::vector<Scale> found;
        for (std::size_t j = 0; j < map_.joints.size(); ++j) {
            if (!is_moved[j] || map_.joints[j] == kNone) continue;
            const double from = distance(there_.skeleton.joints[j].rest);
            const double to = distance(here_.skeleton.joints[map_.joints[j]].rest);
            if (from > 0.0 && to > 0.0) found.push_back({from / to, j});
        }
        if (found.empty()) return {};
        const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
        std::nth_element(found.begin(), middle, found.end(),
                         [](const Scale& a, const Scale& b) { return a.times < b.times; });
        return *middle;
    }
    /// Says "its joints rest 100 times as far apart as here".
    [[nodiscard]] std::string describe_scale(const Scale& scale) const {
        const JointView& joint = there_.skeleton.joints[scale.joint];
        std::array<char, 128> text{};
        std::snprintf(text.data(), text.size(), "\" rests %.3g from its parent there and %.3g here, ",
                      distance(joint.rest), distance(here_.skeleton.joints[map_.joints[scale.joint]].rest));
        const std::string lengths = text.data();
        std::snprintf(text.data(), text.size(), "%.3g times as far", scale.times);
        return "the skeletons differ in scale: \"" + std::string(joint.name) + lengths + text.data();
    }

private:
    static double distance(const RestRecord& rest) {
        return std::hypot(double{rest.translation[0]}, double{rest.translation[1]}, double{rest.translation[2]});
    }

    void warn_of_rests(Log& log) const {
        RestDifference most;
        std::size_t differing = 0;
        std::size_t worst = 0;
        for (std::size_t j = 0; j < map_.joints.size(); ++j) {
            if (map_.joints[j] == kNone || !map_.decoded[j]) continue;
            const RestDifference difference =
                rest_difference(there_.skeleton.joints[j].rest, here_.skeleton.joints[map_.joints[j]].rest);
            if (!difference.is_noticeable()) continue;
            ++differing;
            if (differing == 1 || difference.weight() > most.weight()) {
                most = difference;
                worst = j;
            }
        }
        if (differing == 0) return;
        log.warnings.push_back("the rest poses of " + counted(differing, "joint") + " differ, most that of \"" +
                               std::string(there_.skeleton.joints[worst].name) + "\": " + describe(most) +
                               "; if that is another body, retarget its clips instead");
    }

    const ObjectView& there_;
    const ObjectView& here_;
    TrackMap map_;
};

/// Marks the joints that the clips of an object move.
void mark_moved(const ObjectView& object, std::span<bool> joints) {
    for (const ClipView& clip : object.clips) {
        for (const TrackView& track : clip.tracks) {
            if (track.path == TrackPath::translation) joints[track.target] = true;
        }
        if (!clip.packed) continue;
        for (std::uint32_t j = 0; j < clip.packed->record.joints; ++j)
            joints[j] = joints[j] || clip.packed->animates(j, TrackPath::translation);
    }
}

/// Marks what the clips of an object animate.
void mark_animated(const ObjectView& object, std::span<bool> joints, std::set<std::uint32_t>& meshes) {
    for (const ClipView& clip : object.clips) {
        for (const TrackView& track : clip.tracks) {
            if (track.path == TrackPath::weights) {
                meshes.insert(track.target);
            } else {
                joints[track.target] = true;
            }
        }
        for (const PlayRecord& play : clip.plays) meshes.insert(play.mesh);
        if (!clip.packed) continue;
        for (std::uint32_t j = 0; j < clip.packed->record.joints; ++j) {
            joints[j] = joints[j] || clip.packed->animates(j, TrackPath::rotation) ||
                        clip.packed->animates(j, TrackPath::translation) || clip.packed->animates(j, TrackPath::scale);
        }
    }
}

class Merger {
public:
    Merger(const ClipFiles& files, SameName same_name, Log& log)
        : from_(files.from()),
          to_(files.to()),
          log_(log),
          pairing_(from_, files.to()),
          placer_(files, pairing_.map().joints, pairing_.meshes(), same_name, log) {}

    Edited merge() {
        if (const auto scaled = check_scale()) return *scaled;
        std::vector<std::size_t> useless;
        for (std::size_t k = 0; k < from_.clips.size(); ++k) {
            const ClipView& clip = from_.clips[k];
            const auto counts = placer_.change(clip, pairing_.map());
            if (!counts) return counts.error();
            if (counts->stay == 0 && counts->go != 0 && !placer_.has_more(clip)) {
                useless.push_back(k);
                continue;
            }
            if (const auto put = put_clip(clip, *counts); !put) return put.error();
        }
        if (useless.size() == from_.clips.size()) return nothing_fits();
        if (!useless.empty()) {
            log_.warnings.push_back("clips that animate nothing in this file are left out: " +
                                    list_names(names_of(from_.clips), useless));
        }
        tell();
        return placer_.finish();
    }

private:
    /// A clip in other units is refused, one of a larger or smaller character is not.
    [[nodiscard]] std::optional<Problem> check_scale() {
        constexpr double kNoticeable = 1.1, kOtherUnits = 10.0;
        const auto moved = std::make_unique<bool[]>(from_.skeleton.joints.size());
        const std::span<bool> is_moved(moved.get(), from_.skeleton.joints.size());
        mark_moved(from_, is_moved);
        const Pairing::Scale scale = pairing_.scale(is_moved);
        const double factor = std::max(scale.times, 1.0 / scale.times);
        if (factor >= kOtherUnits) {
            return Problem{pairing_.describe_scale(scale) +
                           (are_humans()
                                ? "; retarget its clips instead"
                                : "; export both from the same scene, in the same units: in Blender, apply the "
                                  "scale of both armatures first (Object > Apply > Scale)")};
        }
        if (factor > kNoticeable) {
            log_.warnings.push_back(pairing_.describe_scale(scale) +
                                    "; retargeting fits clips to a character of another size");
        }
        return std::nullopt;
    }

    /// Returns true if retargeting may help: both say which joint is the hips.
    [[nodiscard]] bool are_humans() const {
        const auto has_hips = [](const ObjectView& object) {
            return std::any_of(object.roles.begin(), object.roles.end(),
                               [](const RoleRecord& role) { return static_cast<Role>(role.role) == Role::hips; });
        };
        return has_hips(from_) && has_hips(to_);
    }

    void tell() {
        const auto animated = std::make_unique<bool[]>(from_.skeleton.joints.size());
        std::set<std::uint32_t> meshes;
        const std::span<bool> joints(animated.get(), from_.skeleton.joints.size());
        mark_animated(from_, joints, meshes);
        pairing_.warn(joints, log_);
        for (const std::uint32_t mesh : meshes) {
            const WeightMap& map = pairing_.map().weights[mesh];
            const std::string name = '"' + std::string(from_.meshes[mesh].name) + '"';
            if (map.from.empty()) {
                log_.warnings.push_back("no mesh and targets here fit the weights of mesh " + name);
                continue;
            }
            std::vector<std::size_t> lost;
            for (std::uint32_t t = 0; t < from_.meshes[mesh].targets.size(); ++t) {
                if (std::find(map.from.begin(), map.from.end(), t) == map.from.end()) lost.push_back(t);
            }
            if (!lost.empty()) {
                log_.warnings.push_back("mesh " + name + " has no targets here for the weights of " +
                                        list_names(names_of(from_.meshes[mesh].targets), lost));
            }
        }
    }

    [[nodiscard]] Problem nothing_fits() const {
        const auto animated = std::make_unique<bool[]>(from_.skeleton.joints.size());
        const std::span<bool> is_animated(animated.get(), from_.skeleton.joints.size());
        std::set<std::uint32_t> meshes;
        mark_animated(from_, is_animated, meshes);
        const auto [missing, shared] = pairing_.find_unpaired(is_animated);
        if (!shared.empty()) {
            return {"its clips animate " + counted(missing.size() + shared.size(), "joint") +
                    ", and it is not clear which one here is meant: " + pairing_.explain_shared(shared.front())};
        }
        if (missing.empty()) return {"its clips animate nothing in this file"};
        return {"its clips animate " + std::to_string(missing.size()) +
                (missing.size() == 1 ? " joint, which is not here: " : " joints and none of them is here: ") +
                list_names(names_of(from_.skeleton.joints), missing, 4) + pairing_.explain(missing.front()) +
                (are_humans() ? "; retarget its clips instead" : "")};
    }

    Result<void, Problem> put_clip(const ClipView& clip, const TrackCounts& counts) {
        const auto placed = placer_.put(clip);
        if (!placed) return placed.error();
        log_.done.push_back(
            (placed->replaces ? "replaced clip \"" : "merged clip \"") + placed->name + "\": " +
            contents_of(clip, counts) + (counts.go == 0 ? "" : ", " + std::to_string(counts.go) + " left out") +
            (counts.decoded == 0 ? "" : ", " + std::to_string(counts.decoded) + " decoded, for another rest pose"));
        return {};
    }

    /// Returns "3 tracks, 1 curve": what is merged of a clip.
    [[nodiscard]] std::string contents_of(const ClipView& clip, const TrackCounts& counts) const {
        const std::size_t curves = placer_.curves(clip);
        if (curves == 0) return counted(counts.stay, "track");
        return (counts.stay == 0 ? "" : counted(counts.stay, "track") + ", ") + counted(curves, "curve");
    }

    const ObjectView& from_;
    const ObjectView& to_;
    Log& log_;
    Pairing pairing_;
    ClipPlacer placer_;
};

}  // namespace

Result<SameName, Problem> parse_same_name(std::string_view word) {
    if (word == "error") return SameName::error;
    if (word == "replace") return SameName::replace;
    if (word == "number") return SameName::number;
    return Problem{"\"" + std::string(word) + "\" must be error, replace or number"};
}

Edited add_clips(Bytes file, Bytes other, SameName same_name, Log& log) {
    const auto files = open_clip_files(file, other, log);
    if (!files) return files.error();
    return Merger(*files, same_name, log).merge();
}

}  // namespace bendy::edit
