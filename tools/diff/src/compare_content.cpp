#include "compare_content.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace bendy::diff {
namespace {

/// Returns the value that a number represents; unsigned integers without rounding to float.
double number_at(const StreamView& stream, std::uint64_t at) {
    const auto element = static_cast<std::uint32_t>(at / stream.components);
    const auto component = static_cast<std::uint32_t>(at % stream.components);
    return stream.type == ComponentType::u32 ? static_cast<double>(stream.index(element, component))
                                             : double{stream.number(element, component)};
}

Value count_of(std::uint64_t count) {
    return Scalar{count};
}

/// Returns a number as stored in the file: integers without a point.
Value number_value(double number, bool is_whole) {
    return is_whole ? Value(Scalar{static_cast<std::uint64_t>(number)}) : Value(Scalar{number});
}

std::string name_of(const TrackView& track) {
    std::string name = track.path == TrackPath::weights ? "track mesh " : "track joint ";
    name += std::to_string(track.target) + ' ';
    return name.append(kValueNames<TrackPath>[static_cast<std::size_t>(track.path)]);
}

using TrackKey = std::tuple<std::uint32_t, TrackPath>;
using TracksByKey = std::map<TrackKey, std::pair<const TrackView*, const TrackView*>>;

TracksByKey pair_tracks(const ClipView& a, const ClipView& b) {
    TracksByKey tracks;
    for (const TrackView& track : a.tracks) tracks[{track.target, track.path}].first = &track;
    for (const TrackView& track : b.tracks) tracks[{track.target, track.path}].second = &track;
    return tracks;
}

}  // namespace

void ContentComparer::take(std::uint64_t steps) {
    if (steps > effort_) throw TooMuchToCompare{};
    effort_ -= steps;
}

void ContentComparer::add_value(ChunkPair chunks, std::string part, Value a, Value b) {
    Difference difference;
    difference.chunks = chunks;
    difference.part = std::move(part);
    difference.a_value = std::move(a);
    difference.b_value = std::move(b);
    differences_.add(std::move(difference));
}

void ContentComparer::compare_numbers(ChunkPair chunks, const std::string& part, std::uint64_t count,
                                      std::uint64_t components, const NumberAt& a, const NumberAt& b, bool are_whole) {
    Difference difference;
    difference.kind = Difference::Kind::numbers;
    difference.chunks = chunks;
    difference.part = part;
    difference.of = count;
    for (std::uint64_t at = 0; at < count; ++at) {
        const double here = a(at);
        const double there = b(at);
        if (here == there || (std::isnan(here) && std::isnan(there))) continue;
        if (difference.count++ == 0) {
            difference.first_element = at / components;
            difference.first_component = at % components;
            difference.a_value = number_value(here, are_whole);
            difference.b_value = number_value(there, are_whole);
        }
        difference.largest = std::max(difference.largest, std::abs(here - there));
    }
    if (difference.count != 0) differences_.add(std::move(difference));
}

void ContentComparer::compare_spans(ChunkPair chunks, const std::string& part, std::uint32_t components,
                                    std::span<const float> a, std::span<const float> b) {
    const auto number_of = [](std::span<const float> numbers) {
        return [numbers](std::uint64_t at) { return double{numbers[at]}; };
    };
    compare_numbers(chunks, part, std::min(a.size(), b.size()), components, number_of(a), number_of(b));
}

