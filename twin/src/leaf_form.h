#pragma once

#include "number_text.h"

#include <bendy/format/packed_cycle.h>
#include <bendy/format/record_table.h>
#include <bendy/format/records.h>

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// The form of every leaf, once for both directions: what follows what in the payload, and under which name it stands in
// the text. LeafDumper and LeafAssembler walk the same form; a step that fails ends the walk, and the rest of the
// payload is "more", in hexadecimal digits.
//
//     Io::record(layout, struct)    the record at the payload's start
//     Io::array(array)              numbers
//     Io::records(name, layout, n)  an array of records
//     Io::bytes(name)               all that is left
//     Io::plain_record(layout)      a record and nothing else
//     Io::text(), Io::names()       UTF-8; names with a zero behind each
//     Io::markers()                 all of MARK
//     Io::payload()                 all of it, or what has been assembled so far; payload_done() is how far we are
//     Io::joint_bits, packed_frames, zeros, has_packed_tracks   the parts of PACK
//     Io::collapsed_vertices(pool, name)  how many targets LODD has of a pool; the file does not say it in one place
namespace bendy::twin {

/// All that is left of the payload, or all that the text has.
inline constexpr std::uint64_t kTheRest = std::numeric_limits<std::uint64_t>::max();

/// Numbers in a row.
struct NumberArray {
    std::string_view name;
    NumberType type = NumberType::f32;
    std::uint64_t count = kTheRest;
    std::uint64_t row = 12;        ///< numbers on a line
    bool starts_with_f32 = false;  ///< each row's first number is an f32, whatever the type
    bool is_padded = false;        ///< zeros behind it, up to a multiple of 16 from the payload's start
};

/// "steps_3"
inline std::string numbered(std::string_view name, std::uint64_t number) {
    return std::string(name).append(1, '_').append(std::to_string(number));
}

/// JNTS: a JointPolygons as one record.
const RecordLayout& joint_polygons_layout();

template <class Io>
void walk_stream(Io& io) {
    StreamRecord stream;
    if (!io.record(*find_layout("StreamRecord"), stream)) return;
    if (stream.component_type >= kComponentTypes || stream.components == 0) return;
    const auto type = static_cast<ComponentType>(stream.component_type);
    if (stream.normalised == static_cast<std::uint8_t>(Numbers::boxed)) {
        if (!io.array({"box", NumberType::f32, std::uint64_t{stream.components} * 2, 2, false, true})) return;
    }
    constexpr std::uint64_t kTriangle = 3;
    NumberArray values{"values", number_type(type), std::uint64_t{stream.elements} * stream.components};
    values.row = stream.components > 1 ? stream.components : kTriangle;
    io.array(values);
}

template <class Io>
void walk_palette(Io& io) {
    constexpr std::uint64_t kMatrix = 16;
    PaletteRecord palette;
    if (!io.record(*find_layout("PaletteRecord"), palette)) return;
    if (!io.array({"joints", NumberType::u32, palette.entries, 12, false, true})) return;
    const std::uint64_t matrices = palette.derived == 1 ? 1 : palette.entries;
    io.array({"matrices", NumberType::f32, matrices * kMatrix, kMatrix});
}

template <class Io>
void walk_joints(Io& io) {
    JointsRecord table;
    if (!io.record(*find_layout("JointsRecord"), table)) return;
    if (!io.records("rests", *find_layout("RestRecord"), table.joints)) return;
    io.records("ranges", joint_polygons_layout(), table.polygons);
}

template <class Io>
void walk_collapse(Io& io) {
    CollapseRecord collapse;
    if (!io.record(*find_layout("CollapseRecord"), collapse)) return;
    if (!io.records("collapses", *find_layout("PoolCollapseRecord"), collapse.pools)) return;
    NumberArray table{"table", NumberType::u32, std::uint64_t{collapse.levels} * (std::uint64_t{1} + collapse.pools)};
    table.row = std::uint64_t{1} + collapse.pools;
    table.starts_with_f32 = true;
    table.is_padded = true;
    if (!io.array(table)) return;
    for (std::uint32_t k = 0; k < collapse.pools; ++k) {
        PoolCollapseRecord pool;
        copy_at(io.payload(), sizeof collapse + k * sizeof pool, pool);
        const std::string targets = numbered("targets", k);
        const auto count = io.collapsed_vertices(pool, targets);
        const auto type =
            pool.target_type == static_cast<std::uint8_t>(ComponentType::u16) ? NumberType::u16 : NumberType::u32;
        if (!count || !io.array({targets, type, *count, 12, false, true})) return;
        const std::string joined = numbered("joined", k);
        if (!io.array({joined, NumberType::u8, (*count + 7) / 8, 24, false, true})) return;
    }
}

template <class Io>
void walk_image(Io& io) {
    ImageRecord image;
    if (io.record(*find_layout("ImageRecord"), image)) io.bytes("image");
}

/// What stands in a row of a segment's frames: the width of each number, in the file's order.
std::vector<std::uint32_t> frame_widths(std::span<const std::byte> widths, std::uint32_t tracks,
                                        std::uint32_t components);

/// A number of each track on a line, where there are enough.
inline std::uint64_t packed_row(std::uint32_t tracks) {
    constexpr std::uint32_t kUsual = 12;
    return tracks < kUsual ? kUsual : tracks;
}

template <class Io>
void walk_packed_segments(Io& io, const PackRecord& packed, const std::array<std::uint32_t, kPackedLists>& tracks) {
    const bool has_several = packed.segment_frames != 0 && packed.frames >= 2;
    const std::uint32_t segments = has_several ? (packed.frames - 2) / packed.segment_frames + 1 : 1;
    if (segments > 1 && !io.array({"starts", NumberType::u32, segments})) return;
    for (std::uint32_t s = 0; s < segments; ++s) {
        std::vector<std::uint32_t> widths;
        for (std::size_t k = 0; k < kPackedLists; ++k) {
            if (!kPackedKinds[k].animated || tracks[k] == 0) continue;
            const std::string suffix = numbered("", s) + numbered("", k);
            const std::uint64_t count = std::uint64_t{tracks[k]} * kPackedKinds[k].components;
            const std::uint64_t at = io.payload_done();
            if (!io.array({"widths" + suffix, NumberType::u8, count, packed_row(tracks[k])})) return;
            const auto list = frame_widths(io.payload().subspan(at, count), tracks[k], kPackedKinds[k].components);
            widths.insert(widths.end(), list.begin(), list.end());
            const auto base = (packed.wide >> k & 1u) != 0 ? NumberType::i32 : NumberType::i16;
            if (!io.array({"bases" + suffix, base, count, packed_row(tracks[k])})) return;
        }
        const std::uint32_t first = s * packed.segment_frames;
        const std::uint64_t frames =
            s + 1 < segments ? packed.segment_frames + std::uint64_t{1} : packed.frames - first;
        if (!io.packed_frames(numbered("frames", s), widths, frames)) return;
    }
    io.zeros(kPackedTail);
}

/// PACK: a payload that breaks the layout is bytes behind the record.
template <class Io>
void walk_packed(Io& io) {
    PackRecord packed;
    if (!io.record(*find_layout("PackRecord"), packed)) return;
    if (!io.has_packed_tracks()) return io.bytes("tracks");
    std::array<std::uint32_t, kPackedLists> tracks{};
    bool is_animated = false;
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        if ((packed.lists >> k & 1u) == 0) continue;
        if (!io.joint_bits(numbered("joints", k), packed.joints, tracks[k])) return;
        is_animated = is_animated || (kPackedKinds[k].animated && tracks[k] != 0);
    }
    for (const bool is_steps : {true, false}) {
        for (std::size_t k = 0; k < kPackedLists; ++k) {
            if (tracks[k] == 0 || (!is_steps && kPackedKinds[k].animated)) continue;
            const auto base = (packed.wide >> k & 1u) != 0 ? NumberType::i32 : NumberType::i16;
            const std::uint64_t count = std::uint64_t{tracks[k]} * kPackedKinds[k].components;
            const std::string name = numbered(is_steps ? "steps" : "bases", k);
            if (!io.array({name, is_steps ? NumberType::u8 : base, count, packed_row(tracks[k])})) return;
        }
    }
    if (packed.frame_rate == 0.0f && !io.array({"times", NumberType::f32, packed.frames})) return;
    if (is_animated) return walk_packed_segments(io, packed, tracks);
    io.zeros(kPackedTail);
}

