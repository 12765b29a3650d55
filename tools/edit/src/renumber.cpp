#include "renumber.h"

#include <bendy/format/chunk_reader.h>

#include <algorithm>
#include <cstring>
#include <string_view>

namespace bendy::edit {
namespace {

void store(std::span<std::byte> bytes, std::uint64_t at, std::uint32_t number) {
    std::memcpy(bytes.data() + at, &number, sizeof number);
}

bool has_references(const RecordLayout& layout) {
    return std::any_of(layout.fields.begin(), layout.fields.end(),
                       [](const RecordField& field) { return field.reference.is_any(); });
}

/// Returns true if the record refers to something. Nested records contain no further records.
bool refers(const RecordLayout& layout) {
    const bool inside = std::any_of(layout.fields.begin(), layout.fields.end(), [](const RecordField& field) {
        return field.type == FieldType::record && has_references(*find_layout(field.type_name));
    });
    return inside || has_references(layout);
}

class LeafRenumberer {
public:
    LeafRenumberer(const LeafLayout& leaf, Bytes payload, const NewNumbers& numbers, const RecordRule& rule)
        : leaf_(leaf), payload_(payload), numbers_(numbers), rule_(rule) {}

    Renumbered run() {
        const LocatedParts parts = locate_parts(leaf_, payload_);
        for (const LocatedPart& part : parts.list) {
            out_.resize(out_.size() + part.offset - done_);  // zeros between the parts
            done_ = part.offset + part.size;
            const std::uint64_t kept = put(part);
            if (goes_) return std::move(result_);
            if (part.part->ending == PartEnding::padded) out_.resize(padded(out_.size()));
            if (part.part->ending == PartEnding::padded) done_ = padded(done_);
            if (kept != part.shape.count) store_count(*part.part, kept);
        }
        const Bytes rest = payload_.subspan(done_);
        out_.insert(out_.end(), rest.begin(), rest.end());
        result_.payload = std::move(out_);
        return std::move(result_);
    }

private:
    /// Returns how many of its records, numbers or names are kept.
    std::uint64_t put(const LocatedPart& part) {
        const Bytes bytes = payload_.subspan(part.offset, part.size);
        switch (part.part->kind) {
            case PartKind::record:
                out_.insert(out_.end(), bytes.begin(), bytes.end());
                goes_ = !renumber(*part.shape.record, std::span(out_), &result_.lost);
                return part.shape.count;
            case PartKind::records:
                return put_rows(part, bytes, part.shape.unit());
            case PartKind::numbers:
                if (part.part->each == Entity::nothing && part.part->to == Entity::nothing) break;
                return put_rows(part, bytes, part.shape.unit() * part.shape.row) * part.shape.row;
            case PartKind::names:
                put_names(part, as_text(bytes));
                return part.shape.count;
            default:
                break;
        }
        out_.insert(out_.end(), bytes.begin(), bytes.end());
        return part.shape.count;
    }

    std::uint64_t put_rows(const LocatedPart& part, Bytes bytes, std::uint64_t size) {
        std::uint64_t kept = 0;
        for (std::uint64_t row = 0; (row + 1) * size <= bytes.size(); ++row) {
            if (!stays(part, row)) continue;
            const std::size_t at = out_.size();
            const Bytes before = bytes.subspan(row * size, size);
            out_.insert(out_.end(), before.begin(), before.end());
            const std::span<std::byte> now = std::span(out_).subspan(at);
            if (part.shape.record != nullptr ? renumber(*part.shape.record, now, nullptr) : renumber(part, now)) {
                ++kept;
            } else {
                out_.resize(at);
            }
        }
        return kept;
    }

    void put_names(const LocatedPart& part, std::string_view names) {
        for (std::uint64_t row = 0; !names.empty(); ++row) {
            const std::size_t end = std::min(names.find('\0'), names.size() - 1) + 1;
            const Bytes name = as_byte_span(names.substr(0, end));
            if (stays(part, row)) out_.insert(out_.end(), name.begin(), name.end());
            names.remove_prefix(end);
        }
    }

    [[nodiscard]] bool stays(const LocatedPart& part, std::uint64_t row) const {
        return part.part->each == Entity::nothing ||
               numbers_.number(part.part->each, static_cast<std::uint32_t>(row)) != kNone;
    }

    /// Renumbers the numbers in a row that refer to things.
    [[nodiscard]] bool renumber(const LocatedPart& part, std::span<std::byte> row) const {
        if (part.part->to == Entity::nothing || part.shape.type != NumberType::u32) return true;
        for (std::uint64_t at = 0; at < row.size(); at += sizeof(std::uint32_t)) {
            std::uint32_t number = 0;
            std::memcpy(&number, row.data() + at, sizeof number);
            number = numbers_.number(part.part->to, number);
            if (number == kNone) return false;
            store(row, at, number);
        }
        return true;
    }

    /// Returns false if the record is to be removed.
    bool renumber(const RecordLayout& layout, std::span<std::byte> record, std::vector<Lost>* lost) {
        for (const RecordField& field : layout.fields) {
            if (field.type != FieldType::record) continue;
            const RecordLayout& inner = *find_layout(field.type_name);
            if (field.offset + inner.size > record.size()) continue;
            if (!renumber_fields(inner, record.subspan(field.offset, inner.size), lost)) return false;
        }
        return renumber_fields(layout, record, lost);
    }

