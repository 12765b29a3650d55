#pragma once

#include <bendy/format/error.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

// Helpers shared by the readers of all records.
namespace BENDY_PUBLIC bendy {

/// Reads the record in the container's only leaf with this id. Returns nothing, without a fault, for a missing leaf
/// (check_grammar reports it); returns nothing, and adds a fault, for a faulty one.
template <class R>
std::optional<R> read_child_record(const ChunkTree& tree, std::uint32_t container, FourCC id, Faults& faults) {
    const std::uint32_t number = tree.find(container, id);
    if (number == kNone || tree[number].is_container()) return std::nullopt;
    const Result<R> record = read_record<R>(tree, number);
    if (!record) {
        faults.add(record.error());
        return std::nullopt;
    }
    return *record;
}

/// Returns the offset of a container's leaf with this id, for faults in it; the container's own offset if it has none.
inline std::uint64_t offset_of(const ChunkTree& tree, std::uint32_t container, FourCC id) {
    const std::uint32_t number = tree.find(container, id);
    return tree[number == kNone ? container : number].offset;
}

/// Checks that reserved fields are zero: a later version may give them a meaning.
template <class Field>
void check_reserved(const Field& field, std::uint64_t offset, Faults& faults) {
    for (const auto value : field) {
        if (value != 0) {
            faults.add({ErrorCode::kReservedField, offset, value});
            return;
        }
    }
}

/// Returns true if `value` is below `known`; otherwise adds a fault.
inline bool check_enum(unsigned value, unsigned known, std::uint64_t offset, Faults& faults) {
    if (value < known) return true;
    faults.add({ErrorCode::kEnumRange, offset, value, known});
    return false;
}

/// Adds a fault at the first number that is NaN or infinite.
inline void check_finite(std::span<const float> numbers, std::uint64_t offset, Faults& faults) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (!std::isfinite(numbers[i])) {
            faults.add({ErrorCode::kNotFinite, offset, i});
            return;
        }
    }
}

/// Returns true if x y z w has length 1 within `tolerance`.
inline bool is_unit(std::span<const float, 4> q, float tolerance) {
    const double length =
        std::sqrt(double{q[0]} * q[0] + double{q[1]} * q[1] + double{q[2]} * q[2] + double{q[3]} * q[3]);
    return std::abs(length - 1.0) <= tolerance;  // false for NaN
}

}  // namespace bendy
