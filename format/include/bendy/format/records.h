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

struct VersionRecord {
    std::array<std::uint8_t, 8> signature = kSignature;
    std::uint16_t major = kVersionMajor;
    std::uint16_t minor = kVersionMinor;
    std::uint32_t objects = 0;
    std::uint32_t joints = 0;
    std::uint32_t meshes = 0;
    std::uint64_t vertices = 0;
    std::uint32_t clips = 0;
    std::uint32_t materials = 0;
    std::uint32_t textures = 0;
    std::uint32_t reserved = 0;
    std::array<std::uint8_t, 32> generator{};
};

struct BoundRecord {
    float max_error = 0.0f;
    float measured_error = 0.0f;
    float height = 0.0f;
};

struct SamplerRecord {
    std::uint8_t mag_filter = 0;
    std::uint8_t min_filter = 0;
    std::uint8_t wrap_s = 0;
    std::uint8_t wrap_t = 0;
};

struct SameRecord {
    std::uint32_t texture = 0;
    std::uint32_t image = 0;
};

struct TextureUseRecord {
    std::uint32_t texture = kNone;
    std::uint32_t coords = 0;
    std::array<float, 2> offset{};
    std::array<float, 2> scale{1.0f, 1.0f};
    float rotation = 0.0f;
    std::uint32_t reserved = 0;
};

struct SurfaceRecord {
    std::array<float, 4> base_colour{1.0f, 1.0f, 1.0f, 1.0f};
    std::array<float, 3> emissive{};
    float metallic = 1.0f;
    float roughness = 1.0f;
    float normal_scale = 1.0f;
    float occlusion_strength = 1.0f;
    float alpha_cutoff = 0.5f;
    std::uint8_t alpha_mode = 0;
    std::uint8_t double_sided = 0;
    std::uint8_t unlit = 0;
    std::array<std::uint8_t, 13> reserved{};
    TextureUseRecord base_colour_texture;
    TextureUseRecord metallic_roughness_texture;
    TextureUseRecord normal_texture;
    TextureUseRecord occlusion_texture;
    TextureUseRecord emissive_texture;
};

struct RestRecord {
    std::array<float, 4> rotation{0.0f, 0.0f, 0.0f, 1.0f};
    std::array<float, 3> translation{};
    std::array<float, 3> scale{1.0f, 1.0f, 1.0f};
    std::array<float, 3> shear{};
};

struct ConstraintRecord {
    static constexpr float kFree = std::numeric_limits<float>::infinity();

    std::uint8_t model = 0;
    std::uint8_t euler_order = 0;
    std::uint8_t scope = 0;
    std::uint8_t flags = 0;
    float soft_zone = 0.0f;
    std::array<float, 4> frame{0.0f, 0.0f, 0.0f, 1.0f};
    std::array<float, 3> rotation_min{-kFree, -kFree, -kFree};
    std::array<float, 3> rotation_max{kFree, kFree, kFree};
    std::array<float, 3> translation_min{-kFree, -kFree, -kFree};
    std::array<float, 3> translation_max{kFree, kFree, kFree};
    std::array<float, 3> stiffness{};
    std::array<float, 3> preferred{};
};

struct ChainWeightRecord {
    std::uint32_t chain = 0;
    float weight = 1.0f;
};

/// ROLE: what a joint is in the body.
struct RoleRecord {
    std::uint32_t joint = 0;
    std::uint16_t role = 0;  ///< a Role
    std::uint16_t place = 0;
};

/// STND: the pose in which the body stands; a StandingRotationRecord for each of its joints follows.
struct StandingPoseRecord {
    std::array<float, 4> axes{0.0f, 0.0f, 0.0f, 1.0f};
    float ground = 0.0f;
    float height = 0.0f;
    std::uint8_t evidence = 0;  ///< a StandingEvidence
    std::array<std::uint8_t, 7> reserved{};
};

struct StandingRotationRecord {
    std::uint32_t joint = 0;
    std::array<float, 3> rotation{};  ///< x y z, w >= 0
};

