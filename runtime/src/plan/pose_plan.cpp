#include "pose_plan.h"

#include <bendy/runtime/model.h>

#include "layout.h"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace bendy {
namespace {

/// Returns, for each joint, the number after the last joint below it: these follow it.
std::vector<std::uint32_t> ends_of(std::span<const Joint> joints) {
    std::vector<std::uint32_t> ends(joints.size());
    for (auto joint = static_cast<std::uint32_t>(joints.size()); joint-- > 0;) {
        ends[joint] = std::max(ends[joint], joint + 1);
        const std::uint32_t parent = joints[joint].parent;
        if (parent != kNone) ends[parent] = std::max(ends[parent], ends[joint]);
    }
    return ends;
}

bool is_same(const PaletteView& a, const PaletteView& b) {
    const auto x = a.inverse_bind();
    const auto y = b.inverse_bind();
    return std::equal(a.joints.begin(), a.joints.end(), b.joints.begin(), b.joints.end()) &&
           std::equal(x.begin(), x.end(), y.begin(), y.end());
}

/// Returns the upper three rows with numbers of no weight set to zero: exporters write many that are nearly zero, and
/// their products are denormal, which costs some processors a hundred cycles each.
PaletteMatrix without_tiny(const glm::mat4& matrix) {
    PaletteMatrix entry = to_rows(matrix);
    float largest = 0.0f;
    for (const auto& row : entry.rows) {
        for (const float number : row) largest = std::max(largest, std::abs(number));
    }
    constexpr float kWeightless = 0x1p-60f;  // far below a rounding
    for (auto& row : entry.rows) {
        for (float& number : row) number = std::abs(number) < kWeightless * largest ? 0.0f : number;
    }
    return entry;
}

/// Parts of a mesh usually follow the same skeleton: each mesh is compared with the last one that had a different
/// palette.
void plan_palettes(std::span<const MeshView> meshes, PosePlan& plan) {
    std::uint32_t first = 0;
    for (std::uint32_t number = 0; number < meshes.size(); ++number) {
        const PaletteView& palette = meshes[number].palette;
        if (number == 0 || !is_same(palette, meshes[first].palette)) first = number;
        plan.same_palette.push_back(first);
        std::vector<PaletteMatrix>& rows = plan.inverse_bind.emplace_back();
        if (first != number) continue;
        const auto inverse_bind = palette.inverse_bind();
        rows.reserve(inverse_bind.size());
        std::transform(inverse_bind.begin(), inverse_bind.end(), std::back_inserter(rows), without_tiny);
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
    /// Returns the length of the diagonal; negative if the box is empty.
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
    const std::vector<std::uint32_t> depths = depths_of(object.skeleton.joints);
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
    return track.interpolation != Interpolation::step && track.keys >= 2 && track.path != TrackPath::weights;
}

/// Adds a track to the group of its block of joints: one of the last few, or a new one.
void add_to_group(const TrackView& track, std::vector<TrackGroup>& groups) {
    constexpr std::ptrdiff_t kLast = 8;
    const std::uint32_t lane = track.target % kBlockJoints;
    const std::uint32_t place = place_of(track.target - lane, track.path);
    const auto first = groups.end() - std::min<std::ptrdiff_t>(kLast, std::ssize(groups));
    auto group = std::find_if(first, groups.end(), [&](const TrackGroup& each) { return each.place == place; });
    if (group == groups.end()) {
        groups.push_back({{}, {}, 0, place});
        group = groups.end() - 1;
        std::fill_n(group->keys, kBlockJoints, track.values.data());
    }
    group->keys[lane] = track.values.data();
    if (group->has_track[lane] == 0) ++group->count;
    group->has_track[lane] = kAllBits;
}

void add_track(const TrackView& track, SampleGroups& groups) {
    if (track.path == TrackPath::rotation) return add_to_group(track, groups.rotations);
    if (track.interpolation != Interpolation::cubic) return add_to_group(track, groups.vectors);
    groups.tracks.push_back({track.values.data(), place_of(track.target, track.path)});
}

constexpr std::uint32_t kLeast = 3;  ///< tracks that are worth a group of their own

void add_timed(const TrackGroup& group, const SampleLine& line, bool is_rotation, TimedGroup& to) {
    to.is_rotation = is_rotation;
    to.tracks.place = group.place;
    for (std::uint32_t lane = 0; lane < kBlockJoints; ++lane) {
        if (group.has_track[lane] == 0) continue;
        to.tracks.keys[lane] = group.keys[lane];
        to.tracks.count += to.tracks.has_track[lane] == 0 ? 1 : 0;
        to.tracks.has_track[lane] = kAllBits;
        to.times[lane] = line.clock->times.data();
        to.keys[lane] = line.clock->keys;
    }
}

void fill_lanes(TimedGroup& group) {
    const auto* const has_track = group.tracks.has_track;
    const auto first = std::find(has_track, has_track + kBlockJoints, kAllBits) - has_track;
    for (std::uint32_t lane = 0; lane < kBlockJoints; ++lane) {
        if (has_track[lane] != 0) continue;
        group.tracks.keys[lane] = group.tracks.keys[first];
        group.times[lane] = group.times[first];
        group.keys[lane] = group.keys[first];
    }
}

/// Joins small groups of a block with different times.
void join_small(SamplePlan& plan, std::size_t joints) {
    if (plan.lines.size() < 2) return;
    const auto is_small = [](const TrackGroup& group) { return group.count < kLeast; };
    constexpr std::uint32_t kOne = 1, kTaken = 0x8000'0000;
    // By place: how many groups are small; then, with kTaken, the number of the timed group that has them.
    std::vector<std::uint32_t> places((joints / kBlockJoints + 1) * kBlockFloats / kBlockJoints);
    for (const bool counts : {true, false}) {
        const auto visit = [&](const SampleLine& line, std::vector<TrackGroup>& groups, bool is_rotation) {
            std::erase_if(groups, [&](const TrackGroup& group) {
                std::uint32_t& place = places[group.place / kBlockJoints];
                if (counts) place += is_small(group) ? kOne : 0;
                if (counts || !is_small(group) || place == kOne) return false;
                if (place < kTaken) {
                    place = kTaken + static_cast<std::uint32_t>(plan.timed.size());
                    plan.timed.emplace_back();
                }
                add_timed(group, line, is_rotation, plan.timed[place - kTaken]);
                return true;
            });
        };
        for (SampleLine& line : plan.lines) {
            if (line.clock->times.empty()) continue;
            visit(line, line.linear.rotations, true);
            visit(line, line.linear.vectors, false);
        }
    }
    for (TimedGroup& group : plan.timed) fill_lanes(group);
}

/// Turns small groups of vectors into single tracks.
void split_small(SampleGroups& groups) {
    for (const TrackGroup& group : groups.vectors) {
        if (group.count >= kLeast) continue;
        for (std::uint32_t lane = 0; lane < kBlockJoints; ++lane) {
            if (group.has_track[lane] != 0) groups.tracks.push_back({group.keys[lane], group.place + lane});
        }
    }
    std::erase_if(groups.vectors, [](const TrackGroup& group) { return group.count < kLeast; });
}

/// Returns the line with a track's times: one of the last few, or a new one.
SampleLine& line_of(const TrackView& track, std::vector<SampleLine>& lines) {
    constexpr std::ptrdiff_t kLast = 8;
    const auto first = lines.end() - std::min<std::ptrdiff_t>(kLast, std::ssize(lines));
    const auto found = std::find_if(first, lines.end(), [&](const SampleLine& line) {
        return line.clock->times.data() == track.times.data() && line.clock->keys == track.keys;
    });
    if (found != lines.end()) return *found;
    lines.emplace_back().clock = &track;
    return lines.back();
}

/// Returns whether a track of a joint has one value, but for float rounding: exporters write a constant as two keys
/// that differ by it. Of longer tracks, reading all keys would take too long.
bool is_constant(const TrackView& track) {
    if (track.path == TrackPath::weights || track.interpolation == Interpolation::cubic || track.keys > 2) return false;
    constexpr float kRounding = 4.0f * std::numeric_limits<float>::epsilon();  // of the largest number
    float largest = 0.0f;
    float difference = 0.0f;
    const std::size_t last = (track.keys - std::size_t{1}) * track.components;
    for (std::size_t c = 0; c < track.components; ++c) {
        largest = std::max(largest, std::abs(track.values[c]));
        difference = std::max(difference, std::abs(track.values[last + c] - track.values[c]));
    }
    return difference <= kRounding * largest;
}

void set_constant(const TrackView& track, std::span<JointBlock> start) {
    const std::uint32_t place = place_of(track.target, track.path);
    float* const to = &start.front().rotation[0][0] + place;
    for (std::size_t c = 0; c < track.components; ++c) to[kBlockJoints * c] = track.values[c];
}

void add_tracks(std::span<const TrackView> tracks, std::size_t joints, SamplePlan& plan,
                std::vector<JointBlock>& start) {
    for (const TrackView& track : tracks) {
        if (is_constant(track)) {
            set_constant(track, start);
            continue;
        }
        SampleLine& line = line_of(track, plan.lines);
        if (!is_for_kernels(track)) {
            line.others.push_back(&track);
        } else if (track.interpolation == Interpolation::cubic) {
            add_track(track, line.cubic);
            line.cubic_tracks.push_back(&track);
        } else {
            add_track(track, line.linear);
        }
    }
    join_small(plan, joints);
    for (SampleLine& line : plan.lines) split_small(line.linear);
    std::erase_if(plan.lines, [](const SampleLine& line) {
        return line.linear.is_empty() && line.cubic_tracks.empty() && line.others.empty();
    });
}

SamplePlan make_sample_plan(const ClipView& clip, std::span<const JointTransform> rest) {
    SamplePlan plan;
    if (clip.packed) {
        plan.packed = make_unpack_plan(*clip.packed, rest);
        add_tracks(clip.tracks, rest.size(), plan, plan.packed.start);
    } else if (std::any_of(clip.tracks.begin(), clip.tracks.end(), is_constant)) {
        plan.start = to_blocks(rest);
        add_tracks(clip.tracks, rest.size(), plan, plan.start);
    } else {
        add_tracks(clip.tracks, rest.size(), plan, plan.start);
    }
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
    plan.subtree_ends = ends_of(joints);
    plan.order.resize(joints.size());
    std::iota(plan.order.begin(), plan.order.end(), 0u);
    const std::vector<std::uint32_t> depths = depths_of(object.skeleton.joints);
    std::stable_sort(plan.order.begin(), plan.order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return depths[a] < depths[b]; });
    plan.clips.reserve(object.clips.size());
    for (const ClipView& clip : object.clips) {
        plan.clips.push_back(make_sample_plan(clip, rest));
        plan.most_timed = std::max(plan.most_timed, plan.clips.back().timed.size());
    }
    plan.fits_floats = fits_floats(object, joints);
    return plan;
}

}  // namespace bendy
