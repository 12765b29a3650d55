#include <bendy/format/joint.h>

#include <bendy/format/cycle.h>
#include <bendy/format/read_record.h>
#include <bendy/format/text.h>

#include <cstddef>

namespace bendy {
namespace {

void read_limits(const ChunkTree& tree, std::uint32_t pivot, std::uint32_t joint, std::vector<LimitView>& limits,
                 Faults& faults) {
    std::array<bool, kLimitScopes> seen{};
    for (const std::uint32_t child : tree.children(pivot)) {
        LimitView limit;
        if (!(tree[child].id == FourCC("LIMT")) || tree[child].is_container()) continue;
        if (!read_limit(tree, child, joint, limit, faults)) continue;
        if (seen[limit.record.scope]) faults.add({ErrorCode::kLimitRepeated, tree[child].offset, joint});
        seen[limit.record.scope] = true;
        limits.push_back(limit);
    }
}

void read_pulls(const ChunkTree& tree, std::uint32_t pivot, std::uint32_t joint, std::vector<PullView>& pulls,
                Faults& faults) {
    for (const std::uint32_t child : tree.children(pivot)) {
        if (!(tree[child].id == FourCC("PULL")) || tree[child].is_container()) continue;
        const Result<PullRecord> record = read_record<PullRecord>(tree, child);
        if (record) {
            pulls.push_back({child, joint, record->chain, record->weight});
        } else {
            faults.add(record.error());
        }
    }
}

/// PIVO: the rest transform goes to the joint's view, the rest to the skeleton's lists.
void read_pivot(const ChunkTree& tree, std::uint32_t skin, SkeletonView& skeleton, Faults& faults) {
    const std::uint32_t pivot = tree.find(skin, FourCC("PIVO"));
    if (pivot == kNone || !tree[pivot].is_container()) return;
    const auto joint = static_cast<std::uint32_t>(skeleton.joints.size() - 1);
    skeleton.joints.back().rest =
        read_child_record<RestRecord>(tree, pivot, FourCC("REST"), faults).value_or(RestRecord{});
    read_limits(tree, pivot, joint, skeleton.limits, faults);
    read_pulls(tree, pivot, joint, skeleton.pulls, faults);
}

void read_polygons(const ChunkTree& tree, std::uint32_t chunk, std::uint32_t joint, std::vector<PolygonView>& polygons,
                   Faults& faults) {
    const Result<PolygonRecord> record = read_record<PolygonRecord>(tree, chunk);
    if (!record) {
        faults.add(record.error());
        return;
    }
    const std::uint64_t offset = tree[chunk].offset;
    check_reserved(record->reserved, offset, faults);
    if (!check_enum(record->topology, kTopologies, offset, faults)) return;
    const auto topology = static_cast<Topology>(record->topology);
    if (record->count % corners(topology) != 0)
        faults.add({ErrorCode::kPolygonCut, offset, record->count, corners(topology)});
    polygons.push_back({chunk, joint, record->pool, record->material, topology, record->first, record->count});
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
            skeleton.joints.push_back({number, in_joint ? open.back().joint : kNone,
                                       read_text(tree, number, FourCC("NAME"), faults), RestRecord{},
                                       read_text(tree, number, FourCC("EXTR"), faults),
                                       read_text(tree, number, FourCC("EXTN"), faults)});
            read_pivot(tree, number, skeleton, faults);
            skeleton.first_local_material.push_back(static_cast<std::uint32_t>(skeleton.local_materials.size()));
            open.push_back({chunk.end, joint});
            ++number;  // into it
            continue;
        }
        if (in_joint && chunk.id == FourCC("POLY") && !chunk.is_container()) {
            read_polygons(tree, number, open.back().joint, skeleton.polygons, faults);
        }
        // A joint's own materials; its children's come later in the file, so a joint's are consecutive only if they
        // stand before its first SKIN, which is where the table below needs them.
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
    return skeleton;
}

void check_skeleton_values(const ChunkTree& tree, const SkeletonView& skeleton, Faults& faults) {
    for (std::uint32_t joint = 0; joint < skeleton.joints.size(); ++joint) {
        const JointView& view = skeleton.joints[joint];
        const std::uint32_t pivot = tree.find(view.chunk, FourCC("PIVO"));
        const std::uint64_t offset = pivot == kNone ? tree[view.chunk].offset : offset_of(tree, pivot, FourCC("REST"));
        const RestRecord& rest = view.rest;
        check_finite(rest.translation, offset, faults);
        check_finite(rest.scale, offset, faults);
        check_finite(rest.shear, offset, faults);
        if (!is_unit(rest.rotation, kUnitTolerance)) faults.add({ErrorCode::kRotationNotUnit, offset, joint});
    }
    for (const LimitView& limit : skeleton.limits)
        check_limit(limit.record, limit.joint, tree[limit.chunk].offset, faults);
    for (const PullView& pull : skeleton.pulls) {
        if (!(pull.weight >= 0.0f && pull.weight <= 1.0f))
            faults.add({ErrorCode::kFractionRange, tree[pull.chunk].offset, offsetof(PullRecord, weight)});
    }
}

}  // namespace bendy
