#pragma once

#include "number_text.h"

#include <bendy/format/fourcc.h>
#include <bendy/format/leaf_parts.h>
#include <bendy/format/record_table.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

// The form of every leaf, once for both directions: leaf_parts.def says what follows what in the payload, and under
// which name it is in the text. What it calls odd (PACK, LODD, MARK) has a function here.
namespace bendy::text_form {

/// Numbers in a row.
struct NumberArray {
    std::string_view name;
    NumberType type = NumberType::f32;
    std::uint64_t count = kTheRest;
    std::uint64_t row = 12;        ///< numbers on a line
    bool starts_with_f32 = false;  ///< each row's first number is an f32, whatever the type
    bool is_padded = false;        ///< zeros behind it, up to a multiple of 16 from the payload's start
};

/// What walk_leaf does, step by step: LeafDumper writes text, LeafAssembler makes a payload. A step that gives false
/// ends the walk, and the rest of the payload is "more", in hexadecimal digits.
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
    /// UTF-8 of so many bytes; the whole content is that text if there is no name.
    virtual bool text(std::string_view name, std::uint64_t size) = 0;
    /// UTF-8 with a zero behind each.
    virtual bool names(std::string_view name) = 0;
    /// All that is left, in hexadecimal digits.
    virtual bool bytes(std::string_view name) = 0;

    /// All of it, or what has been assembled so far.
    [[nodiscard]] virtual Bytes payload() const = 0;
    [[nodiscard]] virtual std::uint64_t payload_done() const = 0;

    /// All of MARK.
    virtual bool markers() = 0;
    // The parts of PACK.
    [[nodiscard]] virtual bool has_packed_tracks() = 0;
    virtual bool joint_bits(std::string_view name, std::uint32_t joints, std::uint32_t& tracks) = 0;
    virtual bool packed_frames(std::string_view name, std::span<const std::uint32_t> widths, std::uint64_t frames) = 0;
    virtual bool zeros(std::uint64_t size) = 0;
    /// How many targets LODD has of a mesh; the file does not say it in one place.
    virtual std::optional<std::uint64_t> collapsed_vertices(const MeshCollapseRecord& mesh, std::string_view name) = 0;
};

/// Nothing happens for a leaf whose payload has no form: only bytes.
void walk_leaf(FourCC chunk, LeafSteps& steps);

}  // namespace bendy::text_form
