#include <bendy/format/joint.h>

#include <bendy/format/clip.h>
#include <bendy/format/read_record.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace bendy {
namespace {

void read_constraints(const ChunkTree& tree, std::uint32_t pivot, std::uint32_t joint,
                      std::vector<ConstraintView>& constraints, Faults& faults) {
    std::array<bool, kConstraintScopes> seen{};
    for (const std::uint32_t child : tree.children(pivot)) {
        ConstraintView constraint;
        if (!(tree[child].id == FourCC("LIMT")) || tree[child].is_container()) continue;
        if (!read_constraint(tree, child, joint, constraint, faults)) continue;
        if (seen[constraint.record.scope]) faults.add({ErrorCode::kConstraintRepeated, tree[child].offset, joint});
        seen[constraint.record.scope] = true;
        constraints.push_back(constraint);
    }
}

void read_chain_weights(const ChunkTree& tree, std::uint32_t pivot, std::uint32_t joint,
                        std::vector<ChainWeightView>& chain_weights, Faults& faults) {
    for (const std::uint32_t child : tree.children(pivot)) {
        if (!(tree[child].id == FourCC("PULL")) || tree[child].is_container()) continue;
        const Result<ChainWeightRecord> record = read_record<ChainWeightRecord>(tree, child);
        if (record) {
            chain_weights.push_back({*record, child, joint});
        } else {
            faults.add(record.error());
        }
    }
}

/// Reads PIVO: the rest transform into the joint's view, everything else into the skeleton's lists.
void read_pivot(const ChunkTree& tree, std::uint32_t skin, SkeletonView& skeleton, Faults& faults) {
    const std::uint32_t pivot = tree.find(skin, FourCC("PIVO"));
    if (pivot == kNone || !tree[pivot].is_container()) return;
    const auto joint = static_cast<std::uint32_t>(skeleton.joints.size() - 1);
    const auto rest = read_child_record<RestRecord>(tree, pivot, FourCC("REST"), faults);
    if (rest) skeleton.joints.back().rest = *rest;
    read_constraints(tree, pivot, joint, skeleton.constraints, faults);
    read_chain_weights(tree, pivot, joint, skeleton.chain_weights, faults);
}

void add_submesh(const ChunkTree& tree, std::uint32_t chunk, std::uint32_t joint, const SubmeshRecord& record,
                 std::vector<SubmeshView>& submeshes, Faults& faults) {
    const std::uint64_t offset = tree[chunk].offset;
    check_reserved(record.reserved, offset, faults);
    if (!check_enum(record.topology, kTopologies, offset, faults)) return;
    const auto topology = static_cast<Topology>(record.topology);
    if (record.count % corners(topology) != 0)
        faults.add({ErrorCode::kPolygonCut, offset, record.count, corners(topology)});
    submeshes.push_back({chunk, joint, record.mesh, record.material, topology, record.first, record.count});
}

void read_submeshes(const ChunkTree& tree, std::uint32_t chunk, std::uint32_t joint,
                    std::vector<SubmeshView>& submeshes, Faults& faults) {
    const Result<SubmeshRecord> record = read_record<SubmeshRecord>(tree, chunk);
    if (!record) {
        faults.add(record.error());
        return;
    }
    add_submesh(tree, chunk, joint, *record, submeshes, faults);
}

/// Reads JNTS, the table of all joints; a joint's own REST takes precedence.
void read_joint_table(const ChunkTree& tree, std::uint32_t chunk, SkeletonView& skeleton, Faults& faults) {
    skeleton.table = chunk;
    const std::uint64_t offset = tree[chunk].offset;
    const Result<JointsRecord> record = read_record<JointsRecord>(tree, chunk);
    if (!record) {
        faults.add(record.error());
        return;
    }
    check_reserved(record->reserved, offset, faults);
    const Bytes payload = tree.payload(chunk);
    const std::uint64_t polygons_at = sizeof(JointsRecord) + std::uint64_t{record->joints} * sizeof(RestRecord);
    const std::uint64_t size = polygons_at + std::uint64_t{record->submeshes} * sizeof(JointSubmesh);
    if (payload.size() != size) {
        faults.add({ErrorCode::kRecordSize, offset, payload.size(), size});
        return;
    }
    if (record->joints != skeleton.joints.size()) {
        faults.add({ErrorCode::kCountMismatch, offset, record->joints, skeleton.joints.size()});
        return;
    }
    for (std::uint32_t joint = 0; joint < record->joints; ++joint) {
        JointView& view = skeleton.joints[joint];
        const std::uint32_t pivot = tree.find(view.chunk, FourCC("PIVO"));
        if (pivot != kNone && tree.find(pivot, FourCC("REST")) != kNone) continue;
        copy_at(payload, sizeof(JointsRecord) + std::uint64_t{joint} * sizeof(RestRecord), view.rest);
    }
    for (std::uint32_t k = 0; k < record->submeshes; ++k) {
        JointSubmesh range;
        copy_at(payload, polygons_at + std::uint64_t{k} * sizeof range, range);
        if (range.joint >= record->joints) {
            faults.add({ErrorCode::kJointRange, offset, range.joint, record->joints});
            return;
        }
        add_submesh(tree, chunk, range.joint, range.submesh, skeleton.submeshes, faults);
    }
    std::stable_sort(skeleton.submeshes.begin(), skeleton.submeshes.end(),
                     [](const SubmeshView& a, const SubmeshView& b) { return a.joint < b.joint; });
}

/// Without JNTS, every joint must have its own rest transform.
void want_rests(const ChunkTree& tree, const SkeletonView& skeleton, Faults& faults) {
    for (const JointView& joint : skeleton.joints) {
        const std::uint32_t pivot = tree.find(joint.chunk, FourCC("PIVO"));
        if (pivot == kNone) {
            faults.add({ErrorCode::kChunkMissing, tree[joint.chunk].offset, FourCC("PIVO").value});
        } else if (tree[pivot].is_container() && tree.find(pivot, FourCC("REST")) == kNone) {
            faults.add({ErrorCode::kChunkMissing, tree[pivot].offset, FourCC("REST").value});
        }
    }
}

/// Reads JNAM: one name per joint, each followed by a zero; a joint's own NAME takes precedence.
void read_joint_names(const ChunkTree& tree, std::uint32_t object, SkeletonView& skeleton, Faults& faults) {
    const std::uint32_t chunk = tree.find(object, FourCC("JNAM"));
    if (chunk == kNone || tree[chunk].is_container()) return;
    const std::size_t faults_before = faults.count();
    std::string_view text = read_text(tree, object, FourCC("JNAM"), faults);
    if (faults.count() != faults_before) return;
    std::size_t named = 0;
    for (; !text.empty(); ++named) {
        const std::size_t end = text.find('\0');
        if (end == std::string_view::npos) break;
        if (named < skeleton.joints.size() && skeleton.joints[named].name.empty())
            skeleton.joints[named].name = text.substr(0, end);
        text.remove_prefix(end + 1);
    }
    if (named != skeleton.joints.size() || !text.empty())
        faults.add({ErrorCode::kCountMismatch, tree[chunk].offset, named, skeleton.joints.size()});
}

/// Returns the offset of the joint's rest transform: that of its REST, or of JNTS.
std::uint64_t rest_offset(const ChunkTree& tree, const SkeletonView& skeleton, std::uint32_t joint) {
    const std::uint32_t skin = skeleton.joints[joint].chunk;
    const std::uint32_t pivot = tree.find(skin, FourCC("PIVO"));
    const std::uint32_t rest = pivot == kNone ? kNone : tree.find(pivot, FourCC("REST"));
    if (rest != kNone) return tree[rest].offset;
    return tree[skeleton.table == kNone ? skin : skeleton.table].offset;
}

}  // namespace

