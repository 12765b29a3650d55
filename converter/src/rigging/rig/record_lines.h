#pragma once

#include "fields.h"

#include <bendy/format/records.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

// Constraints and chains as JSON text that fields.h reads back bit for bit.

namespace bendy::converter {

/// The shortest text of a float; null if it is infinite.
std::string json_text(float number);

/// As above, of text.
std::string json_text(std::string_view text);

/// [...], of floats.
std::string json_list(std::span<const float> numbers);

/// A JSON object on one line; members with default values are omitted. Keys and words are given as in rig files.
class RecordLine {
public:
    explicit RecordLine(Notation notation) : notation_(notation) {}

    void add(std::string_view key, const std::string& json);
    void add_word(std::string_view key, std::span<const std::string_view> words, std::uint8_t number);
    void add_count(std::string_view key, unsigned number);
    void add_number(std::string_view key, float number, float usual = 0.0f);
    void add_angle(std::string_view key, float angle, float usual = 0.0f);
    void add_numbers(std::string_view key, std::span<const float> numbers, std::span<const float> usual);
    void add_angles(std::string_view key, std::span<const float> angles, std::span<const float> usual);
    /// Omitted if both are free.
    void add_range(std::string_view key, float low, float high);
    void add_angle_range(std::string_view key, float low, float high);
    void add_flag(std::string_view key, std::uint8_t flags, std::uint8_t flag);

    [[nodiscard]] bool empty() const { return text_.empty(); }
    [[nodiscard]] std::string text() const { return '{' + text_ + '}'; }

private:
    [[nodiscard]] std::string angles_text(std::span<const float> angles) const;

    Notation notation_;
    std::string text_;
};

/// A constraint; ranges that its model does not use are left out.
std::string write_constraint(const ConstraintRecord& constraint, Notation notation);

/// Adds what a chain has beside its name, joints, weights and extras.
void add_chain_settings(RecordLine& line, const ChainRecord& record);

/// Adds what a standing pose has beside its rotations.
void add_standing_settings(RecordLine& line, const StandingPoseRecord& record);

}  // namespace bendy::converter
