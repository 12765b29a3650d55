#include <bendy/format/records.h>

#include "edit_file.h"

#include <bendy/format/constraint.h>
#include <bendy/format/material.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

namespace bendy::records_test {
namespace {

using namespace test;

struct Field {
    const char* record;
    const char* name;
    std::size_t offset;
    std::size_t size;
};

const std::vector<Field> kFields{
#define BENDY_RECORD(chunk, Struct, shortest)
#define BENDY_FIELD(Struct, field, type, count, offset, what, ...) {#Struct, #field, offset, sizeof(Struct::field)},
#include <bendy/format/records.def>
#undef BENDY_RECORD
#undef BENDY_FIELD
};

/// HEAD with one leaf that has this payload.
Buffer file_with(const char* id, Bytes payload, std::uint16_t flags = 0) {
    std::uint32_t raw = 0;
    std::memcpy(&raw, id, sizeof raw);
    return to_file(make_container(FourCC("HEAD"), {make_leaf(FourCC(raw), payload, flags)}));
}

template <class R>
class Record {
public:
    Record(const char* chunk, const char* name) : chunk_(chunk) {
        std::copy_if(kFields.begin(), kFields.end(), std::back_inserter(fields_),
                     [&](const Field& field) { return std::strcmp(field.record, name) == 0; });
        for (std::size_t i = 0; i < sizeof(R); ++i) bytes_.push_back(static_cast<std::byte>(i * 37 + 1));
    }

    void comes_back_as_it_was_written() const {
        SCOPED_TRACE(chunk_);
        R written;
        std::memcpy(&written, bytes_.data(), sizeof(R));
        expect_fields(file_with(chunk_, bytes_of(written)), sizeof(R));
    }

    void takes_defaults_in_its_shortest_form() const {
        SCOPED_TRACE(chunk_);
        expect_fields(file_with(chunk_, Bytes(bytes_).first(kShortest<R>)), kShortest<R>);
    }

    void is_refused_where_it_is_cut() const {
        SCOPED_TRACE(chunk_);
        for (std::uint64_t size = 0; size < sizeof(R); ++size) {
            if (size == kShortest<R>) continue;
            const Buffer file = file_with(chunk_, Bytes(bytes_).first(size));
            const Result<R> read = read_record<R>(*read_chunk_tree(file), 1);
            ASSERT_FALSE(read.has_value()) << size;
            EXPECT_EQ(read.error().code, ErrorCode::kRecordTooShort);
            EXPECT_EQ(read.error().offset, 16u);
            EXPECT_EQ(read.error().value, size);
            EXPECT_EQ(read.error().limit, size < kShortest<R> ? kShortest<R> : sizeof(R));
        }
    }

    void ignores_what_follows_it() const {
        SCOPED_TRACE(chunk_);
        Buffer longer = bytes_;
        longer.resize(longer.size() + 21, std::byte{0xee});
        expect_fields(file_with(chunk_, longer), sizeof(R));
    }

    void is_refused_where_it_is_encoded() const {
        SCOPED_TRACE(chunk_);
        const Buffer file = file_with(chunk_, bytes_, 0x0300);
        const Result<R> read = read_record<R>(*read_chunk_tree(file), 1);
        ASSERT_FALSE(read.has_value());
        EXPECT_EQ(read.error().code, ErrorCode::kUnsupportedCodec);
        EXPECT_EQ(read.error().value, 3u);
    }

private:
    /// The fields that lie in the first `present` bytes are those written, the others the defaults.
    void expect_fields(const Buffer& file, std::uint64_t present) const {
        const R defaults;
        const Result<R> read = read_record<R>(*read_chunk_tree(file), 1);
        ASSERT_TRUE(read.has_value()) << present;
        ASSERT_FALSE(fields_.empty());
        for (const Field& field : fields_) {
            const bool is_there = field.offset + field.size <= present;
            const std::byte* expected = is_there ? bytes_.data() : reinterpret_cast<const std::byte*>(&defaults);
            EXPECT_EQ(std::memcmp(reinterpret_cast<const std::byte*>(&*read) + field.offset, expected + field.offset,
                                  field.size),
                      0)
                << field.name << " of a payload of " << present << " bytes";
        }
    }

