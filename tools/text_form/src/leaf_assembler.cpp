#include "leaf_assembler.h"

#include <bendy/format/marker.h>
#include <bendy/format/names.h>
#include <bendy/format/packed_clip.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace bendy::text_form {
namespace {

std::string quoted(std::string_view name) {
    constexpr std::size_t kShown = 40;
    std::string text = "\"";
    text.append(name.substr(0, kShown));
    return text.append(name.size() > kShown ? "...\"" : "\"");
}

/// Returns true if the field is beyond the shortest form of its record.
bool is_late(const RecordLayout& layout, const RecordField& field) {
    return field.offset >= layout.shortest;
}

}  // namespace

std::string_view kind_name(ValueKind kind) {
    constexpr std::array<std::string_view, 6> kNames{"null",     "true or false", "a number",
                                                     "a string", "an array",      "an object"};
    return kNames[static_cast<std::size_t>(kind)];
}

std::optional<FaultAt> read_hex(const LeafValues& values, std::uint64_t value, std::vector<std::byte>& out) {
    const auto append = [&](std::uint64_t string) -> std::optional<FaultAt> {
        if (values.kind(string) != ValueKind::string) {
            return FaultAt{values.offset(string), "there should be a string of hexadecimal digits, not " +
                                                      std::string(kind_name(values.kind(string)))};
        }
        if (parse_hex(values.characters(string), out)) return std::nullopt;
        return FaultAt{values.offset(string), "the string is not an even number of hexadecimal digits"};
    };
    if (values.kind(value) != ValueKind::array) return append(value);
    for (std::uint64_t line = LeafValues::first(value); line != values.next(value); line = values.next(line)) {
        if (auto fault = append(line)) return fault;
    }
    return std::nullopt;
}

bool LeafAssembler::fail(std::uint64_t value, std::string what) {
    if (!fault_) fault_ = FaultAt{values_.offset(value), std::move(what)};
    return false;
}

std::optional<FaultAt> LeafAssembler::assemble(FourCC chunk, std::uint64_t content) {
    fault_.reset();
    payload_.clear();
    object_.members.clear();
    content_ = content;
    is_whole_ = false;
    const ValueKind kind = values_.kind(content);
    if (kind == ValueKind::object) {
        if (!read_object(content, object_)) return fault_;
        if (Member* hex = find(object_, "hex")) {
            hex->is_used = true;
            if (auto fault = read_hex(values_, hex->value, payload_)) return fault;
            check_all_used(object_);
            return fault_;
        }
    } else if (kind != ValueKind::string) {
        return FaultAt{values_.offset(content),
                       "a chunk holds an array of chunks, or an object or text, not " + std::string(kind_name(kind))};
    } else if (!is_text(chunk)) {
        return FaultAt{values_.offset(content), "there should be an object with fields, not text"};
    }
    walk_leaf(chunk, *this);
    if (fault_ || is_whole_) return fault_;
    if (Member* more = find(object_, "more")) {
        more->is_used = true;
        if (auto fault = read_hex(values_, more->value, payload_)) return fault;
    } else if (payload_.empty() && object_.members.empty()) {
        fail(content, "there are no fields: a payload without a form is given as \"hex\"");
        return fault_;
    }
    check_all_used(object_);
    return fault_;
}

bool LeafAssembler::read_object(std::uint64_t value, Object& object) {
    if (values_.kind(value) != ValueKind::object)
        return fail(value, "there should be an object, not " + std::string(kind_name(values_.kind(value))));
    object.value = value;
    object.members.clear();
    const std::uint64_t end = values_.next(value);
    for (std::uint64_t key = LeafValues::first(value); key != end;) {
        const std::uint64_t member = values_.next(key);
        object.members.push_back({key, member, false});
        key = values_.next(member);
    }
    const auto name = [&](const Member& member) { return values_.characters(member.key); };
    std::stable_sort(object.members.begin(), object.members.end(),
                     [&](const Member& a, const Member& b) { return name(a) < name(b); });
    for (std::size_t k = 1; k < object.members.size(); ++k) {
        if (name(object.members[k - 1]) != name(object.members[k])) continue;
        return fail(object.members[k].key, quoted(name(object.members[k])) + " appears here twice");
    }
    return true;
}

LeafAssembler::Member* LeafAssembler::find(Object& object, std::string_view name) const {
    const auto found = std::lower_bound(
        object.members.begin(), object.members.end(), name,
        [&](const Member& member, std::string_view wanted) { return values_.characters(member.key) < wanted; });
    if (found == object.members.end() || values_.characters(found->key) != name) return nullptr;
    return &*found;
}