SkeletonView read_skeleton(const ChunkTree& tree, std::uint32_t object, Faults& faults) {
    SkeletonView skeleton;
    struct Open {
        std::uint32_t end;  // first chunk after the joint
        std::uint32_t joint;
    };
    std::vector<Open> open;
    const std::uint32_t last = tree[object].end;
    for (std::uint32_t number = object + 1; number < last;) {
        while (!open.empty() && number >= open.back().end) open.pop_back();
        const Chunk& chunk = tree[number];
        const bool in_joint = !open.empty();
        if (chunk.id == FourCC("SKIN") && chunk.is_container()) {
            const auto joint = static_cast<std::uint32_t>(skeleton.joints.size());
            skeleton.joints.push_back(
                {number, in_joint ? open.back().joint : kNone, read_text(tree, number, FourCC("NAME"), faults),
                 RestRecord{}, read_text(tree, number, FourCC("EXTR"), faults),
                 read_text(tree, number, FourCC("EXTN"), faults), read_text(tree, number, FourCC("MORE"), faults)});
            read_pivot(tree, number, skeleton, faults);
            skeleton.first_local_material.push_back(static_cast<std::uint32_t>(skeleton.local_materials.size()));
            open.push_back({chunk.end, joint});
            ++number;  // continue with its children
            continue;
        }
        if (in_joint && chunk.id == FourCC("POLY") && !chunk.is_container()) {
            read_submeshes(tree, number, open.back().joint, skeleton.submeshes, faults);
        }
        // A joint's own materials. Those of its children come later in the file, so a joint's materials are consecutive
        // only if they come before its first SKIN; the table below requires that.
        if (in_joint && chunk.id == FourCC("MATE") && chunk.is_container()) {
            if (open.back().joint + 1 == skeleton.joints.size()) {
                skeleton.local_materials.push_back(number);
            } else {
                faults.add({ErrorCode::kChunkMisplaced, chunk.offset});
            }
        }
        number = chunk.end;
    }
    if (skeleton.joints.size() > kMaxJoints) {
        faults.add({ErrorCode::kTooManyJoints, tree[object].offset, skeleton.joints.size(), kMaxJoints});
    }
    const std::uint32_t table = tree.find(object, FourCC("JNTS"));
    if (table == kNone) {
        want_rests(tree, skeleton, faults);
    } else if (!tree[table].is_container()) {
        read_joint_table(tree, table, skeleton, faults);
    }
    read_joint_names(tree, object, skeleton, faults);
    return skeleton;
}