    const char* chunk_;
    std::vector<Field> fields_;
    Buffer bytes_;
};

#define BENDY_FIELD(Struct, field, type, count, offset, what, ...)

TEST(Records, ComeBackAsTheyWereWritten) {
#define BENDY_RECORD(chunk, Struct, shortest) Record<Struct>(#chunk, #Struct).comes_back_as_it_was_written();
#include <bendy/format/records.def>
#undef BENDY_RECORD
}

TEST(Records, TakeDefaultsInTheirShortestForm) {
#define BENDY_RECORD(chunk, Struct, shortest) Record<Struct>(#chunk, #Struct).takes_defaults_in_its_shortest_form();
#include <bendy/format/records.def>
#undef BENDY_RECORD
}

TEST(Records, AreRefusedWhereTheyAreCut) {
#define BENDY_RECORD(chunk, Struct, shortest) Record<Struct>(#chunk, #Struct).is_refused_where_it_is_cut();
#include <bendy/format/records.def>
#undef BENDY_RECORD
}

TEST(Records, IgnoreWhatALaterVersionPutsBehindThem) {
#define BENDY_RECORD(chunk, Struct, shortest) Record<Struct>(#chunk, #Struct).ignores_what_follows_it();
#include <bendy/format/records.def>
#undef BENDY_RECORD
}

TEST(Records, AreRefusedWhereTheyAreEncoded) {
#define BENDY_RECORD(chunk, Struct, shortest) Record<Struct>(#chunk, #Struct).is_refused_where_it_is_encoded();
#include <bendy/format/records.def>
#undef BENDY_RECORD
}
#undef BENDY_FIELD

TEST(Records, HaveTheDocumentedDefaults) {
    EXPECT_EQ(RestRecord{}.rotation, (std::array<float, 4>{0, 0, 0, 1}));
    EXPECT_EQ(RestRecord{}.scale, (std::array<float, 3>{1, 1, 1}));
    EXPECT_EQ(RestRecord{}.shear, (std::array<float, 3>{0, 0, 0}));
    EXPECT_EQ(SurfaceRecord{}.alpha_cutoff, 0.5f);
    EXPECT_EQ(TextureUseRecord{}.texture, kNone);
    EXPECT_EQ(SubmeshRecord{}.material, kNone);
    EXPECT_EQ(MeshRecord{}.joint, kNone);
    EXPECT_EQ(as_text(bytes_of(VersionRecord{}.signature)), "BENDY\r\n\x1a");
}

TEST(Records, KnowTheSizesOfTheirEnumerations) {
    EXPECT_EQ(component_size(ComponentType::u8), 1u);
    EXPECT_EQ(component_size(ComponentType::i8), 1u);
    EXPECT_EQ(component_size(ComponentType::u16), 2u);
    EXPECT_EQ(component_size(ComponentType::i16), 2u);
    EXPECT_EQ(component_size(ComponentType::u32), 4u);
    EXPECT_EQ(component_size(ComponentType::f32), 4u);
    EXPECT_EQ(corners(Topology::triangles), 3u);
    EXPECT_EQ(corners(Topology::lines), 2u);
    EXPECT_EQ(corners(Topology::points), 1u);
}

TEST(Records, KnowTheNamesOfTheirEnumerations) {
    EXPECT_EQ(kSolvers, 7u);
    EXPECT_EQ(kMinFilters, 7u);
    EXPECT_EQ(kValueNames<Filter>[kMagFilters - 1], "linear");
    EXPECT_EQ(kValueNames<Solver>[static_cast<std::size_t>(Solver::any)], "any");
    EXPECT_EQ(kValueNames<Solver>[static_cast<std::size_t>(Solver::least_squares)], "least_squares");
    EXPECT_EQ(kShownNames<Solver>[static_cast<std::size_t>(Solver::least_squares)], "least squares");
    EXPECT_EQ(kShownNames<Interpolation>, kValueNames<Interpolation>);
    EXPECT_EQ(mime_type(MediaType::jpeg), "image/jpeg");
    EXPECT_EQ(mime_type(MediaType::other), "");
    EXPECT_EQ(axes_of(EulerOrder::yzx), (std::array<std::size_t, 3>{1, 2, 0}));
}

}  // namespace
}  // namespace bendy::records_test
