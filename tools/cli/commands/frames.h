#pragma once

#include <bendy/runtime.h>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <string>

// The frames of a clip that one command writes, from one opening of the file.
namespace bendy::tools {

/// Frames `first` to `last`; frame k is at k / rate seconds on the clip's time line.
struct FrameRange {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    double rate = 0.0;  ///< frames per second, above 0

    [[nodiscard]] std::uint32_t count() const { return last - first + 1; }
    [[nodiscard]] float time(std::uint32_t frame) const { return static_cast<float>(frame / rate); }
};

/// Returns true for text that read_frame_range takes, or that was meant for it.
bool is_frame_range(const std::string& text);
/// Parses A..B@RATE; throws CLI::ValidationError for any other text.
FrameRange read_frame_range(const std::string& text);

/// Warns of frames that are outside the clip: they show its first or last pose.
void warn_outside(const std::filesystem::path& file, const Clip& clip, const FrameRange& range);

/// Returns true if the output's name has a place for the frame's number: a run of #.
bool is_numbered(const std::filesystem::path& output);
/// Throws CLI::ValidationError unless the output is_numbered.
void require_numbered(const std::filesystem::path& output);
/// Returns the output of a frame: its number, with zeros before it, replaces the last run of # in the name.
/// \param output  is_numbered
std::filesystem::path frame_output(const std::filesystem::path& output, std::uint32_t frame);

}  // namespace bendy::tools
