#include <bendy/text_form/text_form.h>

#include "leaf_form.h"

#include <bendy/format/marker.h>
#include <bendy/format/packed_clip.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::text_form {
namespace {

constexpr std::uint64_t kHexBytesPerLine = 32;
constexpr std::size_t kLongestLine = 110;

/// Appends `"name": `
void append_key(std::string& out, std::string_view name) {
    out.append(1, '"').append(name).append("\": ");
}

/// Returns true if the chunk's ancestors are `parents`, for the few levels that are of interest.
bool stands_in(const ChunkTree& tree, std::uint32_t number, std::span<const FourCC> parents) {
    for (const FourCC id : parents) {
        number = tree[number].parent;
        if (tree[number].id != id) return false;
    }
    return number == 0;
}

/// Returns a line's indentation: one space per level, up to a limit, since skeletons may be 65,000 levels deep.
std::uint64_t indentation(std::uint64_t depth) {
    constexpr std::uint64_t kMost = 40;
    return depth < kMost ? depth : kMost;
}

/// Appends a JSON string with its quotes.
/// \param text  UTF-8
void append_json_string(std::string& out, std::string_view text) {
    out += '"';
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out.append(1, '\\').append(1, c);
        } else if (c == '\n') {
            out += "\\n";
        } else if (c == '\t') {
            out += "\\t";
        } else if (byte < 0x20 || byte == 0x7f) {
            append_hex(out.append("\\u00"), std::as_bytes(std::span(&c, 1)));
        } else {
            out += c;
        }
    }
    out += '"';
}

/// Appends hexadecimal digits: a string or, if there are many, an array of strings, one per line.
void append_json_hex(std::string& out, Bytes bytes, std::uint64_t depth) {
    const bool is_long = bytes.size() > kHexBytesPerLine;
    if (is_long) out += '[';
    std::uint64_t at = 0;
    do {
        if (is_long) out.append(at == 0 ? "\n" : ",\n").append(indentation(depth + 1), ' ');
        const std::uint64_t size = std::min<std::uint64_t>(kHexBytesPerLine, bytes.size() - at);
        out += '"';
        append_hex(out, bytes.subspan(at, size));
        out += '"';
        at += size;
    } while (at < bytes.size());
    if (is_long) out.append(1, '\n').append(indentation(depth), ' ').append(1, ']');
}

/// Writes the content of leaves: one side of leaf_form.h.
class LeafDumper final : public LeafSteps {
public:
    /// \param tick  called now and then while a long array is written
    LeafDumper(const ChunkTree& tree, std::string& out, std::function<void()> tick)
        : tree_(tree), out_(out), tick_(std::move(tick)) {}

    /// Appends the leaf's payload as JSON.
    /// \param depth  of the line on which it begins
    void dump(std::uint32_t leaf, std::uint64_t depth) {
        leaf_ = leaf;
        depth_ = depth;
        payload_ = tree_.payload(leaf);
        at_ = 0;
        members_.clear();
        is_open_ = false;
        is_whole_ = false;
        is_cut_ = false;
        walk_leaf(tree_[leaf].id, *this);
        finish();
    }

    bool record(const RecordLayout& layout) override {
        const std::uint64_t size = payload_.size() >= layout.size ? layout.size : payload_.size();
        if (size != layout.size && size != layout.shortest) return false;
        append_fields(layout, 0, size, members_);
        at_ = size;
        return true;
    }

    bool array(const NumberArray& array) override {
        const std::uint64_t size = size_of(array.type);
        const std::uint64_t count = array.count == kTheRest ? left() / size : array.count;
        if (count > left() / size) return cut();
        const std::uint64_t end = at_ + count * size;
        const std::uint64_t padded_end = array.is_padded ? padded(end) : end;
        if (padded_end > payload_.size() || !are_zeros(end, padded_end - end)) return cut();
        std::vector<Rows> rows{{0, array.row}};
        if (tree_[leaf_].id == FourCC("KEYV")) rows = rows_of_keys();
        begin_member(array.name, rows.size() == 1 && count <= array.row);
        append_numbers(array, count, rows);
        at_ = padded_end;
        return true;
    }

