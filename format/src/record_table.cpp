#include <bendy/format/record_table.h>

#include <bendy/format/records.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace bendy {
namespace {

constexpr FieldType type_of(std::string_view name) {
    constexpr std::array<std::string_view, 5> kNames{"u8", "u16", "u32", "u64", "f32"};
    for (std::size_t k = 0; k < kNames.size(); ++k) {
        if (name == kNames[k]) return static_cast<FieldType>(k);
    }
    return FieldType::record;
}

constexpr RecordField kFields[] = {
#define BENDY_RECORD(chunk, Struct, shortest)
#define BENDY_FIELD(Struct, field, type, count, offset, what) {#Struct, #field, #type, type_of(#type), count, offset},
#include <bendy/format/records.def>
#undef BENDY_RECORD
#undef BENDY_FIELD
};

/// A record's fields stand together in the table.
constexpr std::span<const RecordField> fields_of(std::string_view record) {
    std::size_t first = 0;
    while (first < std::size(kFields) && kFields[first].record != record) ++first;
    std::size_t last = first;
    while (last < std::size(kFields) && kFields[last].record == record) ++last;
    return {kFields + first, last - first};
}

constexpr RecordLayout kLayouts[] = {
#define BENDY_RECORD(chunk, Struct, shortest) {#Struct, FourCC(#chunk), shortest, sizeof(Struct), fields_of(#Struct)},
#define BENDY_FIELD(Struct, field, type, count, offset, what)
#include <bendy/format/records.def>
#undef BENDY_RECORD
#undef BENDY_FIELD
};

template <std::size_t N>
bool is_one_of(FourCC chunk, const std::array<FourCC, N>& ids) {
    return std::find(ids.begin(), ids.end(), chunk) != ids.end();
}

}  // namespace

std::span<const RecordLayout> record_layouts() {
    return kLayouts;
}

const RecordLayout* find_layout(std::string_view record) {
    const auto* found = std::find_if(std::begin(kLayouts), std::end(kLayouts),
                                     [&](const RecordLayout& layout) { return layout.name == record; });
    return found == std::end(kLayouts) ? nullptr : found;
}

const RecordLayout* layout_of(FourCC chunk) {
    if (is_stream(chunk)) return find_layout("StreamRecord");
    // A record that stands in another is in the table before that one: the chunk's own is the last of its id.
    const RecordLayout* found = nullptr;
    for (const RecordLayout& layout : kLayouts) {
        if (layout.chunk == chunk) found = &layout;
    }
    return found;
}

bool is_text(FourCC chunk) {
    constexpr std::array kTexts{FourCC("NAME"), FourCC("EXTR"), FourCC("EXTN"), FourCC("MORE"), FourCC("LINK")};
    return is_one_of(chunk, kTexts);
}

bool is_stream(FourCC chunk) {
    constexpr std::array kStreams{FourCC("POSI"), FourCC("NORM"), FourCC("TANG"), FourCC("TEXC"), FourCC("COLR"),
                                  FourCC("BONE"), FourCC("WGHT"), FourCC("VALS"), FourCC("INDX")};
    return is_one_of(chunk, kStreams);
}

}  // namespace bendy
