#include "frame_cycles.h"

#include <charconv>
#include <cstdint>
#include <limits>
#include <string_view>
#include <system_error>

namespace bendy::converter::md2 {
namespace {

constexpr std::size_t kCountingDigits = 2;
constexpr std::uint64_t kNoNumber = std::numeric_limits<std::uint64_t>::max();

struct FrameName {
    std::string_view letters;
    std::string_view digits;
    std::uint64_t number = 0;  ///< or kNoNumber
};

FrameName take_apart(std::string_view name) {
    constexpr std::string_view kDigits = "0123456789";
    const std::size_t last = name.find_last_not_of(kDigits);
    FrameName parts;
    parts.letters = name.substr(0, last == std::string_view::npos ? 0 : last + 1);
    parts.digits = name.substr(parts.letters.size());
    const char* const end = parts.digits.data() + parts.digits.size();
    const auto read = std::from_chars(parts.digits.data(), end, parts.number);
    if (read.ec != std::errc()) parts.number = kNoNumber;
    return parts;
}

std::string name_of(const FrameName& first) {
    std::string_view kept;
    if (first.digits.size() > kCountingDigits) kept = first.digits.substr(0, first.digits.size() - kCountingDigits);
    if (kept.find_first_not_of('0') == std::string_view::npos) kept = {};
    return std::string(first.letters) + std::string(kept);
}

}  // namespace

std::vector<FrameRun> find_runs(std::span<const std::string> names) {
    std::vector<FrameRun> runs;
    FrameName before;
    for (std::size_t frame = 0; frame < names.size(); ++frame) {
        const FrameName name = take_apart(names[frame]);
        const bool goes_on = !runs.empty() && name.letters == before.letters && name.number != kNoNumber &&
                             before.number != kNoNumber && name.number == before.number + 1;
        if (!goes_on) runs.push_back({name_of(name), frame, 0});
        ++runs.back().count;
        before = name;
    }
    return runs;
}

}  // namespace bendy::converter::md2
