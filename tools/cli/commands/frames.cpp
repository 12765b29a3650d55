#include "commands/frames.h"

#include "reports/messages.h"

#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

namespace bendy::tools {
namespace {

constexpr std::uint32_t kMostFrames = 100'000;
constexpr std::string_view kDots = "..";

/// Parses the whole text as a number.
template <class Number>
bool parse(std::string_view text, Number& number) {
    const char* const end = text.data() + text.size();
    const auto [stop, problem] = std::from_chars(text.data(), end, number);
    return problem == std::errc() && stop == end;
}

}  // namespace

bool is_frame_range(const std::string& text) {
    return text.find(kDots) != std::string::npos || text.find('@') != std::string::npos;
}

FrameRange read_frame_range(const std::string& text) {
    const std::size_t dots = text.find(kDots);
    const std::size_t at = text.find('@');
    FrameRange range;
    const bool has_both = dots != std::string::npos && at != std::string::npos && dots < at;
    const std::string_view view = text;
    const bool is_good = has_both && parse(view.substr(0, dots), range.first) &&
                         parse(view.substr(dots + kDots.size(), at - dots - kDots.size()), range.last) &&
                         parse(view.substr(at + 1), range.rate);
    if (!is_good || !std::isfinite(range.rate) || range.rate < 1e-3)
        throw CLI::ValidationError("--frames", "must be A..B@RATE, such as 0..59@30: frames A to B, RATE per second");
    if (range.last < range.first || range.last - range.first >= kMostFrames) {
        throw CLI::ValidationError(
            "--frames", "the last frame must be the first or up to " + std::to_string(kMostFrames - 1) + " after it");
    }
    return range;
}

void warn_outside(const std::filesystem::path& file, const Clip& clip, const FrameRange& range) {
    std::uint32_t outside = 0;
    for (std::uint32_t frame = range.first; frame - range.first < range.count(); ++frame)
        outside += range.time(frame) < clip.start || range.time(frame) > clip.end ? 1u : 0u;
    if (outside == 0) return;
    std::ostringstream text;
    text << outside << " of " << range.count() << " frames are outside the clip, which lasts from " << clip.start
         << " to " << clip.end << " s: they show its first or last pose";
    warn(file, text.str());
}

bool is_numbered(const std::filesystem::path& output) {
    return output.filename().u8string().find(u8'#') != std::u8string::npos;
}

void require_numbered(const std::filesystem::path& output) {
    if (is_numbered(output)) return;
    throw CLI::ValidationError("--output", "must have # where the frame's number goes, such as run_####" +
                                               printable(output.extension().string()));
}

std::filesystem::path frame_output(const std::filesystem::path& output, std::uint32_t frame) {
    std::u8string name = output.filename().u8string();
    const std::size_t last = name.rfind(u8'#');
    const std::size_t before = name.find_last_not_of(u8'#', last);
    const std::size_t first = before == std::u8string::npos ? 0 : before + 1;
    const std::string digits = std::to_string(frame);
    const std::size_t width = last + 1 - first;
    std::u8string number(digits.size() < width ? width - digits.size() : 0, u8'0');
    number.append(digits.begin(), digits.end());
    name.replace(first, width, number);
    return output.parent_path() / name;
}

}  // namespace bendy::tools
