#include "pose_plan.h"

#include <bendy/runtime/model.h>

#include "math/joint_blocks.h"
#include "palette_rows.h"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace bendy {
namespace {

std::vector<std::uint32_t> depths_of(std::span<const Joint> joints) {
    std::vector<std::uint32_t> depths(joints.size());
    for (std::size_t joint = 0; joint < joints.size(); ++joint) {
        const std::uint32_t parent = joints[joint].parent;
        depths[joint] = parent == kNone ? 0 : depths[parent] + 1;
    }
    return depths;
}

bool is_same(const PaletteView& a, const PaletteView& b) {
    const auto x = a.inverse_bind();
    const auto y = b.inverse_bind();
    return std::equal(a.joints.begin(), a.joints.end(), b.joints.begin(), b.joints.end()) &&
           std::equal(x.begin(), x.end(), y.begin(), y.end());
}

/// Returns a number that is equal for equal palettes.
std::size_t hash_of(const PaletteView& palette) {
    std::size_t hash = palette.joints.size();
    const auto add = [&](std::uint32_t number) { hash = hash * 0x9e37'79b1u + number; };
    for (const std::uint32_t joint : palette.joints) add(joint);
    for (const glm::mat4& matrix : palette.inverse_bind()) {
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < 4; ++row)
                add(std::bit_cast<std::uint32_t>(matrix[column][row] + 0.0f));  // 0 and -0 are equal
        }
    }
    return hash;
}

/// Parts of a character usually follow the same bones: equal palettes are found, so that each is made once.
void plan_palettes(std::span<const MeshView> meshes, PosePlan& plan) {
    std::unordered_multimap<std::size_t, std::uint32_t> by_hash;
    for (std::uint32_t number = 0; number < meshes.size(); ++number) {
        const PaletteView& palette = meshes[number].palette;
        const std::size_t hash = hash_of(palette);
        const auto [begin, end] = by_hash.equal_range(hash);
        const auto same =
            std::find_if(begin, end, [&](const auto& other) { return is_same(palette, meshes[other.second].palette); });
        std::vector<PaletteMatrix>& rows = plan.inverse_bind.emplace_back();
        if (same != end) {
            plan.same_palette.push_back(same->second);
            plan.first_entry.push_back(plan.first_entry[same->second]);
            continue;
        }
        by_hash.emplace(hash, number);
        plan.same_palette.push_back(number);
        plan.first_entry.push_back(plan.palette_entries);
        plan.palette_entries += static_cast<std::uint32_t>(palette.joints.size());
        const auto inverse_bind = palette.inverse_bind();
        rows.reserve(inverse_bind.size());
        std::transform(inverse_bind.begin(), inverse_bind.end(), std::back_inserter(rows), to_rows);
    }
}

double longest_axis(const glm::dmat4& matrix) {
    double square = 0.0;
    for (int c = 0; c < 3; ++c) square = std::max(square, glm::dot(glm::dvec3(matrix[c]), glm::dvec3(matrix[c])));
    return std::sqrt(square);
}

/// A bounding box of points.
class Box {
public:
    void add(const glm::dvec3& point) {
        low_ = glm::min(low_, point);
        high_ = glm::max(high_, point);
    }
    /// Returns the length of the diagonal; negative if there is no point.
    [[nodiscard]] double diagonal() const { return low_.x <= high_.x ? glm::length(high_ - low_) : -1.0; }

private:
    glm::dvec3 low_{std::numeric_limits<double>::infinity()};
    glm::dvec3 high_{-std::numeric_limits<double>::infinity()};
};

/// Returns the size of a mesh in mesh space, from some hundreds of its vertices.
double length_of(const MeshView& mesh) {
    constexpr std::uint32_t kLooks = 256;
    const std::uint32_t step = mesh.vertices / kLooks + 1;
    Box box;
    for (std::uint32_t vertex = 0; vertex < mesh.vertices; vertex += step) box.add(mesh.positions.vec3(vertex));
    return box.diagonal();
}

/// Returns true if the numbers of the rest pose are of the character's size. Rounding is relative to the largest of
/// them.
bool fits_floats(const ObjectView& object, std::span<const Joint> joints) {
    constexpr double kLargest = 8.0;  // character sizes: 5e-7 of a size per rounding
    constexpr std::uint32_t kDeepest = 64;
    const std::vector<std::uint32_t> depths = depths_of(joints);
    if (joints.empty() || *std::max_element(depths.begin(), depths.end()) > kDeepest) return false;
    std::vector<glm::dmat4> model(joints.size());
    Box places;
    double largest = 0.0;
    for (std::size_t joint = 0; joint < joints.size(); ++joint) {
        if (joints[joint].shear != glm::vec3(0.0f)) return false;
        const glm::dmat4 local = to_matrix(joints[joint].rest, joints[joint].shear);
        model[joint] = joints[joint].parent == kNone ? local : model[joints[joint].parent] * local;
        places.add(model[joint][3]);
        largest = std::max(largest, glm::length(glm::dvec3(model[joint][3])));
    }
    double length = -1.0;
    for (const MeshView& mesh : object.meshes) {
        double scale = mesh.joint < joints.size() ? longest_axis(model[mesh.joint]) : 0.0;
        const auto inverse_bind = mesh.palette.inverse_bind();
        for (std::size_t entry = 0; entry < inverse_bind.size(); ++entry) {
            const glm::dmat4& joint = model[mesh.palette.joints[entry]];
            const glm::dmat4 bind(inverse_bind[entry]);
            largest = std::max(largest, longest_axis(joint) * glm::length(glm::dvec3(bind[3])));
            scale = std::max(scale, longest_axis(joint * bind));
        }
        length = std::max(length, scale * length_of(mesh));
    }
    if (object.meshes.empty()) length = places.diagonal();
    return largest <= kLargest * length;  // false for NaN
}

