#include <bendy/format/leaf_parts.h>

#include <bendy/format/chunk.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>

namespace bendy {
namespace {

struct Row {
    std::string_view leaves;
    LeafPart part;
};

constexpr Row kRows[] = {
#define BENDY_PART(leaves, kind, name, type, count, when, row, ending, each, to, what) \
    {leaves, {PartKind::kind, name, #type, count, when, row, PartEnding::ending, Entity::each, Entity::to}},
#include <bendy/format/leaf_parts.def>
};

/// The parts without the ids, so that the parts of a leaf are a span.
constexpr auto kParts = [] {
    std::array<LeafPart, std::size(kRows)> parts{};
    for (std::size_t k = 0; k < parts.size(); ++k) parts[k] = kRows[k].part;
    return parts;
}();

constexpr std::span<const LeafPart> parts_of(std::string_view chunk) {
    const auto has = [&](std::size_t row) { return kRows[row].leaves.find(chunk) != std::string_view::npos; };
    std::size_t first = 0;
    while (first < std::size(kRows) && !has(first)) ++first;
    std::size_t last = first;
    while (last < std::size(kRows) && has(last)) ++last;
    return std::span(kParts).subspan(first, last - first);
}

constexpr LeafLayout kLeaves[] = {
#define BENDY_CHUNK(id, shape, parents, times, what) {FourCC(#id), parts_of(#id)},
#include <bendy/format/chunk_ids.def>
#undef BENDY_CHUNK
};

constexpr bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

std::uint64_t times(std::uint64_t a, std::uint64_t b) {
    return a != 0 && b > (kTheRest - 1) / a ? kTheRest - 1 : a * b;
}

/// Evaluates a number, or a field of the record at the payload's start; nothing if the payload lacks it.
std::optional<std::uint64_t> operand(const LeafLayout& leaf, std::string_view word, Bytes payload) {
    if (is_digit(word.front())) {
        std::uint64_t number = 0;
        std::from_chars(word.data(), word.data() + word.size(), number);
        return number;
    }
    const RecordLayout* record = leaf.record();
    const RecordField* field = record == nullptr ? nullptr : record->find(word);
    if (field == nullptr || field->offset + field_type_size(field->type) > payload.size()) return std::nullopt;
    return field_number(*field, payload, 0);
}

/// "2 * components".
std::optional<std::uint64_t> product(const LeafLayout& leaf, std::string_view expression, Bytes payload) {
    constexpr std::string_view kTimes = " * ";
    std::uint64_t result = 1;
    while (true) {
        const std::size_t end = expression.find(kTimes);
        const auto factor = operand(leaf, expression.substr(0, end), payload);
        if (!factor) return std::nullopt;
        result = times(result, *factor);
        if (end == std::string_view::npos) return result;
        expression.remove_prefix(end + kTimes.size());
    }
}

/// "packed == 1".
std::optional<bool> holds(const LeafLayout& leaf, std::string_view condition, Bytes payload) {
    if (condition.empty()) return true;
    const std::size_t blank = condition.find(' ');
    const auto left = operand(leaf, condition.substr(0, blank), payload);
    const auto right = operand(leaf, condition.substr(blank + 4), payload);
    if (!left || !right) return std::nullopt;
    return (*left == *right) == (condition.substr(blank + 1, 2) == "==");
}

std::optional<NumberType> number_type_of(const LeafLayout& leaf, std::string_view name, Bytes payload) {
    for (std::uint8_t k = 0; k <= static_cast<std::uint8_t>(NumberType::f32); ++k) {
        const auto type = static_cast<NumberType>(k);
        if (name_of(type) == name) return type;
    }
    const auto said = operand(leaf, name, payload);
    if (!said || *said >= kComponentTypes) return std::nullopt;
    return number_type(static_cast<ComponentType>(*said));
}

/// Returns the size in bytes of the record at the payload's start; nothing if it is cut off.
std::optional<std::uint64_t> record_size(const RecordLayout& record, Bytes payload) {
    if (payload.size() >= record.size) return record.size;
    if (payload.size() == record.shortest) return record.shortest;
    return std::nullopt;
}

bool locate(const LeafLayout& leaf, const LeafPart& part, Bytes payload, LocatedParts& parts) {
    LocatedPart located;
    located.part = &part;
    located.offset = parts.end;
    const std::uint64_t left = payload.size() - parts.end;
    if (part.kind == PartKind::odd) {
        located.size = left;
        parts.end = payload.size();
        parts.list.push_back(located);
        return true;
    }
    const auto shape = shape_of(leaf, part, payload);
    if (!shape) return false;
    if (!shape->is_there) return true;
    located.shape = *shape;
    if (part.kind == PartKind::record) {
        const auto size = record_size(*shape->record, payload);
        if (!size) return false;
        located.size = *size;
    } else {
        if (shape->count == kTheRest) located.shape.count = left / shape->unit();
        if (located.shape.count > left / shape->unit()) return false;
        located.size = located.shape.count * shape->unit();
    }
    const std::uint64_t end = parts.end + located.size;
    parts.end = part.ending == PartEnding::padded ? padded(end) : end;
    if (parts.end > payload.size()) {
        parts.end = located.offset;
        return false;
    }
    parts.list.push_back(located);
    return true;
}

}  // namespace

const RecordLayout* LeafLayout::record() const {
    return !parts.empty() && parts.front().kind == PartKind::record ? find_layout(parts.front().type) : nullptr;
}

const LeafLayout* find_leaf(FourCC chunk) {
    const auto* found = std::find_if(std::begin(kLeaves), std::end(kLeaves),
                                     [&](const LeafLayout& leaf) { return leaf.chunk == chunk; });
    return found == std::end(kLeaves) || found->parts.empty() ? nullptr : found;
}

std::optional<PartShape> shape_of(const LeafLayout& leaf, const LeafPart& part, Bytes payload) {
    PartShape shape;
    const auto is_there = holds(leaf, part.when, payload);
    if (!is_there) return std::nullopt;
    shape.is_there = *is_there;
    if (part.kind == PartKind::record || part.kind == PartKind::records) {
        shape.record = find_layout(part.type);
    } else {
        const auto type = number_type_of(leaf, part.type, payload);
        if (!type) return std::nullopt;
        shape.type = *type;
        shape.row = operand(leaf, part.row, payload).value_or(0);
        if (shape.row == 0) return std::nullopt;
    }
    if (part.count == "rest") {
        shape.count = kTheRest;
        return shape;
    }
    const auto count = product(leaf, part.count, payload);
    if (!count) return std::nullopt;
    shape.count = *count;
    return shape;
}

const LocatedPart* LocatedParts::find(std::string_view name) const {
    const auto found =
        std::find_if(list.begin(), list.end(), [&](const LocatedPart& part) { return part.part->name == name; });
    return found == list.end() ? nullptr : &*found;
}

LocatedParts locate_parts(const LeafLayout& leaf, Bytes payload) {
    LocatedParts parts;
    parts.is_whole = std::all_of(leaf.parts.begin(), leaf.parts.end(),
                                 [&](const LeafPart& part) { return locate(leaf, part, payload, parts); });
    return parts;
}

const RecordLayout* layout_of(FourCC chunk) {
    const LeafLayout* leaf = find_leaf(chunk);
    if (leaf == nullptr) return nullptr;
    const LeafPart& first = leaf->parts.front();
    return first.kind == PartKind::record || first.kind == PartKind::records ? find_layout(first.type) : nullptr;
}

bool is_text(FourCC chunk) {
    const LeafLayout* leaf = find_leaf(chunk);
    return leaf != nullptr && leaf->parts.front().kind == PartKind::text;
}

bool is_stream(FourCC chunk) {
    const LeafLayout* leaf = find_leaf(chunk);
    return leaf != nullptr && leaf->parts.front().type == "StreamRecord";
}

}  // namespace bendy
