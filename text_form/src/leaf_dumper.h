#pragma once

#include "leaf_form.h"

#include <bendy/format/chunk_reader.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::text_form {

/// Returns a line's indentation: one space per level, up to a limit, since skeletons may be 65,000 levels deep.
inline std::uint64_t indentation(std::uint64_t depth) {
    constexpr std::uint64_t kMost = 40;
    return depth < kMost ? depth : kMost;
}

/// Appends a JSON string with its quotes.
/// \param text  UTF-8
void append_json_string(std::string& out, std::string_view text);
/// Appends hexadecimal digits: a string or, if there are many, an array of strings, one per line.
void append_json_hex(std::string& out, Bytes bytes, std::uint64_t depth);

/// Writes the content of leaves: one side of leaf_form.h.
class LeafDumper final : public LeafSteps {
public:
    /// \param tick  called now and then while a long array is written
    LeafDumper(const ChunkTree& tree, std::string& out, std::function<void()> tick)
        : tree_(tree), out_(out), tick_(std::move(tick)) {}

    /// Appends the leaf's payload as JSON.
    /// \param depth  of the line on which it begins
    void dump(std::uint32_t leaf, std::uint64_t depth);

    bool record(const RecordLayout& layout) override;
    bool array(const NumberArray& array) override;
    bool records(std::string_view name, const RecordLayout& layout, std::uint64_t count) override;
    bool text(std::string_view name, std::uint64_t size) override;
    bool names(std::string_view name) override;
    bool bytes(std::string_view name) override;
    [[nodiscard]] Bytes payload() const override { return payload_; }
    [[nodiscard]] std::uint64_t payload_done() const override { return at_; }
    bool markers() override;
    [[nodiscard]] bool has_packed_tracks() override;
    bool joint_bits(std::string_view name, std::uint32_t joints, std::uint32_t& tracks) override;
    bool packed_frames(std::string_view name, std::span<const std::uint32_t> widths, std::uint64_t frames) override;
    bool zeros(std::uint64_t size) override;
    std::optional<std::uint64_t> collapsed_vertices(const MeshCollapseRecord& mesh, std::string_view name) override;

private:
    /// Numbers from `first` on are written `stride` per line.
    struct Rows {
        std::uint64_t first = 0;
        std::uint64_t stride = 1;
    };

    /// Appends the fields of the record at `base` that the payload contains, each as `"name": value`.
    void append_fields(const RecordLayout& layout, std::uint64_t base, std::uint64_t size,
                       std::vector<std::string>& out);
    void append_record(const RecordLayout& layout, std::uint64_t base, std::string& out);
    void append_field(const RecordField& field, std::uint64_t at, std::string& out);
    [[nodiscard]] bool is_left_out(const RecordField& field, std::uint64_t at) const;
    void append_numbers(const NumberArray& array, std::uint64_t count, std::span<const Rows> rows);
    /// \param is_short  the value may stay on the record's line, if that is empty
    void begin_member(std::string_view name, bool is_short = false);
    bool cut();
    void write_members();
    void new_line(std::uint64_t depth);
    void finish();
    [[nodiscard]] std::uint64_t left() const { return payload_.size() - at_; }
    [[nodiscard]] bool are_zeros(std::uint64_t at, std::uint64_t size) const;
    std::vector<Rows> rows_of_keys();

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

}  // namespace bendy::text_form