struct ChainRecord {
    std::uint32_t start = 0;
    std::uint32_t effector = 0;
    std::uint32_t target = kNone;
    std::uint32_t pole = kNone;
    std::uint8_t solver = 0;
    std::uint8_t flags = 0;
    std::uint16_t iterations = 0;
    std::uint8_t priority = 0;
    std::array<std::uint8_t, 3> reserved{};
    float tolerance = 0.0f;
    std::array<float, 3> pole_vector{};
    float pole_angle = 0.0f;
    std::array<float, 3> tip_offset{};
    std::array<float, 4> tip_rotation{0.0f, 0.0f, 0.0f, 1.0f};
    float position_weight = 1.0f;
    float rotation_weight = 0.0f;
    float influence = 1.0f;
    float stretch = 0.0f;
    float compress = 0.0f;
};

struct SubmeshRecord {
    std::uint32_t mesh = 0;
    std::uint32_t material = kNone;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::uint8_t topology = 0;
    std::array<std::uint8_t, 3> reserved{};
};

struct JointsRecord {
    std::uint32_t joints = 0;
    std::uint32_t submeshes = 0;
    std::array<std::uint32_t, 2> reserved{};
};

/// JNTS: a submesh, and the joint that it belongs to.
struct JointSubmesh {
    std::uint32_t joint = 0;
    SubmeshRecord submesh;
};
static_assert(sizeof(JointSubmesh) == 24);

struct MeshRecord {
    std::uint32_t vertices = 0;
    std::uint32_t joint = kNone;
};

struct MorphTargetRecord {
    float rest_weight = 0.0f;
};

struct ClipRecord {
    float start = 0.0f;
    float end = 0.0f;
    float frame_rate = 0.0f;
    std::uint8_t loop = 0;
    std::array<std::uint8_t, 3> reserved{};
};

struct MarkerRecord {
    float seconds = 0.0f;
    std::uint32_t name_end = 0;
};

struct MarkersRecord {
    std::uint32_t markers = 0;
    std::uint32_t reserved = 0;
};

struct PackRecord {
    std::uint32_t frames = 1;
    float start = 0.0f;
    float frame_rate = 1.0f;
    std::uint16_t joints = 0;
    std::uint16_t segment_frames = 0;
    std::uint8_t lists = 0;
    std::uint8_t wide = 0;
    std::array<std::uint8_t, 2> reserved{};
};

struct CurveRecord {
    std::uint32_t keys = 0;
    std::uint8_t components = 0;
    std::uint8_t interpolation = 0;
    std::uint8_t packed = 0;
    std::uint8_t kind = 0;
    std::uint32_t target = kNone;
    float max_error = 0.0f;
    std::uint32_t values = 0;
    std::uint32_t path_size = 0;
    std::uint32_t name_size = 0;
    std::uint32_t reserved = 0;
};

struct PlayRecord {
    std::uint32_t mesh = 0;
    std::uint32_t first = 0;
    std::uint32_t frames = 0;
    std::uint8_t closed = 0;
    std::array<std::uint8_t, 3> reserved{};
};

struct TrackRecord {
    std::uint32_t target = 0;
    std::uint8_t path = 0;
    std::uint8_t interpolation = 0;
    std::uint16_t components = 0;
    std::uint32_t keys = 0;
    std::uint32_t first_time = 0;
    std::uint64_t first_value = 0;
};

struct StreamRecord {
    std::uint8_t component_type = 0;
    std::uint8_t normalised = 0;
    std::uint16_t components = 0;
    std::uint32_t elements = 0;
    std::uint32_t set = 0;
    std::uint32_t reserved = 0;
};

struct PaletteRecord {
    std::uint32_t entries = 0;
    std::uint32_t derived = 0;
    std::array<std::uint32_t, 2> reserved{};
};

struct MeshCollapseRecord {
    std::uint32_t mesh = 0;
    std::uint32_t base = 0;
    std::uint8_t target_type = 0;
    std::array<std::uint8_t, 7> reserved{};
};

struct CollapseRecord {
    std::uint32_t meshes = 0;
    std::uint32_t levels = 0;
    std::array<std::uint32_t, 2> reserved{};
};

struct ImageRecord {
    std::uint8_t media = 0;
    std::array<std::uint8_t, 15> reserved{};
};

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
