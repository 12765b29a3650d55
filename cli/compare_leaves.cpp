#include "compare_leaves.h"

#include "describe_chunk.h"

#include <bendy/runtime/sample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

namespace bendy::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kStepsPerSample = 16;

/// A number as it is meant; unsigned integers without a float's rounding.
double number_at(const StreamView& stream, std::uint64_t at) {
    const auto element = static_cast<std::uint32_t>(at / stream.components);
    const auto component = static_cast<std::uint32_t>(at % stream.components);
    return stream.type == ComponentType::u32 ? static_cast<double>(stream.index(element, component))
                                             : double{stream.number(element, component)};
}

std::string name_of(const TrackView& track) {
    constexpr std::array<std::string_view, kTrackPaths> kPaths{"translation", "rotation", "scale", "weights"};
    std::string name = track.path == TrackPath::weights ? "track pool " : "track joint ";
    name += std::to_string(track.target) + ' ';
    return name.append(kPaths[static_cast<std::size_t>(track.path)]);
}

using Fields = std::vector<std::pair<std::string, Json>>;

/// A record's fields, those of records inside it as "outer.inner".
Fields fields_of(const ChunkTree& tree, std::uint32_t number) {
    Fields fields;
    const Json record = chunk_fields(tree, number);
    for (const auto& [name, value] : record.items()) {
        if (!value.is_object()) {
            fields.emplace_back(name, value);
            continue;
        }
        for (const auto& [inner, inner_value] : value.items())
            fields.emplace_back(std::string(name).append(1, '.').append(inner), inner_value);
    }
    return fields;
}

/// What a field that a shorter record lacks stands for.
bool is_nothing(const Json& value) {
    if (value.is_array()) return std::all_of(value.begin(), value.end(), is_nothing);
    return value.is_string() ? value.get_ref<const std::string&>().empty() : value.is_number() && value == 0;
}

const StreamView* pointer_to(const std::optional<StreamView>& stream) {
    return stream ? &*stream : nullptr;
}

/// Walks over the touched vertices of a target.
class Touched {
public:
    Touched(const StreamView* vertices, const StreamView* displacements)
        : vertices_(vertices), displacements_(displacements) {}

    /// kNone at the end.
    [[nodiscard]] std::uint32_t vertex() const {
        if (displacements_ == nullptr || entry_ >= displacements_->elements) return kNone;
        return vertices_ == nullptr ? entry_ : vertices_->index(entry_, 0);
    }
    /// Zero where it stands behind `vertex`.
    [[nodiscard]] double number(std::uint32_t of_vertex, std::uint32_t component) const {
        return vertex() == of_vertex ? double{displacements_->number(entry_, component)} : 0.0;
    }
    void pass(std::uint32_t of_vertex) { entry_ += vertex() == of_vertex ? 1 : 0; }

private:
    const StreamView* vertices_;
    const StreamView* displacements_;
    std::uint32_t entry_ = 0;
};

using TrackKey = std::tuple<std::uint32_t, TrackPath>;
using TracksByKey = std::map<TrackKey, std::pair<const TrackView*, const TrackView*>>;