std::vector<std::uint32_t> depths_of(std::span<const JointView> joints) {
    std::vector<std::uint32_t> depths(joints.size());
    for (std::size_t joint = 0; joint < joints.size(); ++joint) {
        const std::uint32_t parent = joints[joint].parent;
        depths[joint] = parent == kNone ? 0 : depths[parent] + 1;
    }
    return depths;
}

void check_skeleton_values(const ChunkTree& tree, const SkeletonView& skeleton, Faults& faults) {
    for (std::uint32_t joint = 0; joint < skeleton.joints.size(); ++joint) {
        const std::uint64_t offset = rest_offset(tree, skeleton, joint);
        const RestRecord& rest = skeleton.joints[joint].rest;
        check_finite(rest.translation, offset, faults);
        check_finite(rest.scale, offset, faults);
        check_finite(rest.shear, offset, faults);
        if (!is_unit(rest.rotation, kUnitTolerance)) faults.add({ErrorCode::kRotationNotUnit, offset, joint});
    }
    for (const ConstraintView& constraint : skeleton.constraints)
        check_constraint(constraint.record, constraint.joint, tree[constraint.chunk].offset, faults);
    for (const ChainWeightView& chain_weight : skeleton.chain_weights) {
        if (!(chain_weight.weight >= 0.0f && chain_weight.weight <= 1.0f)) {
            faults.add(
                {ErrorCode::kFractionRange, tree[chain_weight.chunk].offset, offsetof(ChainWeightRecord, weight)});
        }
    }
}

}  // namespace bendy
