#include "leaf_form.h"

#include <bendy/format/packed_clip.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace bendy::text_form {
namespace {

/// "steps_3"
std::string numbered(std::string_view name, std::uint64_t number) {
    return std::string(name).append(1, '_').append(std::to_string(number));
}

/// The levels of LODD, and the data of each of its meshes.
bool walk_levels(LeafSteps& steps) {
    CollapseRecord collapse;
    copy_at(steps.payload(), 0, collapse);
    NumberArray table{"table", NumberType::u32, std::uint64_t{collapse.levels} * (std::uint64_t{1} + collapse.meshes)};
    table.row = std::uint64_t{1} + collapse.meshes;
    table.starts_with_f32 = true;
    table.is_padded = true;
    if (!steps.array(table)) return false;
    for (std::uint32_t k = 0; k < collapse.meshes; ++k) {
        MeshCollapseRecord mesh;
        copy_at(steps.payload(), sizeof collapse + k * sizeof mesh, mesh);
        const std::string targets = numbered("targets", k);
        const auto count = steps.collapsed_vertices(mesh, targets);
        const auto type =
            mesh.target_type == static_cast<std::uint8_t>(ComponentType::u16) ? NumberType::u16 : NumberType::u32;
        if (!count || !steps.array({targets, type, *count, 12, false, true})) return false;
        const std::string joined = numbered("joined", k);
        if (!steps.array({joined, NumberType::u8, (*count + 7) / 8, 24, false, true})) return false;
    }
    return true;
}

/// Returns the contents of a row of a segment's frames: the width of each number, in file order.
std::vector<std::uint32_t> frame_widths(std::span<const std::byte> widths, std::uint32_t tracks,
                                        std::uint32_t components) {
    std::vector<std::uint32_t> in_order;
    in_order.reserve(widths.size());
    for (std::uint64_t first = 0; first < tracks; first += kPackedGroup) {
        const std::uint64_t last = std::min<std::uint64_t>(first + kPackedGroup, tracks);
        for (std::uint64_t c = 0; c < components; ++c) {
            for (std::uint64_t track = first; track < last; ++track)
                in_order.push_back(std::to_integer<std::uint32_t>(widths[c * tracks + track]));
        }
    }
    return in_order;
}

/// Returns the numbers per line: one of each track, if there are enough.
std::uint64_t packed_row(std::uint32_t tracks) {
    constexpr std::uint32_t kUsual = 12;
    return tracks < kUsual ? kUsual : tracks;
}

bool walk_packed_segments(LeafSteps& steps, const PackRecord& packed,
                          const std::array<std::uint32_t, kPackedLists>& tracks) {
    const bool has_several = packed.segment_frames != 0 && packed.frames >= 2;
    const std::uint32_t segments = has_several ? (packed.frames - 2) / packed.segment_frames + 1 : 1;
    if (segments > 1 && !steps.array({"starts", NumberType::u32, segments})) return false;
    for (std::uint32_t s = 0; s < segments; ++s) {
        std::vector<std::uint32_t> widths;
        for (std::size_t k = 0; k < kPackedLists; ++k) {
            if (!kPackedKinds[k].animated || tracks[k] == 0) continue;
            const std::string suffix = numbered("", s) + numbered("", k);
            const std::uint64_t count = std::uint64_t{tracks[k]} * kPackedKinds[k].components;
            const std::uint64_t at = steps.payload_done();
            if (!steps.array({"widths" + suffix, NumberType::u8, count, packed_row(tracks[k])})) return false;
            const auto list = frame_widths(steps.payload().subspan(at, count), tracks[k], kPackedKinds[k].components);
            widths.insert(widths.end(), list.begin(), list.end());
            const auto base = (packed.wide >> k & 1u) != 0 ? NumberType::i32 : NumberType::i16;
            if (!steps.array({"bases" + suffix, base, count, packed_row(tracks[k])})) return false;
        }
        const std::uint32_t first = s * packed.segment_frames;
        const std::uint64_t frames =
            s + 1 < segments ? packed.segment_frames + std::uint64_t{1} : packed.frames - first;
        if (!steps.packed_frames(numbered("frames", s), widths, frames)) return false;
    }
    return steps.zeros(kPackedTail);
}

/// PACK after its record: a payload that violates the layout is written as bytes.
bool walk_packed(LeafSteps& steps) {
    PackRecord packed;
    copy_at(steps.payload(), 0, packed);
    if (!steps.has_packed_tracks()) return steps.bytes("tracks");
    std::array<std::uint32_t, kPackedLists> tracks{};
    bool is_animated = false;
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        if ((packed.lists >> k & 1u) == 0) continue;
        if (!steps.joint_bits(numbered("joints", k), packed.joints, tracks[k])) return false;
        is_animated = is_animated || (kPackedKinds[k].animated && tracks[k] != 0);
    }
    for (const bool is_steps : {true, false}) {
        for (std::size_t k = 0; k < kPackedLists; ++k) {
            if (tracks[k] == 0 || (!is_steps && kPackedKinds[k].animated)) continue;
            const auto base = (packed.wide >> k & 1u) != 0 ? NumberType::i32 : NumberType::i16;
            const std::uint64_t count = std::uint64_t{tracks[k]} * kPackedKinds[k].components;
            const std::string name = numbered(is_steps ? "steps" : "bases", k);
            if (!steps.array({name, is_steps ? NumberType::u8 : base, count, packed_row(tracks[k])})) return false;
        }
    }
    if (packed.frame_rate == 0.0f && !steps.array({"times", NumberType::f32, packed.frames})) return false;
    return is_animated ? walk_packed_segments(steps, packed, tracks) : steps.zeros(kPackedTail);
}

bool walk_odd(FourCC chunk, LeafSteps& steps) {
    if (chunk == FourCC("LODD")) return walk_levels(steps);
    if (chunk == FourCC("PACK")) return walk_packed(steps);
    return false;
}

/// Returns the numbers per line: a row or, for single numbers, several.
std::uint64_t line_of(const LeafPart& part, const PartShape& shape) {
    constexpr std::uint64_t kUsual = 12;
    constexpr std::uint64_t kTriangle = 3;
    if (shape.row > 1) return shape.row;
    return part.row == "1" ? kUsual : kTriangle;
}

bool walk_part(const LeafLayout& leaf, const LeafPart& part, LeafSteps& steps) {
    if (part.kind == PartKind::odd) return walk_odd(leaf.chunk, steps);
    if (part.kind == PartKind::record) return steps.record(*find_layout(part.type));
    const auto shape = shape_of(leaf, part, steps.payload());
    if (!shape) return false;
    if (!shape->is_there) return true;
    switch (part.kind) {
        case PartKind::records:
            return steps.records(part.name, *shape->record, shape->count);
        case PartKind::text:
            return steps.text(leaf.parts.size() == 1 ? std::string_view() : part.name, shape->count);
        case PartKind::names:
            return steps.names(part.name);
        case PartKind::bytes:
            return steps.bytes(part.name);
        default:
            return steps.array({part.name, shape->type, shape->count, line_of(part, *shape), false,
                                part.ending == PartEnding::padded});
    }
}

}  // namespace

void walk_leaf(FourCC chunk, LeafSteps& steps) {
    const LeafLayout* leaf = find_leaf(chunk);
    if (leaf == nullptr) return;
    if (chunk == FourCC("MARK")) {
        steps.markers();
        return;
    }
    for (const LeafPart& part : leaf->parts) {
        if (!walk_part(*leaf, part, steps)) return;
    }
}

}  // namespace bendy::text_form