LeafAssembler::Member* LeafAssembler::need(Object& object, std::string_view name) {
    Member* member = find(object, name);
    if (member == nullptr) fail(object.value, quoted(name) + " is missing");
    return member;
}

bool LeafAssembler::check_all_used(const Object& object) {
    const Member* first = nullptr;
    for (const Member& member : object.members) {
        if (!member.is_used && (first == nullptr || member.key < first->key)) first = &member;
    }
    if (first == nullptr) return true;
    return fail(first->key, "there is no field " + quoted(values_.characters(first->key)) + " here");
}

std::uint64_t LeafAssembler::part(std::string_view name) {
    Member* member = find(object_, name);
    if (member == nullptr) {
        if (find(object_, "more") == nullptr) fail(content_, quoted(name) + " is missing");
        return kNowhere;
    }
    member->is_used = true;
    return member->value;
}

std::uint64_t LeafAssembler::length(std::uint64_t array) const {
    std::uint64_t count = 0;
    for (std::uint64_t value = LeafValues::first(array); value != values_.next(array); value = values_.next(value))
        ++count;
    return count;
}

bool LeafAssembler::append_number(std::uint64_t value, NumberType type, std::string_view name,
                                  std::vector<std::byte>& out) {
    NumberFault fault = NumberFault::no_number;
    switch (values_.kind(value)) {
        case ValueKind::number:
            fault = parse_number(text_.substr(values_.offset(value)), type, out);
            break;
        case ValueKind::string:
            if (type != NumberType::f32)
                return fail(value, quoted(name) + ": there should be a whole number, not a string");
            if (parse_special(values_.characters(value), out) == NumberFault::none) return true;
            return fail(
                value,
                quoted(name) + R"(: a float is a number, "inf", "-inf" or "nan:0x7fc00000" with the bits of a NaN)");
        default:
            return fail(
                value, quoted(name) + ": there should be a number, not " + std::string(kind_name(values_.kind(value))));
    }
    switch (fault) {
        case NumberFault::none:
            return true;
        case NumberFault::not_whole:
            return fail(value, quoted(name) + ": the number must be whole, without a point or exponent");
        case NumberFault::out_of_range:
            return fail(value, quoted(name) + ": the number is out of the range of " + std::string(name_of(type)));
        case NumberFault::no_number:
            break;
    }
    return fail(value, quoted(name) + ": this is not a number");
}

bool LeafAssembler::record(const RecordLayout& layout) {
    const bool has_late = std::any_of(layout.fields.begin(), layout.fields.end(), [&](const RecordField& field) {
        return is_late(layout, field) && find(object_, field.name) != nullptr;
    });
    const std::uint64_t size = has_late || layout.shortest == 0 ? layout.size : layout.shortest;
    payload_.resize(size);
    return fill(layout, object_, 0, size);
}

LeafAssembler::Member* LeafAssembler::take_member(const RecordField& field, Object& object) {
    Member* member = field.is_reserved() ? find(object, field.name) : need(object, field.name);
    if (member != nullptr) member->is_used = true;
    return member;
}

bool LeafAssembler::fill(const RecordLayout& layout, Object& object, std::uint64_t base, std::uint64_t size) {
    for (const RecordField& field : layout.fields) {
        if (field.offset >= size) continue;
        const Member* member = take_member(field, object);
        if (fault_) return false;
        if (member == nullptr) continue;  // zeros
        const std::uint64_t at = base + field.offset;
        const bool is_record = field.type == FieldType::record;
        if (!(is_record ? fill_record(*find_layout(field.type_name), member->value, at)
                        : fill_numbers(field, member->value, at)))
            return false;
    }
    return true;
}

/// Appends a nested record, which contains only numbers.
bool LeafAssembler::fill_record(const RecordLayout& layout, std::uint64_t value, std::uint64_t at) {
    Object object;
    if (!read_object(value, object)) return false;
    for (const RecordField& field : layout.fields) {
        const Member* member = take_member(field, object);
        if (fault_) return false;
        if (member != nullptr && !fill_numbers(field, member->value, at + field.offset)) return false;
    }
    return check_all_used(object);
}

bool LeafAssembler::fill_text(const RecordField& field, std::uint64_t value, std::uint64_t at) {
    const Bytes text = as_byte_span(values_.characters(value));
    if (text.size() > field.count) {
        return fail(value, quoted(field.name) + " has room for " + counted(field.count, "byte") + ", not " +
                               std::to_string(text.size()));
    }
    std::copy(text.begin(), text.end(), payload_.begin() + static_cast<std::ptrdiff_t>(at));
    return true;
}