/// A leaf whose payload has no form: only bytes.
template <class Io>
void walk_leaf(FourCC chunk, Io& io) {
    if (is_text(chunk)) return io.text();
    if (chunk == FourCC("JNAM") || chunk == FourCC("FNAM")) return io.names();
    if (is_stream(chunk)) return walk_stream(io);
    if (chunk == FourCC("PALT")) return walk_palette(io);
    if (chunk == FourCC("JNTS")) return walk_joints(io);
    if (chunk == FourCC("LODD")) return walk_collapse(io);
    if (chunk == FourCC("IMAG")) return walk_image(io);
    if (chunk == FourCC("PACK")) return walk_packed(io);
    if (chunk == FourCC("MARK")) return io.markers();
    if (chunk == FourCC("TRAK")) {
        io.records("tracks", *find_layout("TrackRecord"), kTheRest);
        return;
    }
    if (chunk == FourCC("PLAY")) {
        io.records("plays", *find_layout("PlayRecord"), kTheRest);
        return;
    }
    if (chunk == FourCC("GRID")) {
        io.array({"values", NumberType::f32, kTheRest, 6});
        return;
    }
    if (chunk == FourCC("NLST")) {
        io.array({"values", NumberType::f32, kTheRest, 3});
        return;
    }
    if (chunk == FourCC("TIME") || chunk == FourCC("KEYV")) {
        io.array({"values", NumberType::f32});
        return;
    }
    if (const RecordLayout* layout = layout_of(chunk)) io.plain_record(*layout);
}

}  // namespace bendy::twin