    bool records(std::string_view name, const RecordLayout& layout, std::uint64_t count) override {
        if (count == kTheRest) count = left() / layout.size;
        if (count > left() / layout.size) return cut();
        begin_member(name);
        out_ += '[';
        std::vector<std::string> fields;
        for (std::uint64_t k = 0; k < count; ++k) {
            if (k != 0) out_ += ',';
            new_line(depth_ + 2);
            fields.clear();
            append_fields(layout, at_, layout.size, fields);
            out_ += '{';
            for (std::size_t f = 0; f < fields.size(); ++f) out_.append(f == 0 ? "" : ", ").append(fields[f]);
            out_ += '}';
            at_ += layout.size;
        }
        out_ += ']';
        return true;
    }

    bool text(std::string_view name, std::uint64_t size) override {
        if (size == kTheRest) size = left();
        if (size > left()) return cut();
        const std::string_view text = as_text(payload_.subspan(at_, size));
        const bool is_whole = name.empty();
        if (!is_utf8(text)) return is_whole ? false : cut();
        if (!is_whole) begin_member(name);
        append_json_string(out_, text);
        at_ += size;
        is_whole_ = is_whole;
        return true;
    }

    bool names(std::string_view name) override {
        std::string_view text = as_text(payload_);
        if (!is_utf8(text) || (!text.empty() && text.back() != '\0')) return false;
        begin_member(name);
        out_ += '[';
        for (bool is_first = true; !text.empty(); is_first = false) {
            const std::size_t end = text.find('\0');
            if (!is_first) out_ += ',';
            new_line(depth_ + 2);
            append_json_string(out_, text.substr(0, end));
            text.remove_prefix(end + 1);
        }
        out_ += ']';
        at_ = payload_.size();
        return true;
    }

    bool bytes(std::string_view name) override {
        begin_member(name, left() <= kHexBytesPerLine);
        append_json_hex(out_, payload_.subspan(at_), depth_ + 1);
        at_ = payload_.size();
        return true;
    }

    [[nodiscard]] Bytes payload() const override { return payload_; }
    [[nodiscard]] std::uint64_t payload_done() const override { return at_; }

    /// Writes the names, which people edit, not the offsets of their ends: a payload with anything else has no form.
    bool markers() override {
        Faults unread;
        const auto markers = read_markers(payload_, 0, unread);
        if (!markers || !unread.empty()) return false;
        begin_member("markers");
        out_ += '[';
        for (std::size_t k = 0; k < markers->size(); ++k) {
            if (k != 0) out_ += ',';
            new_line(depth_ + 2);
            out_ += "{\"seconds\": ";
            append_number(out_, NumberType::f32, payload_, sizeof(MarkersRecord) + k * sizeof(MarkerRecord));
            out_ += ", \"name\": ";
            append_json_string(out_, (*markers)[k].name);
            out_ += '}';
        }
        out_ += ']';
        at_ = payload_.size();
        return true;
    }

    /// If so, read_packed has checked sizes, widths and the zeros at the end.
    [[nodiscard]] bool has_packed_tracks() override {
        constexpr std::uint32_t kMostJoints = 65535;
        Faults unread;
        return read_packed(payload_, kMostJoints, 0, unread).has_value();
    }

    bool joint_bits(std::string_view name, std::uint32_t joints, std::uint32_t& tracks) override {
        begin_member(name);
        out_ += '[';
        for (std::uint32_t joint = 0; joint < joints; ++joint) {
            if ((std::to_integer<unsigned>(payload_[at_ + joint / 8]) >> (joint % 8) & 1u) == 0) continue;
            if (tracks++ != 0) out_ += ", ";
            out_ += std::to_string(joint);
        }
        out_ += ']';
        at_ += (joints + 7) / 8;
        return true;
    }