bool LeafAssembler::fill_numbers(const RecordField& field, std::uint64_t value, std::uint64_t at) {
    if (field.is_text() && values_.kind(value) == ValueKind::string) return fill_text(field, value, at);
    const NumberType type = number_type(field.type);
    std::vector<std::byte> bytes;
    if (field.count == 1) {
        if (!append_number(value, type, field.name, bytes)) return false;
    } else {
        if (!is_array(value)) {
            return fail(value, quoted(field.name) + ": there should be an array of " + counted(field.count, "number") +
                                   ", not " + std::string(kind_name(values_.kind(value))));
        }
        if (length(value) != field.count) {
            return fail(value, quoted(field.name) + " takes " + counted(field.count, "number") + ", not " +
                                   std::to_string(length(value)));
        }
        for (std::uint64_t each = LeafValues::first(value); each != values_.next(value); each = values_.next(each)) {
            if (!append_number(each, type, field.name, bytes)) return false;
        }
    }
    std::copy(bytes.begin(), bytes.end(), payload_.begin() + static_cast<std::ptrdiff_t>(at));
    return true;
}

std::uint64_t LeafAssembler::array_part(std::string_view name) {
    const std::uint64_t value = part(name);
    if (value == kNowhere || is_array(value)) return value;
    fail(value, quoted(name) + ": there should be an array, not " + std::string(kind_name(values_.kind(value))));
    return kNowhere;
}

bool LeafAssembler::array(const NumberArray& array) {
    constexpr std::uint64_t kNumbersPerTick = 1u << 16;
    const std::uint64_t value = array_part(array.name);
    if (value == kNowhere) return false;
    const std::uint64_t count = length(value);
    if (array.count != kTheRest && count != array.count) {
        return fail(value, quoted(array.name) + " has " + counted(count, "number") + "; the counts beside it ask for " +
                               std::to_string(array.count));
    }
    const std::uint64_t size = payload_.size() + count * size_of(array.type);
    if (size > payload_.capacity()) payload_.reserve(std::max<std::uint64_t>(size, 2 * payload_.capacity()));
    std::uint64_t done = 0;
    for (std::uint64_t each = LeafValues::first(value); each != values_.next(value); each = values_.next(each)) {
        const bool is_f32 = array.starts_with_f32 && done % array.row == 0;
        if (!append_number(each, is_f32 ? NumberType::f32 : array.type, array.name, payload_)) return false;
        if (++done % kNumbersPerTick == 0) tick_(values_.offset(each));
    }
    if (array.is_padded) payload_.resize(padded(payload_.size()));
    return true;
}

bool LeafAssembler::records(std::string_view name, const RecordLayout& layout, std::uint64_t count) {
    const std::uint64_t value = array_part(name);
    if (value == kNowhere) return false;
    const std::uint64_t found = length(value);
    if (count != kTheRest && found != count) {
        return fail(value, quoted(name) + " has " + counted(found, "object") + "; the counts beside it ask for " +
                               std::to_string(count));
    }
    Object object;
    for (std::uint64_t each = LeafValues::first(value); each != values_.next(value); each = values_.next(each)) {
        if (!read_object(each, object)) return false;
        const std::uint64_t at = payload_.size();
        payload_.resize(at + layout.size);
        if (!fill(layout, object, at, layout.size) || !check_all_used(object)) return false;
    }
    return true;
}

bool LeafAssembler::read_u32(std::uint64_t value, std::string_view name, std::uint32_t& number) {
    std::vector<std::byte> bytes;
    if (!append_number(value, NumberType::u32, name, bytes)) return false;
    copy_at(Bytes(bytes), 0, number);
    return true;
}

bool LeafAssembler::joint_bits(std::string_view name, std::uint32_t joints, std::uint32_t& tracks) {
    const std::uint64_t value = array_part(name);
    if (value == kNowhere) return false;
    const std::uint64_t at = payload_.size();
    payload_.resize(at + (joints + 7) / 8);
    std::uint32_t least = 0;
    for (std::uint64_t each = LeafValues::first(value); each != values_.next(value); each = values_.next(each)) {
        std::uint32_t joint = 0;
        if (!read_u32(each, name, joint)) return false;
        if (joint < least || joint >= joints)
            return fail(each, quoted(name) + " ascends, and each number is below \"joints\"");
        payload_[at + joint / 8] |= std::byte{1} << (joint % 8);
        least = joint + 1;
        ++tracks;
    }
    return true;
}

