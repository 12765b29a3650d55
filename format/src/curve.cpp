#include <bendy/format/curve.h>

#include <bendy/format/chunk_writer.h>
#include <bendy/format/read_record.h>
#include <bendy/format/text.h>

#include <array>
#include <cassert>
#include <limits>

namespace bendy {
namespace {

constexpr std::uint32_t kMostComponents = 4;

constexpr std::uint64_t values_of(std::uint32_t keys, std::uint32_t components, Interpolation interpolation) {
    return std::uint64_t{keys} * components * (interpolation == Interpolation::cubic ? 3 : 1);
}

/// Returns the number of numbers in the box.
constexpr std::uint64_t box_size(const CurveRecord& record) {
    return record.packed != 0 ? std::uint64_t{2} * record.components : 0;
}

/// Returns the size of the payload in bytes. No sum of the record's numbers overflows.
std::uint64_t payload_size(const CurveRecord& record) {
    const std::uint64_t value = record.packed != 0 ? sizeof(std::uint16_t) : sizeof(float);
    return sizeof record + (box_size(record) + record.keys) * sizeof(float) + record.values * value + record.path_size +
           record.name_size;
}

bool check_target(const CurveRecord& record, const TargetCounts& counts, std::uint64_t offset, Faults& faults) {
    if (record.kind == static_cast<std::uint8_t>(CurveTarget::nothing)) {
        if (record.target == kNone) return true;
        faults.add({ErrorCode::kIndexRange, offset, record.target, 0});
        return false;
    }
    struct Kind {
        std::uint32_t count;
        ErrorCode fault;
    };
    const std::array<Kind, kCurveTargets> kinds{{{0, ErrorCode::kIndexRange},
                                                 {counts.joints, ErrorCode::kJointRange},
                                                 {counts.materials, ErrorCode::kMaterialRange},
                                                 {counts.meshes, ErrorCode::kMeshRange},
                                                 {counts.textures, ErrorCode::kTextureRange}}};
    const auto& [count, fault] = kinds[record.kind];
    if (record.target < count) return true;
    faults.add({fault, offset, record.target, count});
    return false;
}

bool check_record(const CurveRecord& record, std::uint64_t size, std::uint64_t offset, Faults& faults) {
    check_reserved(std::array{record.reserved}, offset, faults);
    if (!check_enum(record.interpolation, kInterpolations, offset, faults)) return false;
    if (!check_enum(record.packed, 2, offset, faults)) return false;
    if (!check_enum(record.kind, kCurveTargets, offset, faults)) return false;
    const auto interpolation = static_cast<Interpolation>(record.interpolation);
    const bool is_shape = record.keys > 0 && record.components > 0 && record.components <= kMostComponents &&
                          record.values == values_of(record.keys, record.components, interpolation) &&
                          (record.packed == 0 || interpolation != Interpolation::cubic);
    if (!is_shape) {
        faults.add({ErrorCode::kCurveShape, offset});
        return false;
    }
    if (size == payload_size(record)) return true;
    faults.add({ErrorCode::kRecordSize, offset, size, payload_size(record)});
    return false;
}

}  // namespace

std::optional<CurveView> read_curve(Bytes payload, const TargetCounts& counts, std::uint64_t offset, Faults& faults) {
    CurveRecord record;
    if (payload.size() < sizeof record) {
        faults.add({ErrorCode::kRecordTooShort, offset, payload.size(), sizeof record});
        return std::nullopt;
    }
    copy_at(payload, 0, record);
    if (!check_record(record, payload.size(), offset, faults)) return std::nullopt;
    if (!check_target(record, counts, offset, faults)) return std::nullopt;
    CurveView curve;
    curve.kind = static_cast<CurveTarget>(record.kind);
    curve.target = record.target;
    curve.components = record.components;
    curve.interpolation = static_cast<Interpolation>(record.interpolation);
    curve.keys = record.keys;
    curve.max_error = record.max_error;
    std::uint64_t at = sizeof record;
    curve.box = view_at<float>(payload, at, box_size(record));
    at += curve.box.size_bytes();
    curve.times = view_at<float>(payload, at, record.keys);
    at += curve.times.size_bytes();
    if (record.packed != 0) {
        curve.packed = view_at<std::uint16_t>(payload, at, record.values);
    } else {
        curve.values = view_at<float>(payload, at, record.values);
    }
    at += curve.packed.size_bytes() + curve.values.size_bytes();
    curve.path = as_text(payload.subspan(at, record.path_size));
    curve.name = as_text(payload.subspan(at + record.path_size));
    if (is_utf8(curve.path) && is_utf8(curve.name)) return curve;
    faults.add({ErrorCode::kNotUtf8, offset});
    return std::nullopt;
}

std::vector<std::byte> write_curve(const CurveView& curve) {
    assert(curve.times.size() == curve.keys);
    assert(curve.value_count() == values_of(curve.keys, curve.components, curve.interpolation));
    assert(curve.box.size() == (curve.is_packed() ? std::size_t{2} * curve.components : 0));
    assert(curve.value_count() <= std::numeric_limits<std::uint32_t>::max());
    CurveRecord record;
    record.keys = curve.keys;
    record.components = static_cast<std::uint8_t>(curve.components);
    record.interpolation = static_cast<std::uint8_t>(curve.interpolation);
    record.packed = curve.is_packed() ? 1 : 0;
    record.kind = static_cast<std::uint8_t>(curve.kind);
    record.target = curve.target;
    record.max_error = curve.max_error;
    record.values = static_cast<std::uint32_t>(curve.value_count());
    record.path_size = static_cast<std::uint32_t>(curve.path.size());
    record.name_size = static_cast<std::uint32_t>(curve.name.size());
    std::vector<std::byte> payload;
    payload.reserve(payload_size(record));
    for (const Bytes part :
         {bytes_of(record), std::as_bytes(curve.box), std::as_bytes(curve.times), std::as_bytes(curve.values),
          std::as_bytes(curve.packed), as_byte_span(curve.path), as_byte_span(curve.name)})
        payload.insert(payload.end(), part.begin(), part.end());
    return payload;
}

void check_curve_values(const CurveView& curve, std::uint64_t offset, Faults& faults) {
    check_finite(std::array{curve.max_error}, offset, faults);
    if (curve.max_error < 0.0f) faults.add({ErrorCode::kBelowZero, offset, offsetof(CurveRecord, max_error)});
    check_finite(curve.box, offset, faults);
    check_finite(curve.times, offset, faults);
    check_finite(curve.values, offset, faults);
    for (std::size_t key = 1; key < curve.times.size(); ++key) {
        if (curve.times[key] > curve.times[key - 1]) continue;
        faults.add({ErrorCode::kCurveOrder, offset, key});
        return;
    }
}

}  // namespace bendy
