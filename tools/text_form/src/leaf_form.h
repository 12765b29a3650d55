#pragma once

#include "number_text.h"

#include <bendy/format/chunk.h>
#include <bendy/format/leaf_parts.h>
#include <bendy/format/record_table.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

// The form of every leaf, shared by both directions: leaf_parts.def lists the parts of the payload, and their names in
// the text. Parts that it calls odd (PACK, LODD, MARK) have a function here.
namespace bendy::text_form {

/// An array of numbers.
struct NumberArray {
    std::string_view name;
    NumberType type = NumberType::f32;
    std::uint64_t count = kTheRest;
    std::uint64_t row = 12;        ///< numbers per line
    bool starts_with_f32 = false;  ///< each row's first number is an f32, whatever the type
    bool is_padded = false;        ///< followed by zeros up to a multiple of 16 from the payload's start
};

/// The steps of walk_leaf: LeafDumper writes text, LeafAssembler builds a payload. A step that returns false ends the
/// walk, and the rest of the payload is "more", in hexadecimal digits.
class LeafSteps {
public:
    LeafSteps() = default;
    LeafSteps(const LeafSteps&) = delete;
    LeafSteps& operator=(const LeafSteps&) = delete;
    LeafSteps(LeafSteps&&) = delete;
    LeafSteps& operator=(LeafSteps&&) = delete;
    virtual ~LeafSteps() = default;

    /// The record at the payload's start.
    virtual bool record(const RecordLayout& layout) = 0;
    virtual bool array(const NumberArray& array) = 0;
    virtual bool records(std::string_view name, const RecordLayout& layout, std::uint64_t count) = 0;
    /// UTF-8, `size` bytes; without a name, the whole content is that text.
    virtual bool text(std::string_view name, std::uint64_t size) = 0;
    /// UTF-8, each name followed by a zero.
    virtual bool names(std::string_view name) = 0;
    /// All remaining bytes, in hexadecimal digits.
    virtual bool bytes(std::string_view name) = 0;

    /// The whole payload, or what has been assembled so far.
    [[nodiscard]] virtual Bytes payload() const = 0;
    [[nodiscard]] virtual std::uint64_t payload_done() const = 0;

    /// The whole of MARK.
    virtual bool markers() = 0;
    // The parts of PACK.
    [[nodiscard]] virtual bool has_packed_tracks() = 0;
    virtual bool joint_bits(std::string_view name, std::uint32_t joints, std::uint32_t& tracks) = 0;
    virtual bool packed_frames(std::string_view name, std::span<const std::uint32_t> widths, std::uint64_t frames) = 0;
    virtual bool zeros(std::uint64_t size) = 0;
    /// Returns the number of collapse targets of a mesh in LODD, which the file does not store in one place.
    virtual std::optional<std::uint64_t> collapsed_vertices(const MeshCollapseRecord& mesh, std::string_view name) = 0;
};

/// Does nothing for a leaf whose payload has no form, only bytes.
void walk_leaf(FourCC chunk, LeafSteps& steps);

}  // namespace bendy::text_form