TracksByKey pair_tracks(const CycleView& a, const CycleView& b) {
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

bool ContentComparer::is_near(double a, double b) const {
    if (a == b || (std::isnan(a) && std::isnan(b))) return true;
    return tolerance_ && std::abs(a - b) <= *tolerance_;
}

void ContentComparer::add_value(ChunkPair chunks, std::string part, Json a, Json b) {
    Difference difference;
    difference.chunks = chunks;
    difference.part = std::move(part);
    difference.a_value = std::move(a);
    difference.b_value = std::move(b);
    differences_.add(std::move(difference));
}

void ContentComparer::compare_numbers(ChunkPair chunks, const std::string& part, std::uint64_t count,
                                      std::uint32_t components, const NumberAt& a, const NumberAt& b) {
    Difference difference;
    difference.kind = Difference::Kind::numbers;
    difference.chunks = chunks;
    difference.part = part;
    difference.of = count;
    for (std::uint64_t at = 0; at < count; ++at) {
        const double here = a(at);
        const double there = b(at);
        if (is_near(here, there)) continue;
        if (difference.count++ == 0) {
            difference.first_element = at / components;
            difference.first_component = at % components;
            difference.a_value = here;
            difference.b_value = there;
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
    const Bytes a = a_.tree.payload(leaves.a);
    const Bytes b = b_.tree.payload(leaves.b);
    const bool is_known = chunk_meaning(chunk.id) != "unknown";
    if (is_known && a_.streams[leaves.a] != nullptr && b_.streams[leaves.b] != nullptr) {
        compare_streams(leaves, *a_.streams[leaves.a], *b_.streams[leaves.b]);
    } else if (a_.palettes[leaves.a] != nullptr && b_.palettes[leaves.b] != nullptr) {
        compare_palettes(leaves);
    } else if (a_.tables[leaves.a] != nullptr && b_.tables[leaves.b] != nullptr) {
        if (chunk.id == FourCC("JNTS")) compare_joint_tables(leaves);
        if (chunk.id == FourCC("JNAM")) compare_joint_names(leaves);
        if (chunk.id == FourCC("LODD")) compare_collapses(leaves);
    } else if (chunk.id == FourCC("GRID") || chunk.id == FourCC("NLST")) {
        const auto floats = [](Bytes payload) { return view_at<float>(payload, 0, payload.size() / sizeof(float)); };
        if (a.size() != b.size()) add_value(leaves, "floats", a.size() / sizeof(float), b.size() / sizeof(float));
        compare_spans(leaves, {}, chunk.id == FourCC("GRID") ? 6 : 3, floats(a), floats(b));
    } else if (chunk.id == FourCC("MARK") && a_.cycles[chunk.parent] != nullptr &&
               b_.cycles[b_.tree[leaves.b].parent] != nullptr) {
        compare_markers(leaves, *a_.cycles[chunk.parent], *b_.cycles[b_.tree[leaves.b].parent]);
    } else {
        compare_fields(leaves);
        const bool is_read = !chunk_fields(a_.tree, leaves.a).empty() && chunk.id != FourCC("IMAG");
        if (!(is_read && tolerance_) && differences_.count() == before) compare_bytes(leaves, a, b);
    }
    if (tolerance_ || differences_.count() != before) return;
    if (chunk.flags != b_.tree[leaves.b].flags) add_value(leaves, "flags", chunk.flags, b_.tree[leaves.b].flags);
    if (differences_.count() != before) return;
    Difference difference;
    difference.kind = Difference::Kind::storage;
    difference.chunks = leaves;
    differences_.add(std::move(difference));
}

void ContentComparer::compare_streams(ChunkPair leaves, const StreamView& a, const StreamView& b) {
    if (!tolerance_) {
        compare_fields(leaves);
    } else {
        if (a.components != b.components) add_value(leaves, "components", a.components, b.components);
        if (a.elements != b.elements) add_value(leaves, "elements", a.elements, b.elements);
        if (a.set != b.set) add_value(leaves, "set", a.set, b.set);
    }
    if (a.components != b.components || a.components == 0) return;
    const std::uint64_t count = std::uint64_t{std::min(a.elements, b.elements)} * a.components;
    compare_numbers(
        leaves, {}, count, a.components, [&](std::uint64_t at) { return number_at(a, at); },
        [&](std::uint64_t at) { return number_at(b, at); });
}

void ContentComparer::compare_palettes(ChunkPair leaves) {
    const PaletteView& a = *a_.palettes[leaves.a];
    const PaletteView& b = *b_.palettes[leaves.b];
    const auto joints_a = a.joints;
    const auto joints_b = b.joints;
    const auto numbers_of = [](const PaletteView& palette) {
        const auto bytes = std::as_bytes(palette.inverse_bind());
        return view_at<float>(bytes, 0, bytes.size() / sizeof(float));
    };
    if (joints_a.size() != joints_b.size()) add_value(leaves, "entries", joints_a.size(), joints_b.size());
    const std::uint64_t shared = std::min(joints_a.size(), joints_b.size());
    std::uint64_t differing = 0;
    std::uint64_t first = 0;
    for (std::uint64_t entry = 0; entry < shared; ++entry) {
        if (joints_a[entry] == joints_b[entry]) continue;
        if (differing++ == 0) first = entry;
    }
    if (differing != 0) {
        Difference difference;
        difference.kind = Difference::Kind::numbers;
        difference.chunks = leaves;
        difference.part = "joints";
        difference.count = differing;
        difference.of = shared;
        difference.first_element = first;
        difference.a_value = joints_a[first];
        difference.b_value = joints_b[first];
        for (std::uint64_t entry = 0; entry < shared; ++entry) {
            difference.largest =
                std::max(difference.largest, std::abs(static_cast<double>(joints_a[entry]) - joints_b[entry]));
        }
        differences_.add(std::move(difference));
    }
    compare_spans(leaves, "inverse bind matrices", 16, numbers_of(a), numbers_of(b));
}

void ContentComparer::compare_fields(ChunkPair leaves) {
    const auto are_near = [&](const Json& x, const Json& y) {
        const bool are_numbers = x.is_number_float() && y.is_number_float();
        return are_numbers ? is_near(x.get<double>(), y.get<double>()) : x == y;
    };
    const Fields a = fields_of(a_.tree, leaves.a);
    const Fields b = fields_of(b_.tree, leaves.b);
    // A record may be longer on one side; the fields that both have stand in the table's order on both.
    std::size_t there = 0;
    for (const auto& [name, value] : a) {
        if (there >= b.size() || b[there].first != name) {
            if (!tolerance_ || !is_nothing(value)) add_value(leaves, name, value, nullptr);
            continue;
        }
        const Json& other = b[there++].second;
        if (tolerance_ && name == "frame_rate") continue;  // how the tracks are stored; they are compared
        const bool is_same = value.is_array() && other.is_array() && value.size() == other.size()
                                 ? std::equal(value.begin(), value.end(), other.begin(), are_near)
                                 : are_near(value, other);
        if (!is_same) add_value(leaves, name, value, other);
    }
    for (; there < b.size(); ++there) {
        if (!tolerance_ || !is_nothing(b[there].second)) add_value(leaves, b[there].first, nullptr, b[there].second);
    }
}

void ContentComparer::compare_bytes(ChunkPair leaves, Bytes a, Bytes b) {
    const std::size_t shared = std::min(a.size(), b.size());
    Difference difference;
    difference.kind = Difference::Kind::bytes;
    difference.chunks = leaves;
    difference.of = std::max(a.size(), b.size());
    difference.count = difference.of - shared;
    difference.first_element = shared;
    difference.a_value = a.size();
    difference.b_value = b.size();
    for (std::size_t at = shared; at-- > 0;) {
        if (a[at] == b[at]) continue;
        ++difference.count;
        difference.first_element = at;
    }
    if (difference.count != 0) differences_.add(std::move(difference));
}

void ContentComparer::compare_displacements(ChunkPair targets, const std::string& part, const StreamView* a_vertices,
                                            const StreamView* a, const StreamView* b_vertices, const StreamView* b) {
    constexpr std::uint32_t kComponents = 3;
    Difference difference;
    difference.kind = Difference::Kind::numbers;
    difference.chunks = targets;
    difference.part = part;
    Touched here(a_vertices, a);
    Touched there(b_vertices, b);
    while (true) {
        const std::uint32_t vertex = std::min(here.vertex(), there.vertex());
        if (vertex == kNone) break;
        for (std::uint32_t c = 0; c < kComponents; ++c) {
            const double x = here.number(vertex, c);
            const double y = there.number(vertex, c);
            ++difference.of;
            if (is_near(x, y)) continue;
            if (difference.count++ == 0) {
                difference.first_element = vertex;
                difference.first_component = c;
                difference.a_value = x;
                difference.b_value = y;
            }
            difference.largest = std::max(difference.largest, std::abs(x - y));
        }
        here.pass(vertex);
        there.pass(vertex);
    }
    if (difference.count != 0) differences_.add(std::move(difference));
}

void ContentComparer::compare_targets(ChunkPair targets) {
    const TargetView& a = *a_.targets[targets.a];
    const TargetView& b = *b_.targets[targets.b];
    const auto compare = [&](const char* part, const std::optional<StreamView>& x, const std::optional<StreamView>& y) {
        compare_displacements(targets, part, pointer_to(a.vertices), pointer_to(x), pointer_to(b.vertices),
                              pointer_to(y));
    };
    compare("positions", a.positions, b.positions);
    compare("normals", a.normals, b.normals);
    compare("tangents", a.tangents, b.tangents);
}

void ContentComparer::compare_cycles(ChunkPair cycles) {
    const std::size_t before = differences_.count();
    const CycleView& a = *a_.cycles[cycles.a];
    const CycleView& b = *b_.cycles[cycles.b];
    for (const auto& [key, tracks] : pair_tracks(a, b)) {
        const auto& [here, there] = tracks;
        if (here != nullptr && there != nullptr) {
            compare_tracks(cycles, name_of(*here), *here, *there);
            continue;
        }
        Difference difference;
        difference.kind = there == nullptr ? Difference::Kind::only_in_a : Difference::Kind::only_in_b;
        difference.chunks = cycles;
        difference.part = name_of(here != nullptr ? *here : *there);
        differences_.add(std::move(difference));
    }
    if (tolerance_ || differences_.count() != before) return;
    // The same tracks; say so if their bytes are others all the same.
    for (const FourCC id : {FourCC("TRAK"), FourCC("PACK"), FourCC("TIME"), FourCC("KEYV")}) {
        const ChunkPair leaves{a_.tree.find(cycles.a, id), b_.tree.find(cycles.b, id)};
        if (leaves.a == kNone && leaves.b == kNone) continue;
        if (leaves.a != kNone && leaves.b != kNone && have_equal_sums(a_.tree, leaves.a, b_.tree, leaves.b)) continue;
        Difference difference;
        difference.kind = Difference::Kind::storage;
        difference.chunks = leaves;
        differences_.add(std::move(difference));
    }
}

void ContentComparer::compare_tracks(ChunkPair cycles, const std::string& name, const TrackView& a,
                                     const TrackView& b) {
    const CycleView& cycle_a = *a_.cycles[cycles.a];
    const CycleView& cycle_b = *b_.cycles[cycles.b];
    take(std::uint64_t{a.times.size()} + a.values.size() + b.times.size() + b.values.size());
    const bool are_timed = !a.times.empty() && !b.times.empty();
    const bool are_framed = a.times.empty() && b.times.empty() && cycle_a.frame_rate == cycle_b.frame_rate &&
                            cycle_a.start == cycle_b.start;
    const bool have_same_times =
        a.keys == b.keys && (are_framed || (are_timed && std::equal(a.times.begin(), a.times.end(), b.times.begin())));
    const bool are_alike = a.interpolation == b.interpolation && a.components == b.components && have_same_times;
    if (!are_alike && tolerance_ && a.components == b.components) return compare_samples(cycles, name, a, b);
    if (a.interpolation != b.interpolation) {
        constexpr std::array<const char*, kInterpolations> kNames{"step", "linear", "cubic"};
        add_value(cycles, name + ": interpolation", kNames[static_cast<std::size_t>(a.interpolation)],
                  kNames[static_cast<std::size_t>(b.interpolation)]);
    }
    if (a.components != b.components) add_value(cycles, name + ": components", a.components, b.components);
    if (a.keys != b.keys) add_value(cycles, name + ": keys", a.keys, b.keys);
    if (a.times.empty() != b.times.empty())
        add_value(cycles, name + ": fixed frames", a.times.empty(), b.times.empty());
    if (are_timed) compare_spans(cycles, name + ": times", 1, a.times, b.times);
    if (a.interpolation == b.interpolation && a.components == b.components) {
        const std::uint32_t per_key = a.components * (a.interpolation == Interpolation::cubic ? 3 : 1);
        compare_spans(cycles, name + ": values", per_key, a.values, b.values);
    }
}

/// Keys that cannot be compared one by one are sampled: where either has a key, and halfway between. A rotation and its
/// negative are the same.
void ContentComparer::compare_samples(ChunkPair cycles, const std::string& name, const TrackView& a,
                                      const TrackView& b) {
    const CycleView& cycle_a = *a_.cycles[cycles.a];
    const CycleView& cycle_b = *b_.cycles[cycles.b];
    std::vector<float> times;
    const auto add_times = [&](const TrackView& track, const CycleView& cycle) {
        for (std::uint32_t key = 0; key < track.keys; ++key) {
            times.push_back(track.times.empty() ? static_cast<float>(cycle.start + key / double{cycle.frame_rate})
                                                : track.times[key]);
        }
    };
    add_times(a, cycle_a);
    add_times(b, cycle_b);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    for (std::size_t k = times.size(); k-- > 1;) times.push_back(times[k - 1] + 0.5f * (times[k] - times[k - 1]));
    std::sort(times.begin(), times.end());

    take(times.size() * kStepsPerSample);
    std::vector<float> here(a.components);
    std::vector<float> there(b.components);
    Difference difference;
    difference.kind = Difference::Kind::numbers;
    difference.chunks = cycles;
    difference.part = name + ": sampled values";
    difference.of = std::uint64_t{times.size()} * a.components;
    for (std::size_t k = 0; k < times.size(); ++k) {
        sample_track(a, cycle_a, times[k], here);
        sample_track(b, cycle_b, times[k], there);
        double dot = 0.0;
        for (std::size_t c = 0; c < here.size(); ++c) dot += double{here[c]} * there[c];
        const double sign = a.path == TrackPath::rotation && dot < 0.0 ? -1.0 : 1.0;
        for (std::size_t c = 0; c < here.size(); ++c) {
            const double other = sign * there[c];
            if (is_near(here[c], other)) continue;
            if (difference.count++ == 0) {
                difference.first_element = k;
                difference.first_component = c;
                difference.a_value = here[c];
                difference.b_value = other;
            }
            difference.largest = std::max(difference.largest, std::abs(here[c] - other));
        }
    }
    if (difference.count != 0) differences_.add(std::move(difference));
}

}  // namespace bendy::cli