void ContentComparer::compare_leaves(ChunkPair leaves) {
    const std::size_t before = differences_.count();
    const Chunk& chunk = a_.tree[leaves.a];
    const Chunk& other = b_.tree[leaves.b];
    const ObjectView* object_a = a_.objects[chunk.parent];
    const ObjectView* object_b = b_.objects[other.parent];
    const ClipView* clip_a = a_.clips[chunk.parent];
    const ClipView* clip_b = b_.clips[other.parent];
    if (a_.streams[leaves.a] != nullptr && b_.streams[leaves.b] != nullptr) {
        compare_streams(leaves, *a_.streams[leaves.a], *b_.streams[leaves.b]);
    } else if (chunk.id == FourCC("LODD") && object_a != nullptr && object_b != nullptr) {
        compare_collapses(leaves, *object_a->collapse, *object_b->collapse);
    } else if (chunk.id == FourCC("MARK") && clip_a != nullptr && clip_b != nullptr) {
        compare_markers(leaves, *clip_a, *clip_b);
    } else if (chunk.id == FourCC("ROLE") && object_a != nullptr && object_b != nullptr) {
        compare_roles(leaves, *object_a, *object_b);
    } else {
        compare_parts(leaves);
        if (differences_.count() == before) compare_bytes(leaves, a_.tree.payload(leaves.a), b_.tree.payload(leaves.b));
    }
    if (differences_.count() != before) return;
    if (chunk.flags != other.flags) add_value(leaves, "flags", count_of(chunk.flags), count_of(other.flags));
    if (differences_.count() != before) return;
    Difference difference;
    difference.kind = Difference::Kind::storage;
    difference.chunks = leaves;
    differences_.add(std::move(difference));
}

/// Compares the values that the numbers represent, whatever their type.
void ContentComparer::compare_streams(ChunkPair leaves, const StreamView& a, const StreamView& b) {
    compare_fields(leaves, {}, *find_layout("StreamRecord"), a_.tree.payload(leaves.a), b_.tree.payload(leaves.b));
    if (a.components != b.components || a.components == 0) return;
    const std::uint64_t count = std::uint64_t{std::min(a.elements, b.elements)} * a.components;
    compare_numbers(
        leaves, {}, count, a.components, [&](std::uint64_t at) { return number_at(a, at); },
        [&](std::uint64_t at) { return number_at(b, at); });
}

void ContentComparer::compare_markers(ChunkPair leaves, const ClipView& a, const ClipView& b) {
    if (a.markers.size() != b.markers.size())
        add_value(leaves, "markers", count_of(a.markers.size()), count_of(b.markers.size()));
    for (std::size_t k = 0; k < std::min(a.markers.size(), b.markers.size()); ++k) {
        const Marker& here = a.markers[k];
        const Marker& there = b.markers[k];
        const std::string part = "marker " + std::to_string(k) + ": ";
        if (here.seconds != there.seconds)
            add_value(leaves, part + "seconds", Scalar{double{here.seconds}}, Scalar{double{there.seconds}});
        if (here.name != there.name)
            add_value(leaves, part + "name", Scalar{std::string(here.name)}, Scalar{std::string(there.name)});
    }
}

/// Joint by joint: a role more or less moves the records of all others.
void ContentComparer::compare_roles(ChunkPair leaves, const ObjectView& a, const ObjectView& b) {
    const auto text = [](const RoleRecord* role) { return role == nullptr ? Value() : Scalar{role_text(*role)}; };
    std::vector<std::uint32_t> joints;
    for (const ObjectView* object : {&a, &b})
        for (const RoleRecord& role : object->roles) joints.push_back(role.joint);
    std::sort(joints.begin(), joints.end());
    joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
    for (const std::uint32_t joint : joints) {
        const Value here = text(role_of(a.roles, joint));
        const Value there = text(role_of(b.roles, joint));
        if (here != there) add_value(leaves, joint_name(&a, joint), here, there);
    }
}