bool is_for_kernels(const TrackView& track) {
    return track.interpolation == Interpolation::linear && track.keys >= 2 && track.path != TrackPath::weights;
}

/// Makes the groups of a clip.
class SamplePlanner {
public:
    explicit SamplePlanner(std::size_t joints) : rotations_(joints), translations_(joints), scales_(joints) {}

    SamplePlan make(const ClipView& clip) {
        for (const TrackView& track : clip.tracks) {
            if (is_for_kernels(track) && track.target < rotations_.size()) {
                placed(track.path)[track.target] = {&track, moment_of(track)};
            } else {
                plan_.others.push_back(&track);
            }
        }
        add_groups(TrackPath::rotation, 1);
        constexpr std::uint32_t kFew = 3;  // tracks: a group takes as long as this many
        add_groups(TrackPath::translation, kFew + 1);
        add_groups(TrackPath::scale, kFew + 1);
        return std::move(plan_);
    }

private:
    /// The track of a joint's property.
    struct Placed {
        const TrackView* track = nullptr;
        std::uint32_t moment = 0;
    };

    std::vector<Placed>& placed(TrackPath path) {
        if (path == TrackPath::rotation) return rotations_;
        return path == TrackPath::translation ? translations_ : scales_;
    }

    /// Returns the number of a moment at which a track's times are looked up: that of one of the last few, or a new
    /// one.
    std::uint32_t moment_of(const TrackView& track) {
        constexpr std::size_t kLast = 8;
        std::vector<const TrackView*>& clocks = plan_.clocks;
        for (std::size_t k = clocks.size(); k-- > clocks.size() - std::min(kLast, clocks.size());) {
            if (clocks[k]->times.data() == track.times.data() && clocks[k]->keys == track.keys)
                return static_cast<std::uint32_t>(k);
        }
        clocks.push_back(&track);
        return static_cast<std::uint32_t>(clocks.size() - 1);
    }

    /// \param least  blocks with fewer tracks have no group
    void add_groups(TrackPath path, std::ptrdiff_t least) {
        const std::span<const Placed> all(placed(path));
        for (std::size_t first = 0; first < all.size(); first += kBlockJoints) {
            const auto block = all.subspan(first, std::min<std::size_t>(kBlockJoints, all.size() - first));
            const auto count = std::count_if(block.begin(), block.end(), has_track);
            if (count == 0) continue;
            if (count >= least) {
                auto& groups = path == TrackPath::rotation ? plan_.rotations : plan_.vectors;
                groups.push_back(group_of(block, place_in_blocks(static_cast<std::uint32_t>(first), path)));
                continue;
            }
            for (const Placed& each : block) {
                if (each.track != nullptr)
                    plan_.tracks.push_back(
                        {each.track->values.data(), place_in_blocks(each.track->target, path), each.moment});
            }
        }
    }

    static bool has_track(const Placed& placed) { return placed.track != nullptr; }

    static TrackGroup group_of(std::span<const Placed> block, std::uint32_t place) {
        TrackGroup group{};
        group.place = place;
        group.is_full = true;
        group.is_one_moment = true;
        const Placed& any = *std::find_if(block.begin(), block.end(), has_track);
        for (std::size_t lane = 0; lane < kBlockJoints; ++lane) {
            const bool is_animated = lane < block.size() && has_track(block[lane]);
            const Placed& placed = is_animated ? block[lane] : any;
            group.keys[lane] = placed.track->values.data();
            group.moments[lane] = placed.moment;
            group.is_animated[lane] = is_animated ? -1 : 0;
            group.is_full = group.is_full && is_animated;
            group.is_one_moment = group.is_one_moment && placed.moment == any.moment;
        }
        return group;
    }

    SamplePlan plan_;
    std::vector<Placed> rotations_, translations_, scales_;  // per joint
};

SamplePlan make_sample_plan(const ClipView& clip, std::span<const JointTransform> rest) {
    SamplePlan plan = SamplePlanner(rest.size()).make(clip);
    if (clip.packed) plan.packed = make_unpack_plan(*clip.packed, rest);
    return plan;
}

}  // namespace

PosePlan make_pose_plan(const ObjectView& object, std::span<const Joint> joints) {
    PosePlan plan;
    std::vector<JointTransform> rest;
    rest.reserve(joints.size());
    for (const Joint& joint : joints) rest.push_back(joint.rest);
    plan.rest = to_blocks(rest);
    for (const MeshView& mesh : object.meshes) {
        for (const MorphTargetView& target : mesh.targets) plan.rest_weights.push_back(target.rest_weight);
    }
    plan_palettes(object.meshes, plan);
    plan.order.resize(joints.size());
    std::iota(plan.order.begin(), plan.order.end(), 0u);
    const std::vector<std::uint32_t> depths = depths_of(joints);
    std::stable_sort(plan.order.begin(), plan.order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return depths[a] < depths[b]; });
    plan.clips.reserve(object.clips.size());
    for (const ClipView& clip : object.clips) {
        plan.clips.push_back(make_sample_plan(clip, rest));
        plan.most_clocks = std::max(plan.most_clocks, plan.clips.back().clocks.size());
    }
    plan.fits_floats = fits_floats(object, joints);
    return plan;
}

}  // namespace bendy