    /// The same for its fields that are numbers.
    bool renumber_fields(const RecordLayout& layout, std::span<std::byte> record, std::vector<Lost>* lost) {
        const Buffer copy(record.begin(), record.end());  // selectors are read from the original
        if (rule_ && !rule_(layout, record)) return false;
        for (const RecordField& field : layout.fields) {
            if (field.offset + field.count * field_type_size(field.type) > record.size()) continue;
            if (field.type != FieldType::u32 || !field.reference.is_any()) continue;
            const auto before = static_cast<std::uint32_t>(field_number(field, copy, 0));
            const Entity entity = referred_entity(layout, field, copy, 0);
            if (entity == Entity::nothing || (before == kNone && field.reference.is_optional)) continue;
            const std::uint32_t now = numbers_.number(entity, before);
            if (now == kNone && lost != nullptr) lost->push_back({field.name, entity, before});
            if (now == kNone && !field.reference.is_optional) return false;
            store(record, field.offset, now);
        }
        return true;
    }

    /// Updates the field of the record that holds the count.
    void store_count(const LeafPart& part, std::uint64_t count) {
        const RecordLayout* record = leaf_.record();
        const RecordField* field = record == nullptr ? nullptr : record->find(part.count);
        if (field != nullptr && field->type == FieldType::u32)
            store(out_, field->offset, static_cast<std::uint32_t>(count));
    }

    const LeafLayout& leaf_;
    Bytes payload_;
    const NewNumbers& numbers_;
    const RecordRule& rule_;
    Buffer out_;
    std::uint64_t done_ = 0;  // bytes of the payload that are processed
    bool goes_ = false;
    Renumbered result_;
};

}  // namespace

std::uint32_t NewNumbers::number(Entity thing, std::uint32_t before) const {
    if (thing == Entity::any_material) {
        if ((before & kLocalMaterial) != 0) return own_materials ? before : kNone;
        thing = Entity::material;
    }
    const std::span<const std::uint32_t> list = now[static_cast<std::size_t>(thing)];
    if (list.empty()) return before;
    return before < list.size() ? list[before] : kNone;
}

Renumbered renumber_leaf(const LeafLayout& leaf, Bytes payload, const NewNumbers& numbers, const RecordRule& rule) {
    return LeafRenumberer(leaf, payload, numbers, rule).run();
}

bool has_references(const LeafLayout& leaf) {
    return std::any_of(leaf.parts.begin(), leaf.parts.end(), [](const LeafPart& part) {
        const bool is_record = part.kind == PartKind::record || part.kind == PartKind::records;
        return part.each != Entity::nothing || part.to != Entity::nothing ||
               (is_record && refers(*find_layout(part.type)));
    });
}

void renumber_leaves(const ChunkTree& tree, std::uint32_t container, const NewNumbers& numbers, const LeafRule& rule,
                     const ToldLeaf& told, Rewrite& rewrite) {
    constexpr std::array kByHand{FourCC("PALT"), FourCC("VINF"), FourCC("LODD"), FourCC("TRAK"),
                                 FourCC("PACK"), FourCC("PLAY"), FourCC("SAME")};
    for (std::uint32_t number = container + 1; number < tree[container].end;) {
        const Chunk& chunk = tree[number];
        if (rewrite.is_removed(number) || !is_known(chunk.id)) {
            number = chunk.end;
            continue;
        }
        const std::uint32_t leaf_chunk = number++;
        const LeafLayout* leaf = find_leaf(chunk.id);
        if (chunk.is_container() || leaf == nullptr || !has_references(*leaf)) continue;
        if (std::find(kByHand.begin(), kByHand.end(), chunk.id) != kByHand.end()) continue;
        const Bytes before = tree.payload(leaf_chunk);
        const Renumbered now =
            renumber_leaf(*leaf, before, numbers, [&](const RecordLayout& layout, std::span<std::byte> record) {
                return !rule || rule(leaf_chunk, layout, record);
            });
        if (now.payload && std::equal(now.payload->begin(), now.payload->end(), before.begin(), before.end())) continue;
        if (told) told(leaf_chunk, now);
        if (now.payload) {
            rewrite.replace(leaf_chunk, *now.payload);
        } else {
            rewrite.remove(leaf_chunk);
        }
    }
}

std::string name_of_leaf(const ChunkTree& tree, std::uint32_t chunk) {
    const LeafLayout* leaf = find_leaf(tree[chunk].id);
    if (leaf == nullptr) return {};
    const Bytes payload = tree.payload(chunk);
    const LocatedParts parts = locate_parts(*leaf, payload);
    const LocatedPart* name = parts.find("name");
    if (name == nullptr) return {};
    const std::string text(as_text(payload.subspan(name->offset, name->size)));
    return std::string(tree[chunk].id.letters().data()) + " \"" + text + '"';
}

bool has_references_left(const ChunkTree& tree, std::uint32_t container, const Rewrite& rewrite) {
    for (const std::uint32_t child : tree.children(container)) {
        const LeafLayout* leaf = tree[child].is_container() ? nullptr : find_leaf(tree[child].id);
        if (leaf != nullptr && has_references(*leaf) && !rewrite.is_removed(child)) return true;
    }
    return false;
}

}  // namespace bendy::edit
