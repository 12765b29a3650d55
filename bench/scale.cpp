// bench_scale: what each joint and each vertex costs, from few to very many. Made-up characters: chains of ten joints
// on one root, each joint with a rotation track of 31 keys; vertices on a sheet, four influences of bones that are
// near. The least of some runs, in nanoseconds per joint or vertex.
#include <bendy/format/chunk_writer.h>
#include <bendy/format/codec.h>
#include <bendy/format/records.h>
#include <bendy/runtime.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace {

using bendy::Bytes;
using bendy::ChunkWriter;
using bendy::FourCC;

constexpr std::uint32_t kChain = 10;  // joints
constexpr std::uint32_t kKeys = 31;
constexpr std::uint32_t kInfluences = 4;

std::uint32_t parent_of(std::uint32_t joint) {
    return joint == 0 ? bendy::kNone : joint % kChain == 0 ? 0 : joint - 1;
}

void put_joints(ChunkWriter& out, std::uint32_t joints) {
    std::vector<std::uint32_t> open;
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
        for (; !open.empty() && open.back() != parent_of(joint); open.pop_back()) out.end();
        out.begin(FourCC("SKIN"));
        open.push_back(joint);
        out.text_leaf(FourCC("NAME"), "joint" + std::to_string(joint));
        bendy::RestRecord rest;
        rest.translation = {0.0f, joint % kChain == 0 ? 0.01f * static_cast<float>(joint) : 0.1f, 0.0f};
        out.begin(FourCC("PIVO"));
        out.leaf(FourCC("REST"), bendy::bytes_of(rest));
        out.end();
    }
    for (; !open.empty(); open.pop_back()) out.end();
}

/// A stream of numbers as they are.
template <class T>
void put_stream(ChunkWriter& out, FourCC id, bendy::ComponentType type, std::uint32_t components,
                const std::vector<T>& numbers) {
    bendy::StreamRecord record;
    record.component_type = static_cast<std::uint8_t>(type);
    record.components = static_cast<std::uint16_t>(components);
    record.elements = static_cast<std::uint32_t>(numbers.size() / components);
    const Bytes pieces[] = {bendy::bytes_of(record), std::as_bytes(std::span(numbers))};
    out.leaf(id, pieces);
}

/// All joints are in the palette; a vertex follows four that follow one another, sixty-four vertices the same.
void put_pool(ChunkWriter& out, std::uint32_t vertices, std::uint32_t joints) {
    std::vector<float> positions;
    std::vector<float> normals;
    std::vector<float> weights;
    std::vector<std::uint16_t> bones;
    for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
        const auto x = static_cast<float>(vertex % 1000);
        const auto y = static_cast<float>(vertex / 1000);  // NOLINT(bugprone-integer-division): a row
        positions.insert(positions.end(), {0.001f * x, 0.001f * y, 0.0f});
        normals.insert(normals.end(), {0.0f, 0.0f, 1.0f});
        weights.insert(weights.end(), {0.4f, 0.3f, 0.2f, 0.1f});
        for (std::uint32_t k = 0; k < kInfluences; ++k)
            bones.push_back(static_cast<std::uint16_t>((vertex / 64 + k) % joints));
    }
    std::vector<std::uint32_t> palette(joints);
    for (std::uint32_t joint = 0; joint < joints; ++joint) palette[joint] = joint;
    const std::vector<glm::mat4> inverse_bind(joints, glm::mat4(1.0f));
    bendy::PaletteRecord record;
    record.entries = joints;
    const std::vector<std::byte> gap(bendy::padded(joints * sizeof(std::uint32_t)) - joints * sizeof(std::uint32_t));
    const Bytes pieces[] = {bendy::bytes_of(record), std::as_bytes(std::span(palette)), gap,
                            std::as_bytes(std::span(inverse_bind))};
    out.begin(FourCC("VECT"));
    out.leaf(FourCC("VINF"), bendy::bytes_of(bendy::PoolRecord{vertices, 0}));
    out.leaf(FourCC("PALT"), pieces);
    put_stream(out, FourCC("POSI"), bendy::ComponentType::f32, 3, positions);
    put_stream(out, FourCC("NORM"), bendy::ComponentType::f32, 3, normals);
    put_stream(out, FourCC("BONE"), bendy::ComponentType::u16, kInfluences, bones);
    put_stream(out, FourCC("WGHT"), bendy::ComponentType::f32, kInfluences, weights);
    out.end();
}

void put_cycle(ChunkWriter& out, std::uint32_t joints) {
    std::vector<bendy::TrackRecord> tracks(joints);
    std::vector<float> times;
    std::vector<float> values;
    for (std::uint32_t key = 0; key < kKeys; ++key) times.push_back(static_cast<float>(key) / 30.0f);
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
        bendy::TrackRecord& track = tracks[joint];
        track.target = joint;
        track.path = static_cast<std::uint8_t>(bendy::TrackPath::rotation);
        track.interpolation = static_cast<std::uint8_t>(bendy::Interpolation::linear);
        track.components = 4;
        track.keys = kKeys;
        track.first_value = values.size();
        for (std::uint32_t key = 0; key < kKeys; ++key) {
            const float half = 0.01f * static_cast<float>(key);
            values.insert(values.end(), {0.0f, 0.0f, std::sin(half), std::cos(half)});
        }
    }
    bendy::CycleRecord info;
    info.end = times.back();
    out.begin(FourCC("CYCL"));
    out.leaf(FourCC("CINF"), bendy::bytes_of(info));
    out.leaf(FourCC("TRAK"), std::as_bytes(std::span(tracks)));
    out.leaf(FourCC("TIME"), std::as_bytes(std::span(times)));
    out.leaf(FourCC("KEYV"), std::as_bytes(std::span(values)));
    out.end();
}