void ContentComparer::compare_collapses(ChunkPair leaves, const CollapseView& a, const CollapseView& b) {
    if (a.levels != b.levels) add_value(leaves, "levels", count_of(a.levels), count_of(b.levels));
    if (a.meshes.size() != b.meshes.size())
        return add_value(leaves, "meshes", count_of(a.meshes.size()), count_of(b.meshes.size()));
    const std::uint32_t levels = std::min(a.levels, b.levels);
    compare_numbers(
        leaves, "errors of the levels", levels, 1,
        [&](std::uint64_t k) { return a.error(static_cast<std::uint32_t>(k)); },
        [&](std::uint64_t k) { return b.error(static_cast<std::uint32_t>(k)); });
    for (std::uint32_t p = 0; p < a.meshes.size(); ++p) {
        const MeshCollapseView& here = a.meshes[p];
        const MeshCollapseView& there = b.meshes[p];
        const std::string part = "mesh " + std::to_string(here.mesh) + ": ";
        if (here.mesh != there.mesh) add_value(leaves, part + "number", count_of(here.mesh), count_of(there.mesh));
        if (here.base != there.base) add_value(leaves, part + "base", count_of(here.base), count_of(there.base));
        const auto compare = [&](const char* what, std::uint64_t count, const auto& number) {
            compare_numbers(
                leaves, part + what, count, 1,
                [&](std::uint64_t k) { return static_cast<double>(number(a, static_cast<std::uint32_t>(k))); },
                [&](std::uint64_t k) { return static_cast<double>(number(b, static_cast<std::uint32_t>(k))); });
        };
        compare("vertices of the levels", levels,
                [p](const CollapseView& view, std::uint32_t level) { return view.alive(level, p); });
        if (here.base != there.base || here.vertices != there.vertices) continue;
        const std::uint32_t base = here.base;
        compare("targets", here.vertices - base,
                [&](const CollapseView& view, std::uint32_t k) { return view.meshes[p].target(base + k); });
        compare("joined bits", here.vertices - base, [&](const CollapseView& view, std::uint32_t k) {
            return view.meshes[p].is_joined(base + k) ? 1u : 0u;
        });
    }
}

void ContentComparer::compare_clips(ChunkPair clips) {
    const std::size_t before = differences_.count();
    const ClipView& a = *a_.clips[clips.a];
    const ClipView& b = *b_.clips[clips.b];
    for (const auto& [key, tracks] : pair_tracks(a, b)) {
        const auto& [here, there] = tracks;
        if (here != nullptr && there != nullptr) {
            compare_tracks(clips, name_of(*here), *here, *there);
            continue;
        }
        Difference difference;
        difference.kind = there == nullptr ? Difference::Kind::only_in_a : Difference::Kind::only_in_b;
        difference.chunks = clips;
        difference.part = name_of(here != nullptr ? *here : *there);
        differences_.add(std::move(difference));
    }
    if (differences_.count() != before) return;
    // The tracks are equal; reports if their bytes nevertheless differ.
    for (const FourCC id : {FourCC("TRAK"), FourCC("PACK"), FourCC("TIME"), FourCC("KEYV")}) {
        const ChunkPair leaves{a_.tree.find(clips.a, id), b_.tree.find(clips.b, id)};
        if (leaves.a == kNone && leaves.b == kNone) continue;
        if (leaves.a != kNone && leaves.b != kNone && have_equal_sums(a_.tree, leaves.a, b_.tree, leaves.b)) continue;
        Difference difference;
        difference.kind = Difference::Kind::storage;
        difference.chunks = leaves;
        differences_.add(std::move(difference));
    }
}

void ContentComparer::compare_tracks(ChunkPair clips, const std::string& name, const TrackView& a, const TrackView& b) {
    take(std::uint64_t{a.times.size()} + a.values.size() + b.times.size() + b.values.size());
    const bool are_timed = !a.times.empty() && !b.times.empty();
    if (a.interpolation != b.interpolation) {
        const auto word = [](Interpolation interpolation) {
            return Scalar{std::string(kValueNames<Interpolation>[static_cast<std::size_t>(interpolation)])};
        };
        add_value(clips, name + ": interpolation", word(a.interpolation), word(b.interpolation));
    }
    if (a.components != b.components)
        add_value(clips, name + ": components", count_of(a.components), count_of(b.components));
    if (a.keys != b.keys) add_value(clips, name + ": keys", count_of(a.keys), count_of(b.keys));
    if (a.times.empty() != b.times.empty())
        add_value(clips, name + ": fixed frames", Scalar{a.times.empty()}, Scalar{b.times.empty()});
    if (are_timed) compare_spans(clips, name + ": times", 1, a.times, b.times);
    if (a.interpolation == b.interpolation && a.components == b.components) {
        const std::uint32_t per_key = a.components * (a.interpolation == Interpolation::cubic ? 3 : 1);
        compare_spans(clips, name + ": values", per_key, a.values, b.values);
    }
}

}  // namespace bendy::diff
