// Small good files of every kind, each damaged in every place: what the sums do not see is refused, or harmless.
#include <bendy/runtime.h>

#include "mutation/allocations.h"
#include "mutation/places.h"
#include "mutation/seeds.h"
#include "runtime/build_model.h"
#include "runtime/use_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::test::mutation_test {
namespace {

/// With the environment variable BENDY_MUTATION_TIMES, each run over the fields prints its slowest case: nothing
/// depends on it.
bool is_timed() {
    static const bool timed = std::getenv("BENDY_MUTATION_TIMES") != nullptr;
    return timed;
}

/// Everything that a program does with a character, once; `turn` chooses the solver, the times and the level of detail,
/// so that all have their turns in a test.
void play(const Model& model, std::size_t turn) {
    Pose pose(model);
    Lod lod(model);
    std::vector<glm::vec3> positions(model.vertex_count());
    std::vector<glm::vec3> normals(model.vertex_count());
    const Vertices vertices{positions, normals, {}};
    constexpr std::array kTimes{0.4f, 0.0f, 1.0f, -3.0f, 1e30f, std::numeric_limits<float>::quiet_NaN()};
    for (const Clip& clip : model.clips()) {
        const float share = kTimes.at(turn % kTimes.size());
        (void)sample(pose, &clip, clip.start + share * (clip.end - clip.start));
    }
    constrain(pose);
    ReachOptions options;
    options.solver = static_cast<Solver>(turn % kSolvers);
    options.iterations = 2;
    options.restarts = 1;
    const ReachTarget target({0.3f, 0.9f, 0.2f}, glm::quat(0.6f, 0.0f, 0.8f, 0.0f));
    for (const Chain& chain : model.chains()) (void)reach(pose, &chain, target, options);
    EXPECT_TRUE(skin(pose, {.out = vertices}));
    lod.set_share(static_cast<float>(turn % 5) * 0.25f);
    EXPECT_TRUE(skin(pose, {.lod = &lod, .out = vertices}));
    for (std::uint32_t mesh = 0; mesh < model.meshes().size(); ++mesh) {
        const auto weights =
            pose.morph_weights().subspan(model.first_morph_target(mesh), model.meshes()[mesh].targets.size());
        EXPECT_TRUE(apply_morph_targets(model.meshes()[mesh], weights, vertices));
    }
}

/// How far the test got, and how much was accepted.
struct Tally {
    std::uint64_t accepted = 0;
    std::uint64_t refused = 0;
};

/// What opening and playing a file may take from operator new, in bytes. What is encoded may decode to a fixed
/// multiple.
std::uint64_t most_bytes(Bytes file, bool is_encoded) {
    constexpr std::uint64_t kFaultLists = 4 * sizeof(Error) * 2 * Faults::kMost;
    return kFaultLists + (is_encoded ? kMaxCodecRatio : 24) * file.size();
}

bool has_codecs(Bytes file) {
    const auto tree = read_chunk_tree(file);
    const auto chunks = tree->chunks();
    return std::any_of(chunks.begin(), chunks.end(), [](const Chunk& chunk) { return chunk.codec() != 0; });
}

/// Opens bytes whose sums are not looked at, and uses what opens.
void try_out(const Buffer& file, bool is_encoded, std::size_t turn, bool is_played, Tally& tally) {
    restart_count();
    OpenOptions options;
    options.sums = Sums::later;
    const Result<Model> model = Model::from_memory(file, options);
    EXPECT_LE(allocations().largest, most_bytes(file, is_encoded));
    ++(model ? tally.accepted : tally.refused);
    if (!model || !is_played) return;
    EXPECT_LT(read_all(*model), std::numeric_limits<std::uint64_t>::max());
    play(*model, turn);
    EXPECT_LE(allocations().largest, most_bytes(file, is_encoded));
}

/// For each byte of a file whether it is one of the lower halves of a float in a stream or track: a flip there changes
/// no more than how far something moves.
std::vector<bool> find_low_halves(const Buffer& file) {
    std::vector<bool> is_low(file.size());
    const auto tree = read_chunk_tree(file);
    for (std::uint32_t number = 0; number < tree->chunks().size(); ++number) {
        const Chunk& chunk = (*tree)[number];
        const std::string id = chunk.id.letters().data();
        const std::set<std::string> streams{"POSI", "NORM", "TANG", "TEXC", "WGHT", "KEYV", "PALT"};
        if (chunk.codec() != 0 || streams.count(id) == 0) continue;
        const std::uint64_t head = id == "KEYV" ? 0 : id == "PALT" ? 64 : sizeof(StreamRecord);
        for (std::uint64_t at = head; at < chunk.size; ++at) is_low[chunk.payload_offset() + at] = at % 4 < 2;
    }
    return is_low;
}

class Mutation : public testing::TestWithParam<const char*> {
protected:
    const Buffer good_ = read_seed(GetParam());
    const bool has_object_ = Model::from_memory(good_).has_value();  // without one there is nothing to open
    const Places visited_ = places();
};

TEST_P(Mutation, TheSeedIsGood) {
    EXPECT_EQ(faults_in(good_), Lines{});
    EXPECT_LE(good_.size(), 6144u);
}

TEST_P(Mutation, EveryPrefixIsRefused) {
    for (std::size_t size = visited_.first; size < good_.size(); size += visited_.step) {
        const Buffer prefix(good_.begin(), good_.begin() + static_cast<std::ptrdiff_t>(size));
        ASSERT_FALSE(Model::from_memory(prefix).has_value()) << size;
        ASSERT_FALSE(validate(prefix).empty()) << size;
    }
}

TEST_P(Mutation, EveryBitFlipIsFoundByTheSums) {
    Buffer file = good_;
    for (std::size_t bit = visited_.first; bit < file.size() * 8; bit += visited_.step) {
        file[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
        ASSERT_FALSE(Model::from_memory(file).has_value()) << "bit " << bit << " in " << chunk_path(good_, bit / 8);
        file[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    }
    EXPECT_EQ(file, good_);
}

TEST_P(Mutation, EveryBitFlipUncheckedIsHarmless) {
    const std::vector<bool> is_low = find_low_halves(good_);
    const bool is_encoded = has_codecs(good_);
    Buffer file = good_;
    Tally tally;
    for (std::size_t bit = visited_.first; bit < file.size() * 8; bit += visited_.step) {
        file[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
        try_out(file, is_encoded, bit, !is_low[bit / 8], tally);
        if (HasFailure()) FAIL() << "bit " << bit << " in " << chunk_path(good_, bit / 8);
        file[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    }
    EXPECT_GT(tally.refused, good_.size() / 4 / visited_.step);
}

TEST_P(Mutation, EveryBitFlipWithItsSumsRepairedIsJudged) {
    Buffer file = good_;
    std::size_t well_formed = 0;
    // Each byte's bits in turn: neighbours are of the same number, and the flips above have gone the same way once.
    for (std::size_t at = visited_.first; at < file.size(); at += visited_.step) {
        for (const std::size_t bit : {at % 8, (at + 3) % 8}) {
            Buffer damaged = file;
            damaged[at] ^= static_cast<std::byte>(1u << bit);
            if (!resum(damaged)) continue;
            ++well_formed;
            restart_count();
            const Faults faults = validate(damaged);
            ASSERT_LE(allocations().largest, most_bytes(damaged, true));
            const bool opens = Model::from_memory(damaged).has_value();
            ASSERT_TRUE(opens || !faults.empty() || !has_object_)
                << "byte " << at << ", bit " << bit;  // what is refused has a fault
        }
    }
    EXPECT_GT(well_formed, good_.size() / 4 / visited_.step);
}

// Fields
// -----------------------------------------------------------------------------------------------------------------

struct Field {
    std::uint64_t at = 0;  ///< in the file
    unsigned bytes = 0;
};

/// An integer of a fixed record.
struct RecordField {
    std::string_view chunk;
    std::string_view record;
    std::string_view type;
    unsigned count = 0;
    unsigned offset = 0;
};

constexpr RecordField kRecordFields[] = {
#define BENDY_RECORD(chunk, Struct, shortest)
#define BENDY_FIELD(Struct, field, type, count, offset, what, ...) {{}, #Struct, #type, count, offset},
#include <bendy/format/records.def>
#undef BENDY_RECORD
#undef BENDY_FIELD
};

/// Where a record's copies lie in a leaf: the first, and from one to the next; 0: there is one.
struct Place {
    std::string_view record;
    std::uint64_t first = 0;
    std::uint64_t stride = 0;
};

const std::multimap<std::string_view, Place>& record_places() {
    static const std::multimap<std::string_view, Place> found = [] {
        std::multimap<std::string_view, Place> all{
            {"LODD", {"CollapseRecord"}},     {"LODD", {"MeshCollapseRecord", 16, 16}},
            {"TRAK", {"TrackRecord", 0, 32}}, {"JNTS", {"JointsRecord"}},
            {"MARK", {"MarkersRecord"}},      {"MARK", {"MarkerRecord", 8, 8}},
            {"JNTS", {"SubmeshRecord", 20}},  // not on its place: words of rest poses and ranges are set too
            {"SURF", {"SurfaceRecord"}},
        };
        for (const std::string_view stream : {"POSI", "NORM", "TANG", "TEXC", "COLR", "BONE", "WGHT", "INDX", "VALS"})
            all.insert({stream, {"StreamRecord"}});
#define BENDY_RECORD(chunk, Struct, shortest) \
    if (all.find(#chunk) == all.end()) all.insert({#chunk, {#Struct}});
#define BENDY_FIELD(Struct, field, type, count, offset, what, ...)
#include <bendy/format/records.def>
#undef BENDY_RECORD
#undef BENDY_FIELD
        return all;
    }();
    return found;
}

unsigned bytes_of_type(std::string_view type) {
    return type == "u8" ? 1 : type == "u16" ? 2 : type == "u32" ? 4 : type == "u64" ? 8 : 0;
}

/// Every integer field of every record, header, and codec header of a file.
std::vector<Field> find_fields(const Buffer& file) {
    std::vector<Field> fields;
    const auto tree = read_chunk_tree(file);
    for (std::uint32_t number = 0; number < tree->chunks().size(); ++number) {
        const Chunk& chunk = (*tree)[number];
        fields.push_back({chunk.offset + 8, 6});
        fields.push_back({chunk.offset + 14, 2});
        if (chunk.codec() != 0) {
            for (const Field& field : {Field{0, 8}, Field{8, 2}, Field{10, 2}, Field{12, 4}})
                fields.push_back({chunk.payload_offset() + field.at, field.bytes});
            continue;
        }
        const auto [first, last] = record_places().equal_range(chunk.id.letters().data());
        for (auto place = first; place != last; ++place) {
            for (std::uint64_t start = place->second.first; start < chunk.size;) {
                for (const RecordField& field : kRecordFields) {
                    const unsigned bytes = bytes_of_type(field.type);
                    if (field.record != place->second.record || bytes == 0) continue;
                    const std::uint64_t at = start + field.offset;
                    if (at + bytes <= chunk.size) fields.push_back({chunk.payload_offset() + at, bytes});
                }
                if (place->second.stride == 0) break;
                start += place->second.stride;
            }
        }
    }
    return fields;
}

/// What a field is set to: 0, 1, the most, one more and one less than it was, 2^31 and 2^63 as far as it holds them.
std::set<std::uint64_t> awkward_values(std::uint64_t before, unsigned bytes) {
    const unsigned bits = 8 * bytes;
    const std::uint64_t most = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    std::set<std::uint64_t> values{0,
                                   1,
                                   most,
                                   most - 1,
                                   most - 15,
                                   (before - 1) & most,
                                   (before + 1) & most,
                                   (before + 16) & most,
                                   (before - 16) & most,
                                   std::uint64_t{1} << (bits - 1)};
    for (const unsigned shift : {15u, 16u, 30u, 31u, 32u, 47u, 63u}) {
        if (shift < bits) values.insert(std::uint64_t{1} << shift);
    }
    values.erase(before);
    return values;
}

/// Sets the fields of a file to every awkward value, its sums repaired, and tries it out: all of these cases, or one of
/// a few.
void set_every_field(const Buffer& good, const Places& visited) {
    const bool is_encoded = has_codecs(good);
    bool has_object = false;
    const std::uint64_t usual_bytes = [&] {
        restart_count();
        has_object = Model::from_memory(good).has_value();
        return allocations().bytes;
    }();
    Tally tally;
    std::size_t turn = 0;
    std::size_t tried = 0;
    std::clock_t slowest = 0;
    for (const Field& field : find_fields(good)) {
        std::uint64_t before = 0;
        std::memcpy(&before, good.data() + field.at, field.bytes);
        for (const std::uint64_t value : awkward_values(before, field.bytes)) {
            if (turn++ % visited.step != visited.first) continue;
            ++tried;
            Buffer file = good;
            std::memcpy(file.data() + field.at, &value, field.bytes);
            resum(file);
            const std::clock_t start = std::clock();
            restart_count();
            const bool opens = Model::from_memory(file).has_value();
            // Opening takes its memory in proportion to the file, and so much at a time, whatever a number says.
            EXPECT_LE(allocations().bytes, 4 * usual_bytes + 4 * most_bytes(file, is_encoded));
            EXPECT_LE(allocations().count, 64 + 16 * file.size() / kChunkHeaderSize);
            try_out(file, is_encoded, turn, opens, tally);
            restart_count();
            EXPECT_TRUE(opens || !validate(file).empty() || !has_object);
            EXPECT_LE(allocations().largest, most_bytes(file, is_encoded));
            slowest = std::max(slowest, std::clock() - start);
            if (testing::Test::HasFailure()) {
                FAIL() << value << " in " << field.bytes << " bytes at " << field.at << " in "
                       << chunk_path(good, field.at);
            }
        }
    }
    EXPECT_GT(tally.refused, tally.accepted / 100);
    if (is_timed()) {
        std::printf("%zu bytes, %zu cases, slowest %.3f ms\n", good.size(), tried,
                    1e3 * static_cast<double>(slowest) / CLOCKS_PER_SEC);
    }
}

TEST_P(Mutation, EveryFieldWithAnAwkwardValueIsHarmless) {
    set_every_field(good_, visited_);
}

/// Of the seeds with encoded leaves.
using DecodedMutation = Mutation;

TEST_P(DecodedMutation, EveryFieldWithAnAwkwardValueIsHarmless) {
    set_every_field(without_codecs(good_), visited_);
}

std::vector<const char*> encoded_seeds() {
    std::vector<const char*> encoded;
    std::copy_if(kSeeds.begin(), kSeeds.end(), std::back_inserter(encoded),
                 [](const char* seed) { return has_codecs(read_seed(seed)); });
    return encoded;
}

std::string name_of(const testing::TestParamInfo<const char*>& seed) {
    return test_name(seed.param);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Mutation, testing::ValuesIn(kSeeds), name_of);
INSTANTIATE_TEST_SUITE_P(Seeds, DecodedMutation, testing::ValuesIn(encoded_seeds()), name_of);

}  // namespace
}  // namespace bendy::test::mutation_test