/// On a 16-byte boundary, as vectors of bytes are on all machines that we build for.
std::vector<std::byte> make_character(std::uint32_t joints, std::uint32_t vertices) {
    ChunkWriter out;
    out.reserve(std::uint64_t{vertices} * 48 + std::uint64_t{joints} * 1024 + 65536);
    bendy::VersionRecord version;
    version.objects = 1;
    version.joints = joints;
    version.pools = vertices == 0 ? 0 : 1;
    version.vertices = vertices;
    version.cycles = 1;
    out.begin(FourCC("HEAD"));
    out.leaf(FourCC("VERS"), bendy::bytes_of(version));
    out.begin(FourCC("OBJE"));
    put_joints(out, joints);
    if (vertices != 0) put_pool(out, vertices, joints);
    put_cycle(out, joints);
    out.end();
    out.end();
    return std::move(out).finish();
}

/// Nanoseconds per item, the least of runs that take half a second together.
template <class Run>
double least(double items, const Run& run) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::milliseconds(500);
    double best = std::numeric_limits<double>::max();
    do {
        const auto start = Clock::now();
        run();
        best = std::min(best, std::chrono::duration<double, std::nano>(Clock::now() - start).count());
    } while (Clock::now() < end);
    return best / items;
}

bendy::Result<bendy::Model> open(Bytes bytes, bendy::Sums sums) {
    bendy::OpenOptions options;
    options.sums = sums;
    return bendy::Model::from_memory(bytes, options);
}

bool measure_joints(std::uint32_t joints) {
    const std::vector<std::byte> bytes = make_character(joints, 0);
    const auto model = open(bytes, bendy::Sums::checked);
    if (!model) return false;
    const bendy::Cycle& cycle = model->cycles().front();
    bendy::Pose pose(*model);
    float seconds = 0.0f;
    const auto next = [&](float step) {
        seconds += step;
        if (seconds > cycle.end) seconds -= cycle.end;
        bendy::sample(&cycle, seconds, pose);
    };
    const double n = joints;
    const double checked = least(n, [&] { return open(bytes, bendy::Sums::checked).has_value(); });
    const double later = least(n, [&] { return open(bytes, bendy::Sums::later).has_value(); });
    const double in_order = least(n, [&] { next(1.0f / 60.0f); });
    const double at_random = least(n, [&] { next(0.61803399f); });
    const double to_model = least(n, [&] { bendy::local_to_model(pose); });
    std::printf("| %u | %.0f | %.0f | %.1f | %.1f | %.1f |\n", joints, checked, later, in_order, at_random, to_model);
    std::fflush(stdout);
    return true;
}

bool measure_vertices(std::uint32_t vertices) {
    constexpr std::uint32_t kJoints = 100;
    const std::vector<std::byte> bytes = make_character(kJoints, vertices);
    const auto model = open(bytes, bendy::Sums::checked);
    if (!model) return false;
    const double n = vertices;
    const double checked = least(n, [&] { return open(bytes, bendy::Sums::checked).has_value(); });
    const double later = least(n, [&] { return open(bytes, bendy::Sums::later).has_value(); });
    const double first_pose = least(n, [&] {
        const auto fresh = open(bytes, bendy::Sums::later);
        const bendy::Pose pose(*fresh);
    });
    bendy::Pose pose(*model);
    bendy::sample(&model->cycles().front(), 0.5f, pose);
    std::vector<glm::vec3> positions(vertices);
    std::vector<glm::vec3> normals(vertices);
    const double skin_positions = least(n, [&] { bendy::skin(*model, pose, {positions, {}, {}}); });
    const double skin_normals = least(n, [&] { bendy::skin(*model, pose, {positions, normals, {}}); });
    std::printf("| %u | %.2f | %.2f | %.1f | %.2f | %.2f |\n", vertices, checked, later, first_pose - later,
                skin_positions, skin_normals);
    std::fflush(stdout);
    return true;
}

}  // namespace

int main() {
    bool is_good = true;
    std::printf(
        "| joints | open | sums later | next frame | random time | local to model |\n|---|---|---|---|---|---|\n");
    for (const std::uint32_t joints : {10u, 100u, 1'000u, 10'000u}) is_good = is_good && measure_joints(joints);
    std::printf("\n| vertices | open | sums later | first pose | positions | + normals |\n|---|---|---|---|---|---|\n");
    for (const std::uint32_t vertices : {1'000u, 10'000u, 100'000u, 1'000'000u, 10'000'000u})
        is_good = is_good && measure_vertices(vertices);
    return is_good ? 0 : 1;
}