bool LeafAssembler::packed_frames(std::string_view name, std::span<const std::uint32_t> widths, std::uint64_t frames) {
    const std::uint64_t value = array_part(name);
    if (value == kNowhere) return false;
    std::vector<std::uint32_t> row;
    std::uint64_t bits = 0;
    for (const std::uint32_t width : widths) {
        if (width > kMaxPackedBits) return fail(value, quoted(name) + ": a width is more than 24 bits");
        if (width != 0) row.push_back(width);
        bits += width;
    }
    const std::uint64_t count = length(value);
    if (count != frames * row.size()) {
        return fail(value, quoted(name) + " has " + counted(count, "number") + "; frames and widths ask for " +
                               std::to_string(frames * row.size()));
    }
    if (row.empty()) return true;
    const std::uint64_t stride = (bits + 7) / 8;
    const std::uint64_t at = payload_.size();
    payload_.resize(at + frames * stride);
    std::uint64_t each = LeafValues::first(value);
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
        std::uint64_t bit = (at + frame * stride) * 8;
        for (const std::uint32_t width : row) {
            std::uint32_t number = 0;
            if (!read_u32(each, name, number)) return false;
            if (number >> width != 0)
                return fail(each, quoted(name) + ": the number needs more than its " + counted(width, "bit"));
            for (std::uint64_t shifted = std::uint64_t{number} << (bit % 8), byte = bit / 8; shifted != 0;
                 shifted >>= 8)
                payload_[byte++] |= static_cast<std::byte>(shifted & 0xffu);
            bit += width;
            each = values_.next(each);
        }
    }
    return true;
}

bool LeafAssembler::bytes(std::string_view name) {
    const std::uint64_t value = part(name);
    if (value == kNowhere) return false;
    fault_ = read_hex(values_, value, payload_);
    return !fault_;
}

bool LeafAssembler::text(std::string_view name, std::uint64_t size) {
    is_whole_ = name.empty();
    const std::uint64_t value = is_whole_ ? content_ : part(name);
    if (value == kNowhere) return false;
    if (values_.kind(value) != ValueKind::string) {
        return fail(value, is_whole_ ? std::string(R"(there should be text, or an object with "hex")")
                                     : quoted(name) + ": there should be a string, not " +
                                           std::string(kind_name(values_.kind(value))));
    }
    const Bytes text = as_byte_span(values_.characters(value));
    if (size != kTheRest && text.size() != size) {
        return fail(value, quoted(name) + " has " + counted(text.size(), "byte") + "; the sizes beside it ask for " +
                               std::to_string(size));
    }
    payload_.insert(payload_.end(), text.begin(), text.end());
    return true;
}

bool LeafAssembler::names(std::string_view name) {
    const std::uint64_t value = array_part(name);
    if (value == kNowhere) return false;
    for (std::uint64_t each = LeafValues::first(value); each != values_.next(value); each = values_.next(each)) {
        if (values_.kind(each) != ValueKind::string) {
            return fail(each,
                        quoted(name) + ": there should be a string, not " + std::string(kind_name(values_.kind(each))));
        }
        const std::string_view text = values_.characters(each);
        if (text.find('\0') != std::string_view::npos)
            return fail(each, quoted(name) + ": a name in this list cannot hold a zero character");
        const Bytes bytes = as_byte_span(text);
        payload_.insert(payload_.end(), bytes.begin(), bytes.end());
        payload_.push_back(std::byte{0});
    }
    return true;
}

bool LeafAssembler::zeros(std::uint64_t size) {
    payload_.resize(payload_.size() + size);
    return true;
}

bool LeafAssembler::markers() {
    const std::uint64_t value = array_part("markers");
    if (value == kNowhere) return false;
    std::vector<Marker> markers;
    std::uint64_t size = 0;
    Object object;
    std::vector<std::byte> seconds;
    for (std::uint64_t each = LeafValues::first(value); each != values_.next(value); each = values_.next(each)) {
        if (!read_object(each, object)) return false;
        Member* const time = need(object, "seconds");
        Member* const name = need(object, "name");
        if (fault_) return false;
        time->is_used = name->is_used = true;
        seconds.clear();
        if (!append_number(time->value, NumberType::f32, "seconds", seconds)) return false;
        if (values_.kind(name->value) != ValueKind::string) {
            return fail(name->value,
                        "\"name\": there should be a string, not " + std::string(kind_name(values_.kind(name->value))));
        }
        if (!check_all_used(object)) return false;
        Marker& marker = markers.emplace_back();
        copy_at(Bytes(seconds), 0, marker.seconds);
        marker.name = values_.characters(name->value);
        size += marker.name.size();
        if (size > std::numeric_limits<std::uint32_t>::max()) {
            return fail(name->value, "\"markers\": all names together are longer than 4 GiB");
        }
    }
    payload_ = write_markers(markers);
    return true;
}

std::optional<std::uint64_t> LeafAssembler::collapsed_vertices(const MeshCollapseRecord&, std::string_view name) {
    const std::uint64_t value = part(name);
    if (value == kNowhere) return std::nullopt;
    return is_array(value) ? length(value) : 0;
}

}  // namespace bendy::text_form
