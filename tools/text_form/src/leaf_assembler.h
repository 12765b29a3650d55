#pragma once

#include "leaf_form.h"
#include "leaf_value.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::text_form {

/// An error, and the byte of the text at which it is.
struct FaultAt {
    std::uint64_t offset = 0;
    std::string what;
};

/// Returns "a number", "an array", ...
std::string_view kind_name(ValueKind kind);

/// Appends the bytes of a string of hexadecimal digits, or of an array of such strings.
std::optional<FaultAt> read_hex(const LeafValues& values, std::uint64_t value, std::vector<std::byte>& out);

/// Turns the JSON of a leaf's content into its payload: the other side of leaf_form.h.
class LeafAssembler final : public LeafSteps {
public:
    /// \param text    the text that the values were read from
    /// \param tick    called now and then with a position in the text while a long array is read
    LeafAssembler(std::string_view text, const LeafValues& values, std::function<void(std::uint64_t)> tick)
        : text_(text), values_(values), tick_(std::move(tick)) {}

    /// Builds the payload of a chunk from a value; returns a fault if the value does not have the chunk's form.
    std::optional<FaultAt> assemble(FourCC chunk, std::uint64_t content);

    std::vector<std::byte> take_payload() { return std::move(payload_); }

    bool record(const RecordLayout& layout) override;
    bool array(const NumberArray& array) override;
    bool records(std::string_view name, const RecordLayout& layout, std::uint64_t count) override;
    bool text(std::string_view name, std::uint64_t size) override;
    bool names(std::string_view name) override;
    bool bytes(std::string_view name) override;
    [[nodiscard]] Bytes payload() const override { return payload_; }
    [[nodiscard]] std::uint64_t payload_done() const override { return payload_.size(); }
    bool markers() override;
    [[nodiscard]] bool has_packed_tracks() override { return find(object_, "tracks") == nullptr; }
    bool joint_bits(std::string_view name, std::uint32_t joints, std::uint32_t& tracks) override;
    bool packed_frames(std::string_view name, std::span<const std::uint32_t> widths, std::uint64_t frames) override;
    bool zeros(std::uint64_t size) override;
    std::optional<std::uint64_t> collapsed_vertices(const MeshCollapseRecord& mesh, std::string_view name) override;

private:
    /// A name and its value in an object.
    struct Member {
        std::uint64_t key = 0;
        std::uint64_t value = 0;
        bool is_used = false;
    };
    /// Sorted by name, so that look-ups are fast for every text.
    struct Object {
        std::uint64_t value = 0;
        std::vector<Member> members;
    };

    bool fail(std::uint64_t value, std::string what);
    bool read_object(std::uint64_t value, Object& object);
    Member* find(Object& object, std::string_view name) const;
    /// Returns the member with this name; if there is none, adds a fault at the object.
    Member* need(Object& object, std::string_view name);
    bool check_all_used(const Object& object);
    /// Returns a member of the content; kNowhere, without a fault, if "more" replaces it.
    std::uint64_t part(std::string_view name);
    bool fill(const RecordLayout& layout, Object& object, std::uint64_t base, std::uint64_t size);
    bool fill_record(const RecordLayout& layout, std::uint64_t value, std::uint64_t at);
    /// Returns the field's member, if it exists or must exist; null, without a fault, for reserved fields that are left
    /// out.
    Member* take_member(const RecordField& field, Object& object);
    bool fill_text(const RecordField& field, std::uint64_t value, std::uint64_t at);
    bool fill_numbers(const RecordField& field, std::uint64_t value, std::uint64_t at);
    bool read_u32(std::uint64_t value, std::string_view name, std::uint32_t& number);
    /// Returns the array with this name; kNowhere if it is missing, with a fault unless "more" replaces it.
    std::uint64_t array_part(std::string_view name);
    bool append_number(std::uint64_t value, NumberType type, std::string_view name, std::vector<std::byte>& out);
    [[nodiscard]] std::uint64_t length(std::uint64_t array) const;
    [[nodiscard]] bool is_array(std::uint64_t value) const { return values_.kind(value) == ValueKind::array; }

    static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

    std::string_view text_;
    const LeafValues& values_;
    std::function<void(std::uint64_t)> tick_;
    std::optional<FaultAt> fault_;
    std::vector<std::byte> payload_;
    std::uint64_t content_ = 0;
    Object object_;
    bool is_whole_ = false;  // the content is not an object, and has been read
};

}  // namespace bendy::text_form
