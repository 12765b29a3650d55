#include <bendy/format/records.h>

#include <cstddef>

// Compares the structs with the table: every field has the offset and size from the table, and there are no gaps.
namespace bendy {
namespace {
namespace layout {

using u8 = std::uint8_t;
using u16 = std::uint16_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;
using f32 = float;

#define BENDY_RECORD(chunk, Struct, shortest)                                                 \
    static_assert(std::is_trivially_copyable_v<Struct> && std::is_standard_layout_v<Struct>); \
    static_assert(kShortest<Struct> <= sizeof(Struct));
#define BENDY_FIELD(Struct, field, type, count, offset, what) \
    static_assert(offsetof(Struct, field) == (offset));       \
    static_assert(sizeof(Struct::field) == sizeof(type) * (count));
#include <bendy/format/records.def>

constexpr std::size_t sum_of_fields(const char* record) {
    std::size_t sum = 0;
    const auto same = [](const char* a, const char* b) {
        while (*a != 0 && *a == *b) ++a, ++b;
        return *a == *b;
    };
#define BENDY_FIELD(Struct, field, type, count, offset, what) sum += same(record, #Struct) ? sizeof(type) * (count) : 0;
#include <bendy/format/records.def>
    return sum;
}

#define BENDY_RECORD(chunk, Struct, shortest) static_assert(sum_of_fields(#Struct) == sizeof(Struct));
#include <bendy/format/records.def>

}  // namespace layout
}  // namespace
}  // namespace bendy
