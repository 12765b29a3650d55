#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/limits.h>
#include <bendy/format/public.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

// The fixed records as stored in the file; meaning, unit and range of each field are given in records.def.
namespace BENDY_PUBLIC bendy {

inline constexpr std::array<std::uint8_t, 8> kSignature{0x42, 0x45, 0x4e, 0x44, 0x59, 0x0d, 0x0a, 0x1a};

/// A material number of SubmeshRecord with this bit set is an index into the joint's own MATE chunks.
inline constexpr std::uint32_t kLocalMaterial = 0x8000'0000u;

// The type names that records.def uses.
struct TextureUseRecord;
namespace stored {
using u8 = std::uint8_t;
using u16 = std::uint16_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;
using f32 = float;
using bendy::TextureUseRecord;
}  // namespace stored

// The records, as in `struct SameRecord { std::uint32_t texture{}; std::uint32_t image{}; };`. A field of several
// numbers is a std::array.
#define BENDY_RECORD(chunk, Struct, shortest) struct Struct {
#define BENDY_CONSTANT(Struct, name, type, value) static constexpr stored::type name = value;
#define BENDY_FIELD(Struct, field, type, count, offset, what, ...) \
    std::conditional_t<(count) == 1, stored::type, std::array<stored::type, count>> field{__VA_ARGS__};
#define BENDY_END(Struct) \
    }                     \
    ;
#include <bendy/format/records.def>

/// JNTS: a submesh, and the joint that it belongs to.
struct JointSubmesh {
    std::uint32_t joint = 0;
    SubmeshRecord submesh;
};
static_assert(sizeof(JointSubmesh) == 24);

/// The names in a list that the preprocessor made of them: "any, pull, two_bone".
constexpr unsigned count_names(std::string_view list) {
    unsigned count = 1;
    for (const char c : list) count += c == ',' ? 1 : 0;
    return count;
}
template <std::size_t N>
constexpr std::array<std::string_view, N> split_names(std::string_view list) {
    std::array<std::string_view, N> names;
    for (std::string_view& name : names) {
        name = list.substr(0, list.find(','));
        list.remove_prefix(std::min(list.size(), name.size() + 2));
    }
    return names;
}

/// The names of an enumeration's values by number, as in text forms and rig files, and as reports show them.
template <class Values>
inline constexpr std::array<std::string_view, 0> kValueNames{};
template <class Values>
inline constexpr auto kShownNames = kValueNames<Values>;

// The records' enumerations, as in `enum class Topology : std::uint8_t { triangles, lines, points };`, and the number
// of values of each, as in kTopologies.
#define BENDY_VALUES(Values, kCount, ...)                         \
    enum class Values : std::uint8_t { __VA_ARGS__ };             \
    inline constexpr unsigned kCount = count_names(#__VA_ARGS__); \
    template <>                                                   \
    inline constexpr std::array<std::string_view, kCount> kValueNames<Values> = split_names<kCount>(#__VA_ARGS__);
#define BENDY_SHOWN(Values, ...)                                                                \
    template <>                                                                                 \
    inline constexpr auto kShownNames<Values> = std::to_array<std::string_view>({__VA_ARGS__}); \
    static_assert(kShownNames<Values>.size() == kValueNames<Values>.size());
#include <bendy/format/records.def>
inline constexpr Role kFirstChainRole = Role::spine_chain;  ///< from here on, a role may have several joints
inline constexpr unsigned kMagFilters = 3;                  ///< values of Filter without mipmaps

/// Bits of ConstraintRecord::flags and ChainRecord::flags.
inline constexpr std::uint8_t kApproximated = 1;  ///< the source contains more than the record can express, or differs
inline constexpr std::uint8_t kProposed = 2;      ///< guessed from the joints' names, not authored
inline constexpr std::uint8_t kRestOutside = 4;   ///< for a limit: its author knows that the rest pose is outside it
inline constexpr unsigned kConstraintFlags = 8;
inline constexpr unsigned kChainFlags = 4;

/// Size in bytes of one number of the type.
constexpr std::uint32_t component_size(ComponentType type) {
    constexpr std::array<std::uint32_t, kComponentTypes> kSizes{1, 1, 2, 2, 4, 4};
    return kSizes[static_cast<std::size_t>(type)];
}
/// Number of indices per element: 3, 2, 1.
constexpr std::uint32_t corners(Topology topology) {
    return 3 - static_cast<std::uint32_t>(topology);
}

/// Minimum size in bytes of a payload that holds record R.
template <class R>
inline constexpr std::uint64_t kShortest = sizeof(R);
#define BENDY_RECORD(chunk, Struct, shortest) \
    template <>                               \
    inline constexpr std::uint64_t kShortest<Struct> = shortest;
#include <bendy/format/records.def>

/// Reads the record at the start of a leaf's payload. It may be stored in its shortest form, so that the remaining
/// fields keep their defaults; in full; or longer, by a later version, in which case the rest is skipped. Errors:
/// RECORD_TOO_SHORT if it is shorter than the form that it must have; the codec's fault if it is encoded and has not
/// been decoded.
template <class R>
Result<R> read_record(const ChunkTree& tree, std::uint32_t chunk) {
    const Bytes payload = tree.payload(chunk);
    const std::uint64_t offset = tree[chunk].offset;
    if (const auto fault = tree.encoding_fault(chunk)) return *fault;
    if (payload.size() < kShortest<R>) return Error{ErrorCode::kRecordTooShort, offset, payload.size(), kShortest<R>};
    if (payload.size() > kShortest<R> && payload.size() < sizeof(R)) {
        return Error{ErrorCode::kRecordTooShort, offset, payload.size(), sizeof(R)};
    }
    R record;
    copy_at(payload, 0, record);
    return record;
}

}  // namespace bendy