    bool packed_frames(std::string_view name, std::span<const std::uint32_t> widths, std::uint64_t frames) override {
        std::uint64_t bits = 0;
        for (const std::uint32_t width : widths) bits += width;
        const std::uint64_t stride = (bits + 7) / 8;
        const auto number_at = [&](std::uint64_t bit, std::uint32_t width) {
            std::uint32_t word = 0;  // the end of a frame is kPackedTail bytes or more from the payload's end
            copy_at(payload_, bit / 8, word);
            return word >> (bit % 8) & ((1u << width) - 1);
        };
        for (std::uint64_t frame = 0; frame < frames; ++frame) {
            const auto spare = static_cast<std::uint32_t>(stride * 8 - bits);
            if (number_at((at_ + frame * stride) * 8 + bits, spare) != 0) return cut();
        }
        begin_member(name);
        out_ += '[';
        bool is_first = true;
        for (std::uint64_t frame = 0; frame < frames; ++frame) {
            std::uint64_t bit = (at_ + frame * stride) * 8;
            bool begins_row = true;
            for (const std::uint32_t width : widths) {
                if (width == 0) continue;
                if (!is_first) out_ += begins_row ? "," : ", ";
                if (begins_row) new_line(depth_ + 2);
                out_ += std::to_string(number_at(bit, width));
                bit += width;
                begins_row = false;
                is_first = false;
            }
        }
        out_ += ']';
        at_ += frames * stride;
        return true;
    }

    bool zeros(std::uint64_t size) override {
        at_ += size;
        return true;
    }

    std::optional<std::uint64_t> collapsed_vertices(const MeshCollapseRecord& mesh, std::string_view) override {
        is_cut_ = true;  // unless the end is reached
        constexpr std::array kObject{FourCC("OBJE"), FourCC("HEAD")};
        if (!stands_in(tree_, leaf_, kObject)) return std::nullopt;
        const std::uint32_t object = tree_[leaf_].parent;
        if (object != object_) {
            object_ = object;
            vertices_.clear();
            for (const std::uint32_t child : tree_.children(object)) {
                if (tree_[child].id != FourCC("VECT")) continue;
                MeshRecord info;
                const std::uint32_t leaf = tree_.find(child, FourCC("VINF"));
                if (leaf != kNone) copy_at(tree_.payload(leaf), 0, info);
                vertices_.push_back(info.vertices);
            }
        }
        if (mesh.mesh >= vertices_.size() || mesh.base > vertices_[mesh.mesh]) return std::nullopt;
        if (mesh.target_type != static_cast<std::uint8_t>(ComponentType::u16) &&
            mesh.target_type != static_cast<std::uint8_t>(ComponentType::u32))
            return std::nullopt;
        is_cut_ = false;
        return vertices_[mesh.mesh] - mesh.base;
    }

private:
    /// Numbers from `first` on are written `stride` per line.
    struct Rows {
        std::uint64_t first = 0;
        std::uint64_t stride = 1;
    };

    /// Appends the fields of the record at `base` that the payload contains, each as `"name": value`.
    void append_fields(const RecordLayout& layout, std::uint64_t base, std::uint64_t size,
                       std::vector<std::string>& out) {
        for (const RecordField& field : layout.fields) {
            const std::uint64_t at = base + field.offset;
            if (field.offset >= size || is_left_out(field, at)) continue;
            std::string member;
            append_key(member, field.name);
            if (field.type == FieldType::record) {
                append_record(*find_layout(field.type_name), at, member);
            } else {
                append_field(field, at, member);
            }
            out.push_back(std::move(member));
        }
    }

    /// Appends a nested record, which contains only numbers.
    void append_record(const RecordLayout& layout, std::uint64_t base, std::string& out) {
        out += '{';
        bool is_first = true;
        for (const RecordField& field : layout.fields) {
            const std::uint64_t at = base + field.offset;
            if (is_left_out(field, at)) continue;
            if (!is_first) out += ", ";
            append_key(out, field.name);
            append_field(field, at, out);
            is_first = false;
        }
        out += '}';
    }

