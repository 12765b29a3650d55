#include "scene/failure.h"
#include "scene/source/source_file.h"
#include "scene/space.h"

#include <bendy/converter/import.h>
#include <bendy/format/charconv.h>
#include <bendy/format/text.h>

#include <utf8cpp/utf8.h>
#include <glm/ext/scalar_constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::converter {

namespace bvh {
namespace {

constexpr double kCentimetre = 0.01;
constexpr double kLargest = 1e15;  ///< of a number
/// Frames are counted in floats, so that times ascend.
constexpr std::size_t kMostFrames = std::size_t{1} << 22;
constexpr std::size_t kMostChannels = 6;     ///< of a joint: each once
constexpr double kAssumedStep = 1.0 / 30.0;  ///< seconds, where the file's frame time is not above 0
constexpr char kEndOfText = '\x1a';          ///< Ctrl-Z, with which DOS ended texts

char small(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// True if the word is `expected`, which is in lower case, in any case.
bool is(std::string_view word, std::string_view expected) {
    return std::equal(word.begin(), word.end(), expected.begin(), expected.end(),
                      [](char a, char b) { return small(a) == b; });
}

bool is_brace(char c) {
    return c == '{' || c == '}';
}

/// True for the first byte of a Shift-JIS character of two bytes; the second one may be a brace. Above 0xe0 are also
/// letters of Latin-1, and characters whose second byte is a brace are rare there.
bool is_pair(char first, char second) {
    const auto lead = static_cast<unsigned char>(first);
    const auto trail = static_cast<unsigned char>(second);
    if (trail < 0x40 || trail == 0x7f || trail > 0xfc) return false;
    return (lead >= 0x81 && lead <= 0x9f) || (lead >= 0xe0 && lead <= 0xfc && !is_brace(second));
}

/// The text as words; a brace is one. Line ends mean no more than spaces, unless they are asked for: files differ in
/// where they break lines.
class Words {
public:
    explicit Words(std::string_view text) : text_(text), has_pairs_(!is_utf8(text)) {
        if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
    }

    /// Empty at the end of the text.
    std::string_view next() {
        skip_space();
        const std::size_t begin = at_;
        while (at_ < text_.size() && !is_space(text_[at_]) && !is_brace(text_[at_])) {
            const bool pair = has_pairs_ && text_.size() - at_ > 1 && is_pair(text_[at_], text_[at_ + 1]);
            at_ += pair ? 2 : 1;
        }
        if (at_ == begin && at_ < text_.size()) ++at_;
        return word_ = text_.substr(begin, at_ - begin);
    }
    bool is_at_end() {
        skip_space();
        return at_ == text_.size();
    }
    /// True if no further word is on the line.
    bool is_at_line_end() {
        while (at_ < text_.size() && is_space(text_[at_]) && !is_line_end(text_[at_])) ++at_;
        return at_ == text_.size() || is_line_end(text_[at_]);
    }
    /// Whether a word that begins as a number does comes next.
    bool is_at_number() {
        constexpr std::string_view kFirst = "+-.0123456789";
        return !is_at_end() && kFirst.find(text_[at_]) != std::string_view::npos;
    }
    /// The place of the last word.
    [[nodiscard]] std::string place() const { return "line " + std::to_string(line_); }
    /// Whether a NUL was before the last word.
    [[nodiscard]] bool is_after_nul() const { return is_after_nul_; }

    /// From here on a colon is a space: `Frames:10`.
    void split_at_colons() { colon_ = ':'; }
    /// From here on the text ends where `other` is.
    void end_at(const Words& other) { text_ = text_.substr(0, other.at_); }

    void expect(std::string_view word) {
        if (const std::string_view found = next(); !is(found, word)) fail_at(found, "'" + std::string(word) + "'");
    }
    [[noreturn]] void fail_at(std::string_view found, const std::string& expected) const {
        fail(place(), "expected " + expected + ", found " + (found.empty() ? "the end of the file" : quote(found)));
    }

    /// A number as it is written: also infinite ones, and those that are none.
    double raw_number() {
        const std::string_view word = next();
        const char* begin = word.data();
        const char* end = begin + word.size();
        if (word.starts_with('+')) ++begin;
        double value = 0.0;
        const auto read = from_chars(begin, end, value);
        if (word.empty() || read.ec != std::errc() || read.ptr != end) fail_at(word, "a number");
        return value;
    }
    double number() {
        const double value = raw_number();
        if (std::isnan(value)) fail_at(word_, "a number");
        if (!(std::abs(value) <= kLargest)) fail(place(), "the number " + quote(word_) + " is implausibly large");
        return value;
    }
    std::size_t count(std::size_t most, const char* what) {
        const double value = number();
        if (!(value >= 0.0 && value <= static_cast<double>(most)) || value != std::floor(value))
            fail(place(), std::string(what) + ": expected a whole number from 0 to " + std::to_string(most));
        return static_cast<std::size_t>(value);
    }

private:
    static bool is_line_end(char c) { return c == '\n' || c == '\r'; }
    [[nodiscard]] bool is_space(char c) const {
        return c == ' ' || (c >= '\t' && c <= '\r') || c == '\0' || c == colon_;
    }
    void skip_space() {
        is_after_nul_ = false;
        for (; at_ < text_.size() && is_space(text_[at_]); ++at_) {
            const bool is_half = text_[at_] == '\r' && text_.size() - at_ > 1 && text_[at_ + 1] == '\n';
            line_ += is_line_end(text_[at_]) && !is_half ? 1u : 0u;
            is_after_nul_ = is_after_nul_ || text_[at_] == '\0';
        }
    }

    std::string_view text_;
    std::string_view word_;  ///< the last one
    std::size_t at_ = 0;
    std::size_t line_ = 1;
    char colon_ = ' ';
    bool has_pairs_;
    bool is_after_nul_ = false;
};

/// The text in UTF-8 if it is UTF-16, of either byte order, with or without its mark; else empty.
std::string from_utf16(std::string_view text) {
    const bool is_little = text.starts_with("\xff\xfe") || (text.size() > 1 && text[0] != '\0' && text[1] == '\0');
    const bool is_big = text.starts_with("\xfe\xff") || (text.size() > 1 && text[0] == '\0' && text[1] != '\0');
    std::string converted;
    if (!is_little && !is_big) return converted;
    const auto unit = [&](std::size_t at) -> std::uint32_t {
        if (text.size() < 2 || at > text.size() - 2) return 0;
        const std::uint32_t first = static_cast<unsigned char>(text[at]);
        const std::uint32_t second = static_cast<unsigned char>(text[at + 1]);
        return is_little ? first | second << 8u : first << 8u | second;
    };
    constexpr std::uint32_t kUnknown = 0xfffd;
    for (std::size_t at = 0; at + 1 < text.size(); at += 2) {
        std::uint32_t letter = unit(at);
        if (letter == 0xfeff && at == 0) continue;  // the mark
        if (letter >= 0xd800 && letter < 0xe000) {
            const std::uint32_t low = unit(at + 2);
            const bool is_whole = letter < 0xdc00 && low >= 0xdc00 && low < 0xe000;
            letter = is_whole ? 0x10000u + ((letter - 0xd800u) << 10u) + (low - 0xdc00u) : kUnknown;
            at += is_whole ? 2 : 0;
        }
        utf8::unchecked::append(letter, std::back_inserter(converted));
    }
    return converted;
}

/// Cuts the text at a Ctrl-Z. A warning tells of text behind it.
std::string_view without_end_mark(std::string_view text, Report& report) {
    const std::size_t end = text.find(kEndOfText);
    if (end == std::string_view::npos) return text;
    const std::string_view rest = text.substr(end + 1);
    const bool is_padding = std::all_of(rest.begin(), rest.end(), [](char c) {
        return c == '\0' || c == kEndOfText || c == ' ' || (c >= '\t' && c <= '\r');
    });
    if (!is_padding) report.warn("text after Ctrl-Z, which ends a text, is left out", "byte " + std::to_string(end));
    return text.substr(0, end);
}

/// A turn about a coordinate axis.
glm::dquat turn(std::uint8_t axis, double degrees) {
    const double half = std::remainder(degrees, 720.0) * glm::pi<double>() / 360.0;
    glm::dvec3 part(0.0);
    part[axis] = std::sin(half);
    return {std::cos(half), part.x, part.y, part.z};
}

class Importer {
public:
    Importer(std::string_view text, const std::filesystem::path& file, double unit, Report& report)
        : words_(text), unit_(unit == 0.0 ? kCentimetre : unit), report_(report) {
        budget_.add_source(text.size());
        const std::u8string stem = file.stem().u8string();
        name_.assign(stem.begin(), stem.end());
    }

    Scene run() {
        read_hierarchy();
        if (!words_.is_at_end()) read_motion();
        return std::move(scene_);
    }

private:
    /// A joint's channels: the numbers that each frame has for it, in the order of the file.
    struct Moved {
        std::uint32_t joint = 0;
        std::vector<std::uint8_t> channels;  ///< X, Y, Z position: 0, 1, 2; X, Y, Z rotation: 3, 4, 5
        Track translation, rotation;
    };
    struct Placed {
        glm::dvec3 place{0.0};
        glm::dquat turn{1.0, 0.0, 0.0, 0.0};
    };
    /// A joint whose braces are open.
    struct Open {
        std::uint32_t joint = 0;
        std::string place;
        bool has_offset = false;
        bool has_channels = false;
    };

    void read_hierarchy() {
        words_.expect("hierarchy");
        for (;;) {
            const std::string_view word = words_.next();
            if (word.empty() || is(word, "motion")) {
                if (!open_.empty()) words_.fail_at(word, "'}'");
                if (scene_.joints.empty()) words_.fail_at(word, "'ROOT'");
                return;
            }
            if (is(word, open_.empty() ? "root" : "joint")) {
                add_joint(false);
            } else if (!open_.empty() && (is(word, "end") || is(word, "site") || is(word, "endsite"))) {
                add_joint(true);
            } else if (!open_.empty() && is(word, "offset")) {
                read_offset();
            } else if (!open_.empty() && is(word, "channels")) {
                read_channels();
            } else if (!open_.empty() && word == "}") {
                if (!open_.back().has_offset) fail(open_.back().place, "the joint has no OFFSET");
                open_.pop_back();
            } else {
                words_.fail_at(word, open_.empty() ? "'ROOT' or 'MOTION'" : "'OFFSET', 'CHANNELS', 'JOINT' or '}'");
            }
        }
    }

    /// Reads a joint's name, up to its brace. Names may contain spaces. An end gets its joint's name. The NULs of a
    /// name in UTF-16 go, which leaves its ASCII letters.
    void add_joint(bool is_end) {
        Open open;
        open.place = words_.place();
        open.joint = static_cast<std::uint32_t>(scene_.joints.size());
        std::string name;
        std::string_view word = words_.next();
        if (is_end && is(word, "site")) word = words_.next();
        for (; word != "{"; word = words_.next()) {
            if (word.empty()) words_.fail_at(word, "'{'");
            if (!name.empty() && words_.is_after_nul()) {
                report_.warn("a name has NULs in it, as in UTF-16: they are left out", words_.place());
            } else if (!name.empty()) {
                name += ' ';
            }
            name += word;
        }
        Joint joint;
        joint.parent = open_.empty() ? kNone : open_.back().joint;
        joint.name =
            is_end && name.empty() ? scene_.joints[joint.parent].name + " end" : to_utf8(name, open.place, report_);
        budget_.take(1, sizeof(Joint) + sizeof(Open) + joint.name.size(), open.place);
        scene_.joints.push_back(std::move(joint));
        open_.push_back(std::move(open));
    }

    void read_offset() {
        if (std::exchange(open_.back().has_offset, true)) fail(words_.place(), "the joint has two OFFSETs");
        glm::vec3& offset = scene_.joints[open_.back().joint].rest.translation;
        for (int axis = 0; axis < 3; ++axis) offset[axis] = length();
    }

    void read_channels() {
        if (std::exchange(open_.back().has_channels, true)) fail(words_.place(), "the joint has CHANNELS twice");
        const std::size_t count = words_.count(kMostChannels, "number of channels");
        Moved moved;
        moved.joint = open_.back().joint;
        for (std::size_t i = 0; i < count; ++i) {
            const std::string_view word = words_.next();
            const std::size_t kind = word.empty() ? 3 : std::string_view("xyz").find(small(word.front()));
            const bool turns = kind < 3 && is(word.substr(1), "rotation");
            if (kind >= 3 || (!turns && !is(word.substr(1), "position")))
                words_.fail_at(word, "a channel such as 'Xposition' or 'Zrotation'");
            const auto channel = static_cast<std::uint8_t>(kind + (turns ? 3 : 0));
            if (std::find(moved.channels.begin(), moved.channels.end(), channel) != moved.channels.end())
                fail(words_.place(), "the joint has the channel " + quote(word) + " twice");
            moved.channels.push_back(channel);
        }
        if (count == 0) return;
        const auto has = [&](bool turns) {
            return std::any_of(moved.channels.begin(), moved.channels.end(),
                               [&](std::uint8_t channel) { return (channel >= 3) == turns; });
        };
        moved.translation = {TrackPath::translation, Interpolation::linear, moved.joint, has(false) ? 3u : 0u, {}, {}};
        moved.rotation = {TrackPath::rotation, Interpolation::linear, moved.joint, has(true) ? 4u : 0u, {}, {}};
        budget_.take(1, sizeof(Moved) + kMostChannels, words_.place());
        moved_.push_back(std::move(moved));
    }

    void read_motion() {
        words_.split_at_colons();
        words_.expect("frames");
        const std::size_t stated = words_.count(kMostFrames, "number of frames");
        const double step = read_step(stated);
        std::size_t per_frame = 0;  // bytes
        for (const Moved& each : moved_) {
            channels_ += each.channels.size();
            for (const Track* track : {&each.translation, &each.rotation})
                per_frame += track->components == 0 ? 0 : (track->components + 1) * sizeof(float);
        }
        if (moved_.empty()) return;
        per_frame += sizeof(double);
        for (const Joint& joint : scene_.joints) frame_.push_back({joint.rest.translation, {1.0, 0.0, 0.0, 0.0}});
        const std::array at_rest{0.0, lowest(1), lowest(2)};
        are_lines_frames_ = look_ahead(stated);
        std::size_t frames = 0;
        for (; !words_.is_at_end(); ++frames) {
            if (frames == kMostFrames) fail(words_.place(), "there are too many frames");
            budget_.take(1, per_frame, words_.place());
            read_frame(static_cast<float>(static_cast<double>(frames) * step));
        }
        if (frames != stated) {
            report_.warn("the file says " + std::to_string(stated) + " frames and has " + std::to_string(frames) +
                         ", which are all read");
        }
        if (frames > 0) add_clip(frames, step);
        if (frames > 0) stand_up(at_rest[static_cast<std::size_t>(up_)]);
    }

    /// Reads the time of a frame, in seconds.
    double read_step(std::size_t frames) {
        if (const std::string_view word = words_.next(); is(word, "frame")) {
            words_.expect("time");
        } else if (!is(word, "frametime")) {
            words_.fail_at(word, "'frame time'");
        }
        const double step = words_.raw_number();
        if (frames < 2) return std::isfinite(step) ? step : 0.0;
        if (!(step > 0.0)) {
            report_.warn("the frame time is not above 0 s: 30 frames a second are assumed", words_.place());
            return kAssumedStep;
        }
        if (!(step >= 1e-6 && step <= 1e6))
            fail(words_.place(), "the time of a frame must be between 0.000001 s and 1,000,000 s");
        return step;
    }

    /// Counts lines and numbers up to the end of the motion; text behind the stated frames goes, with a warning.
    /// \return whether each line is a frame: there are as many as the file says, or the first one has room for one
    /// frame and the numbers are not those of the stated frames
    bool look_ahead(std::size_t stated) {
        std::size_t lines = 0;
        std::size_t numbers = 0;
        std::size_t in_first = 0;
        for (Words ahead = words_; !ahead.is_at_end(); ++lines) {
            const bool has_all = lines >= stated || numbers / channels_ >= stated;
            if (has_all && !ahead.is_at_number()) {
                report_.warn("text after the last frame is left out", ahead.place());
                words_.end_at(ahead);
                break;
            }
            for (; !ahead.is_at_line_end(); ++numbers) ahead.next();
            if (lines == 0) in_first = numbers;
        }
        const bool is_stated = numbers % channels_ == 0 && numbers / channels_ == stated;
        return lines == stated || (!is_stated && in_first >= channels_ && in_first / 2 < channels_);
    }

    /// Returns the smallest coordinate of a joint in the frame.
    [[nodiscard]] double lowest(glm::length_t axis) const {
        double low = std::numeric_limits<double>::infinity();
        std::vector<Placed> placed;
        for (std::size_t joint = 0; joint < frame_.size(); ++joint) {  // parents come first
            const std::uint32_t parent = scene_.joints[joint].parent;
            Placed now = frame_[joint];
            if (parent != kNone)
                now = {placed[parent].place + placed[parent].turn * now.place, placed[parent].turn * now.turn};
            low = std::min(low, now.place[axis]);
            placed.push_back(now);
        }
        return low;
    }

    /// How far the skeleton hangs below its first root in the current frame.
    double hangs(glm::length_t axis) { return frame_.front().place[axis] - lowest(axis); }

    /// A root whose OFFSET has no height, and that each frame moves, would hang in the ground at rest: its lowest joint
    /// is then on the ground of the motion, which is where the lowest joint is in most frames.
    void stand_up(double at_rest) {
        constexpr double kNoHeight = 0.05;                                                   // of what hangs below
        const auto quarter = lows_.begin() + static_cast<std::ptrdiff_t>(lows_.size() / 4);  // in jumps it is higher
        std::nth_element(lows_.begin(), quarter, lows_.end());
        for (const Moved& each : moved_) {
            Joint& joint = scene_.joints[each.joint];
            float& height = joint.rest.translation[up_];
            const bool is_moved = std::find(each.channels.begin(), each.channels.end(), up_) != each.channels.end();
            if (joint.parent == kNone && is_moved && std::abs(height) <= kNoHeight * (height - at_rest))
                height += static_cast<float>(*quarter - at_rest);
        }
    }

    void read_frame(float time) {
        in_frame_ = 0;
        for (Moved& each : moved_) {
            glm::vec3 place = scene_.joints[each.joint].rest.translation;
            glm::dquat turned(1.0, 0.0, 0.0, 0.0);
            for (const std::uint8_t channel : each.channels) {
                require_number();
                if (channel < 3) {
                    place[channel] = length();
                } else {
                    turned = turned * turn(static_cast<std::uint8_t>(channel - 3), words_.number());
                }
            }
            frame_[each.joint] = {place, turned};
            add_key(each.translation, time, to_array<3>(place));
            add_key(each.rotation, time, to_array<4>(glm::dvec4(turned.x, turned.y, turned.z, turned.w)));
        }
        if (are_lines_frames_ && !words_.is_at_line_end()) {
            report_.warn("a frame has more numbers than the joints have channels: the surplus is left out",
                         words_.place());
            while (!words_.is_at_line_end()) words_.next();
        }
        unseen_ += 4 * moved_.size();  // so that the work follows the size of the file
        if (!lows_.empty() && unseen_ < scene_.joints.size()) return;
        unseen_ = 0;
        if (lows_.empty()) up_ = hangs(2) > hangs(1) ? 2 : 1;
        lows_.push_back(lowest(up_));
    }

    /// Fails where a frame ends before its time.
    void require_number() {
        if (in_frame_ == 0) frame_place_ = words_.place();
        const bool is_short = are_lines_frames_ ? words_.is_at_line_end() : words_.is_at_end();
        if (is_short) {
            fail(frame_place_, "a frame is too short: expected " + std::to_string(channels_) +
                                   " numbers, one for each channel, found " + std::to_string(in_frame_));
        }
        ++in_frame_;
    }

    template <std::size_t N>
    static void add_key(Track& track, float time, const std::array<float, N>& value) {
        if (track.components == 0) return;
        track.times.push_back(time);
        track.values.insert(track.values.end(), value.begin(), value.end());
    }

    /// Makes the clip of the tracks. A track that stays the same needs one key.
    void add_clip(std::size_t frames, double step) {
        Clip clip;
        clip.name = name_;
        for (Moved& each : moved_) {
            for (Track* track : {&each.translation, &each.rotation}) {
                if (track->components == 0) continue;
                const auto second = track->values.begin() + track->components;
                if (std::equal(second, track->values.end(), track->values.begin())) {
                    track->times.resize(1);
                    track->values.resize(track->components);
                }
                clip.tracks.push_back(std::move(*track));
            }
        }
        const auto end = static_cast<float>(static_cast<double>(frames - 1) * step);
        if (std::none_of(clip.tracks.begin(), clip.tracks.end(),
                         [&](const Track& track) { return track.times.back() == end; }))
            clip.stated_span = ClipSpan{0.0f, end};
        scene_.clips.push_back(std::move(clip));
    }

    /// Reads a length, in metres.
    float length() {
        const double metres = words_.number() * unit_;
        if (!(std::abs(metres) <= kLargest)) fail(words_.place(), "the length is implausibly large");
        return static_cast<float>(metres);
    }

    Words words_;
    double unit_;
    Report& report_;
    std::string name_;  ///< of the file, without its suffix
    Budget budget_;
    Scene scene_;
    std::vector<Open> open_;
    std::vector<Moved> moved_;   ///< in the order of the numbers of a frame
    std::vector<Placed> frame_;  ///< by joint, relative to its parent
    std::size_t channels_ = 0;   ///< of all joints
    std::size_t in_frame_ = 0;   ///< numbers of the current frame that were read
    std::string frame_place_;    ///< of the current frame
    bool are_lines_frames_ = false;
    glm::length_t up_ = 1;      ///< the axis along which the skeleton hangs from its root in the first frame: Y or Z
    std::vector<double> lows_;  ///< of frames: the height of the lowest joint, metres
    std::size_t unseen_ = 0;    ///< joints that moved since the last of these
};

}  // namespace
}  // namespace bvh

Result<Scene, ImportError> import_bvh(std::string_view text, const std::filesystem::path& file,
                                      const BvhOptions& options, Report& report) {
    return without_throwing<Scene>([&]() -> Result<Scene, ImportError> {
        if (!(options.unit >= 0.0 && options.unit <= bvh::kLargest))
            return ImportError{{}, "a unit is longer than 0 m"};
        const std::string converted = bvh::from_utf16(text);
        if (!converted.empty()) report.warn("the file is text in UTF-16, and is read as such");
        const std::string_view plain = bvh::without_end_mark(converted.empty() ? text : converted, report);
        Scene scene = bvh::Importer(plain, file, options.unit, report).run();
        if (options.unit == 0.0) report.warn("units are taken as centimetres; --unit sets another length");
        return scene;
    });
}

}  // namespace bendy::converter
