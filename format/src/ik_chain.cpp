#include <bendy/format/ik_chain.h>

#include <bendy/format/clip.h>
#include <bendy/format/read_record.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>

namespace bendy {
namespace {

/// Returns for each joint the first one after its descendants: in pre-order these are [joint, end).
std::vector<std::uint32_t> find_ends(const SkeletonView& skeleton) {
    const auto joints = static_cast<std::uint32_t>(skeleton.joints.size());
    std::vector<std::uint32_t> ends(joints);
    for (std::uint32_t joint = joints; joint-- > 0;) {
        ends[joint] = std::max(ends[joint], joint + 1);
        const std::uint32_t parent = skeleton.joints[joint].parent;
        if (parent != kNone) ends[parent] = std::max(ends[parent], ends[joint]);
    }
    return ends;
}

/// Reads KINF into the view; returns false if it is missing or refers to something invalid. `ends`: see find_ends.
bool read_record_of(const ChunkTree& tree, ChainView& chain, std::span<const std::uint32_t> ends,
                    std::span<const std::uint32_t> depths, Faults& faults) {
    const auto record = read_child_record<ChainRecord>(tree, chain.chunk, FourCC("KINF"), faults);
    if (!record) return false;
    chain.record = *record;
    const std::uint64_t offset = offset_of(tree, chain.chunk, FourCC("KINF"));
    check_reserved(record->reserved, offset, faults);
    check_enum(record->solver, kSolvers, offset, faults);
    check_enum(record->flags, kChainFlags, offset, faults);
    bool in_range = true;
    const auto check_joint = [&](std::uint32_t joint) {
        if (joint < ends.size()) return;
        in_range = false;
        faults.add({ErrorCode::kJointRange, offset, joint, ends.size()});
    };
    check_joint(record->start);
    check_joint(record->effector);
    if (record->target != kNone) check_joint(record->target);
    if (record->pole != kNone) check_joint(record->pole);
    if (!in_range) return false;
    const bool is_above = record->start <= record->effector && record->effector < ends[record->start];
    if (!is_above) {
        faults.add({ErrorCode::kChainPath, offset, record->start, record->effector});
        return false;
    }
    chain.links = depths[record->effector] - depths[record->start] + 1;
    return true;
}

/// Checks the joints' weights against the chains.
void check_chain_weights(const ChunkTree& tree, const SkeletonView& skeleton, std::span<const ChainView> chains,
                         std::span<const std::uint32_t> ends, Faults& faults) {
    std::vector<const ChainWeightView*> good;
    for (const ChainWeightView& chain_weight : skeleton.chain_weights) {
        const std::uint64_t offset = tree[chain_weight.chunk].offset;
        if (chain_weight.chain >= chains.size()) {
            faults.add({ErrorCode::kChainRange, offset, chain_weight.chain, chains.size()});
            continue;
        }
        const ChainRecord& chain = chains[chain_weight.chain].record;
        const bool is_link =
            chain.start <= chain_weight.joint && chain_weight.joint <= chain.effector &&
            chain.effector < ends[chain_weight.joint];  // the effector or one of its ancestors, but not above the start
        if (!is_link) faults.add({ErrorCode::kChainWeightPath, offset, chain_weight.joint, chain_weight.chain});
        good.push_back(&chain_weight);
    }
    const auto key = [](const ChainWeightView* chain_weight) {
        return std::tie(chain_weight->joint, chain_weight->chain);
    };
    std::stable_sort(good.begin(), good.end(),
                     [&](const ChainWeightView* a, const ChainWeightView* b) { return key(a) < key(b); });
    for (std::size_t i = 1; i < good.size(); ++i) {
        if (key(good[i - 1]) == key(good[i]))
            faults.add({ErrorCode::kChainWeightRepeated, tree[good[i]->chunk].offset, good[i]->joint, good[i]->chain});
    }
}

}  // namespace

std::vector<ChainView> read_chains(const ChunkTree& tree, std::uint32_t object, const SkeletonView& skeleton,
                                   Faults& faults) {
    const std::vector<std::uint32_t> ends = find_ends(skeleton);
    const std::vector<std::uint32_t> depths = depths_of(skeleton.joints);
    std::vector<ChainView> chains;
    bool are_sound = true;  // otherwise weights cannot be checked against them
    for (const std::uint32_t child : tree.children(object)) {
        if (!(tree[child].id == FourCC("IKCH")) || !tree[child].is_container()) continue;
        ChainView& chain = chains.emplace_back();
        chain.chunk = child;
        chain.name = read_text(tree, child, FourCC("NAME"), faults);
        chain.extras = read_text(tree, child, FourCC("EXTR"), faults);
        are_sound = read_record_of(tree, chain, ends, depths, faults) && are_sound;
    }
    if (are_sound) check_chain_weights(tree, skeleton, chains, ends, faults);
    return chains;
}

void check_chain_values(const ChunkTree& tree, const ChainView& chain, Faults& faults) {
    const std::uint64_t offset = offset_of(tree, chain.chunk, FourCC("KINF"));
    const ChainRecord& record = chain.record;
    check_finite(std::array{record.tolerance}, offset, faults);
    check_finite(record.pole_vector, offset, faults);
    check_finite(std::array{record.pole_angle}, offset, faults);
    check_finite(record.tip_offset, offset, faults);
    check_finite(std::array{record.stretch}, offset, faults);
    if (!is_unit(record.tip_rotation, kUnitTolerance))
        faults.add({ErrorCode::kRotationNotUnit, offset, record.effector});
    const auto check_fraction = [&](float number, std::size_t at) {
        if (!(number >= 0.0f && number <= 1.0f)) faults.add({ErrorCode::kFractionRange, offset, at});
    };
    check_fraction(record.position_weight, offsetof(ChainRecord, position_weight));
    check_fraction(record.rotation_weight, offsetof(ChainRecord, rotation_weight));
    check_fraction(record.influence, offsetof(ChainRecord, influence));
    check_fraction(record.compress, offsetof(ChainRecord, compress));
    const auto check_not_negative = [&](float number, std::size_t at) {
        if (std::isfinite(number) && number < 0.0f) faults.add({ErrorCode::kBelowZero, offset, at});
    };
    check_not_negative(record.tolerance, offsetof(ChainRecord, tolerance));
    check_not_negative(record.stretch, offsetof(ChainRecord, stretch));
}

}  // namespace bendy