    void append_field(const RecordField& field, std::uint64_t at, std::string& out) {
        if (field.is_text()) {
            const std::string_view whole = as_text(payload_.subspan(at, field.count));
            const std::string_view text = whole.substr(0, whole.find('\0'));
            if (is_utf8(text) && are_zeros(at + text.size(), field.count - text.size())) {
                append_json_string(out, text);
                return;
            }
        }
        const NumberType type = number_type(field.type);
        if (field.count != 1) out += '[';
        for (std::uint32_t k = 0; k < field.count; ++k) {
            if (k != 0) out += ", ";
            append_number(out, type, payload_, at + k * size_of(type));
        }
        if (field.count != 1) out += ']';
    }

    [[nodiscard]] bool is_left_out(const RecordField& field, std::uint64_t at) const {
        return field.is_reserved() && are_zeros(at, field.count * field_type_size(field.type));
    }

    void append_numbers(const NumberArray& array, std::uint64_t count, std::span<const Rows> rows) {
        constexpr std::uint64_t kNumbersPerTick = 1u << 16;
        const std::uint64_t size = size_of(array.type);
        const bool is_one_line = rows.size() == 1 && count <= rows.front().stride;
        out_ += '[';
        std::uint64_t in_row = 0;
        std::size_t row = 0;
        for (std::uint64_t k = 0; k < count; ++k) {
            const std::size_t before = row;
            while (row + 1 < rows.size() && k >= rows[row + 1].first) ++row;
            if (row != before || in_row == rows[row].stride) in_row = 0;
            if (k != 0) out_ += in_row == 0 ? "," : ", ";
            if (in_row == 0 && !is_one_line) new_line(depth_ + 2);
            const bool is_f32 = array.starts_with_f32 && in_row == 0;
            append_number(out_, is_f32 ? NumberType::f32 : array.type, payload_, at_ + k * size);
            ++in_row;
            if (k % kNumbersPerTick == 0) tick_();
        }
        out_ += ']';
    }

    /// \param is_short  the value may stay on the record's line, if that is empty
    void begin_member(std::string_view name, bool is_short = false) {
        const bool is_first = members_.empty() && !is_open_;
        if (!is_open_) write_members();
        if (!is_first) out_ += ',';
        if (!is_first || !is_short) new_line(depth_ + 1);
        append_key(out_, name);
    }

    /// Ends the walk over the form: the rest is "more".
    bool cut() {
        is_cut_ = true;
        return false;
    }

    /// Writes the record's fields on one line if they are short, otherwise one per line.
    void write_members() {
        std::size_t size = 0;
        for (const std::string& member : members_) size += member.size() + 2;
        const bool is_short = size <= kLongestLine;
        out_ += '{';
        for (std::size_t k = 0; k < members_.size(); ++k) {
            if (k != 0) out_ += is_short ? ", " : ",";
            if (!is_short) new_line(depth_ + 1);
            out_ += members_[k];
        }
        is_open_ = true;
    }

    void new_line(std::uint64_t depth) { out_.append(1, '\n').append(indentation(depth), ' '); }

    void finish() {
        if (is_whole_) return;
        const bool has_nothing = members_.empty() && !is_open_;
        if (left() != 0 || is_cut_ || has_nothing) bytes(has_nothing ? "hex" : "more");
        if (!is_open_) write_members();
        out_ += '}';
    }

    [[nodiscard]] std::uint64_t left() const { return payload_.size() - at_; }

    [[nodiscard]] bool are_zeros(std::uint64_t at, std::uint64_t size) const {
        const Bytes bytes = payload_.subspan(at, size);
        return std::all_of(bytes.begin(), bytes.end(), [](std::byte byte) { return byte == std::byte{0}; });
    }

