#include "pose_plan.h"

#include <bendy/runtime/model.h>

#include "palette_rows.h"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

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
    return track.interpolation != Interpolation::step && track.keys >= 2 && track.path != TrackPath::weights;
}

void add_rotation(const TrackView& track, SampleGroups& groups) {
    const std::size_t lane = groups.rotation_tracks++ % RotationTracks::kMost;
    if (lane == 0) groups.rotations.emplace_back();
    for (std::size_t k = lane; k < RotationTracks::kMost; ++k) {
        groups.rotations.back().keys[k] = track.values.data();
        groups.rotations.back().places[k] = kJointFloats * track.target;
    }
}

void add_track(const TrackView& track, SampleGroups& groups) {
    if (track.path == TrackPath::rotation) return add_rotation(track, groups);
    const std::uint32_t place = track.path == TrackPath::translation ? 4 : 7;
    groups.vectors.push_back({track.values.data(), kJointFloats * track.target + place});
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

SamplePlan make_sample_plan(const ClipView& clip, std::span<const JointTransform> rest) {
    SamplePlan plan;
    if (clip.packed) plan.packed = make_unpack_plan(*clip.packed, rest);
    for (const TrackView& track : clip.tracks) {
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
    return plan;
}

}  // namespace

PosePlan make_pose_plan(const ObjectView& object, std::span<const Joint> joints) {
    PosePlan plan;
    plan.rest.reserve(joints.size());
    for (const Joint& joint : joints) plan.rest.push_back(joint.rest);
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
    for (const ClipView& clip : object.clips) plan.clips.push_back(make_sample_plan(clip, plan.rest));
    plan.fits_floats = fits_floats(object, joints);
    return plan;
}

}  // namespace bendy