    /// Returns the rows with one line per key, as for the tracks to which the values belong.
    std::vector<Rows> rows_of_keys() {
        constexpr std::array kClip{FourCC("CYCL"), FourCC("OBJE"), FourCC("HEAD")};
        constexpr std::uint64_t kUsual = 12;
        std::vector<Rows> rows{{0, kUsual}};
        const std::uint32_t clip = tree_[leaf_].parent;
        if (clip == clip_ || !stands_in(tree_, leaf_, kClip)) return rows;
        clip_ = clip;
        const std::uint32_t table = tree_.find(clip, FourCC("TRAK"));
        if (table == kNone) return rows;
        for (const TrackRecord& track :
             view_at<TrackRecord>(tree_.payload(table), 0, tree_.payload(table).size() / sizeof(TrackRecord))) {
            const std::uint64_t values = track.interpolation == static_cast<std::uint8_t>(Interpolation::cubic) ? 3 : 1;
            rows.push_back({track.first_value, std::max<std::uint64_t>(values * track.components, 1)});
        }
        std::stable_sort(rows.begin(), rows.end(), [](const Rows& a, const Rows& b) { return a.first < b.first; });
        return rows;
    }

    const ChunkTree& tree_;
    std::string& out_;
    std::function<void()> tick_;

    std::uint32_t leaf_ = 0;
    std::uint64_t depth_ = 0;
    Bytes payload_;
    std::uint64_t at_ = 0;              // bytes of the payload written so far
    std::vector<std::string> members_;  // a record's fields, until it is known whether they fit on one line
    bool is_open_ = false;              // the object's opening brace has been written
    bool is_whole_ = false;             // the content is not an object, and has been written
    bool is_cut_ = false;               // a part of the form is missing

    std::uint32_t object_ = kNone;         // the object that the meshes belong to
    std::vector<std::uint32_t> vertices_;  // per mesh
    std::uint32_t clip_ = kNone;           // the clip whose keys have been written by track
};

/// Writes the chunks in file order.
class Dumper {
public:
    Dumper(const ChunkTree& tree, const DumpOptions& options, const Progress& progress)
        : tree_(tree), options_(options), progress_(progress), leaf_(tree, out_, [this] { tick(); }) {}

    std::string run() && {
        out_ = "{\"bendy_text\": 1,\n ";
        for (number_ = 0; number_ < tree_.chunks().size(); ++number_) {
            end_containers();
            begin_chunk();
            tick();
        }
        end_containers();
        out_ += '\n';
        return std::move(out_);
    }

private:
    void end_containers() {
        while (!open_.empty() && tree_[open_.back()].end == number_) {
            const std::uint32_t container = open_.back();
            open_.pop_back();
            out_ += ']';
            end_chunk(container);
        }
    }

    void begin_chunk() {
        const Chunk& chunk = tree_[number_];
        if (number_ != 0) {
            const bool is_first = number_ == open_.back() + 1;
            out_.append(is_first ? "\n" : ",\n").append(indentation(open_.size()), ' ').append(1, '{');
        }
        out_.append(1, '"').append(chunk.id.letters().data()).append("\": ");
        if (chunk.is_container()) {
            out_ += '[';
            open_.push_back(number_);
            return;
        }
        if (tree_.encoding_fault(number_)) {
            out_ += "null";
        } else {
            leaf_.dump(number_, open_.size());
        }
        end_chunk(number_);
    }

    /// Writes what follows a chunk's content.
    void end_chunk(std::uint32_t number) {
        const Chunk& chunk = tree_[number];
        if (chunk.is_required()) out_ += ", \"required\": true";
        if (chunk.codec() != 0 && (!options_.decode || tree_.encoding_fault(number))) {
            out_.append(", \"codec\": ").append(std::to_string(chunk.codec())).append(", \"encoded\": ");
            append_json_hex(out_, tree_.stored(number), open_.size());
        }
        out_ += '}';
    }

    void tick() {
        if (progress_) progress_(tree_[number_].offset, tree_.bytes().size());
    }

    const ChunkTree& tree_;
    const DumpOptions& options_;
    const Progress& progress_;
    std::string out_;
    LeafDumper leaf_;
    std::uint32_t number_ = 0;
    std::vector<std::uint32_t> open_;  // open containers
};

}  // namespace

std::string dump(const ChunkTree& tree, const DumpOptions& options, const Progress& progress) {
    return Dumper(tree, options, progress).run();
}

}  // namespace bendy::text_form
