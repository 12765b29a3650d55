#include <bendy/edit/clips.h>

#include "clip_keys.h"
#include "keep_only.h"
#include "mirror_clip.h"
#include "move_root.h"
#include "sides.h"

#include <bendy/format/charconv.h>
#include <bendy/format/names.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace bendy::edit {
namespace {

constexpr std::array kClipWords{
    ClipWord{ClipWork::keep, "keep-clip", "CLIP", "take out all other clips"},
    ClipWord{ClipWork::copy, "copy-clip", "OLD=NEW", "a second clip with the same content, to change one of the two"},
    ClipWord{
        ClipWork::trim, "trim", "CLIP=A..B",
        "keep this part, in seconds on the clip's time line; it then begins at 0. Without A or B, from the start or "
        "to the end"},
    ClipWord{ClipWork::resample, "resample", "CLIP@RATE",
             "RATE linear keys per second, instead of those that there are"},
    ClipWord{ClipWork::mirror, "mirror", "CLIP",
             "left does what right did. Joints are paired by their roles or by names such as arm.L and arm.R"},
    ClipWord{ClipWork::loop, "loop", "CLIP=SECONDS",
             "repeat the clip; during the last SECONDS it drifts to the pose of its start"},
    ClipWord{ClipWork::root_motion, "root-motion", "CLIP=FROM..TO",
             "the movement over the ground (x and z) goes from joint FROM to joint TO above it. Without TO it is taken "
             "out; without FROM, the highest joint that moves, down to the hips"},
    ClipWord{
        ClipWork::on_the_spot, "on-the-spot", "CLIP[@SECONDS]",
        "take out the way over the ground, averaged over SECONDS or, without them, over one cycle of the clip; what "
        "sways and pulses about that way stays"}};

constexpr std::string_view kDots = "..";
constexpr double kLowestRate = 1e-3;
constexpr double kHighestRate = 1e4;
constexpr double kMostKeys = 1e6;
constexpr double kTypingError = 5e-4;  // seconds: times are typed with few digits
constexpr double kFrameError = 1e-3;   // frames, as in the rules of PLAY

std::string text_of(double number) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.6g", number);
    return text.data();
}

std::optional<double> read_number(std::string_view text) {
    double number = 0.0;
    const char* const end = text.data() + text.size();
    const auto [stop, problem] = from_chars(text.data(), end, number);
    if (problem != std::errc() || stop != end || !std::isfinite(number)) return std::nullopt;
    return number;
}

/// The clip and what is said of it, which never contains the sign; the clip's name may.
std::optional<std::pair<std::string, std::string_view>> split_change(std::string_view text, char sign) {
    const std::size_t at = text.rfind(sign);
    if (at == std::string_view::npos || at == 0) return std::nullopt;
    return std::pair(std::string(text.substr(0, at)), text.substr(at + 1));
}

/// Reads A..B, each of which may be missing.
bool read_range(std::string_view text, ClipChange& change) {
    const std::size_t dots = text.find(kDots);
    if (dots == std::string_view::npos) return false;
    const auto read = [](std::string_view part, double& number) {
        if (part.empty()) return true;
        const auto found = read_number(part);
        number = found.value_or(number);
        return found.has_value();
    };
    return read(text.substr(0, dots), change.from) && read(text.substr(dots + kDots.size()), change.to);
}

/// Reads CLIP or CLIP@SECONDS, with seconds above 0. If what follows the last @ is not a number, it is part of the
/// name.
bool read_on_the_spot(std::string_view text, ClipChange& change) {
    const auto parts = split_change(text, '@');
    const auto seconds = parts ? read_number(parts->second) : std::nullopt;
    change.clips = {seconds ? parts->first : std::string(text)};
    change.window = seconds.value_or(0.0);
    return !text.empty() && (!seconds || *seconds > 0.0);
}

/// Fills in what follows the word; false if it has another shape.
bool read_text(std::string_view text, ClipChange& change) {
    if (change.work == ClipWork::keep || change.work == ClipWork::mirror) {
        change.clips = {std::string(text)};
        return !text.empty();
    }
    if (change.work == ClipWork::copy) {
        const auto pair = parse_pair(text);
        if (!pair) return false;
        change.clips = {pair->first};
        change.name = pair->second;
        return !change.name.empty();
    }
    if (change.work == ClipWork::on_the_spot) return read_on_the_spot(text, change);
    auto parts = split_change(text, change.work == ClipWork::resample ? '@' : '=');
    if (!parts) return false;
    auto& [clip, said] = *parts;
    change.clips = {std::move(clip)};
    const std::size_t dots = said.find(kDots);
    switch (change.work) {
        case ClipWork::trim:
            return read_range(said, change);
        case ClipWork::root_motion:
            if (dots == std::string_view::npos) return false;
            change.from_joint = said.substr(0, dots);
            change.to_joint = said.substr(dots + kDots.size());
            return true;
        default:
            const auto number = read_number(said);
            (change.work == ClipWork::loop ? change.blend : change.rate) = number.value_or(0.0);
            return number.has_value();
    }
}

/// What is wrong with the numbers of a change, whatever the clip is.
std::optional<Problem> check_numbers(const ClipChange& change) {
    if (change.work == ClipWork::trim && !(change.from <= change.to)) {
        return Problem{"a part from " + text_of(change.from) + " to " + text_of(change.to) +
                       " s ends before it begins"};
    }
    if (change.work == ClipWork::resample && !(change.rate >= kLowestRate && change.rate <= kHighestRate)) {
        return Problem{text_of(change.rate) + " keys per second: the rate must be from " + text_of(kLowestRate) +
                       " to " + text_of(kHighestRate)};
    }
    if (change.work == ClipWork::on_the_spot && !(change.window >= 0.0 && std::isfinite(change.window)))
        return Problem{text_of(change.window) + " s: a way is averaged over a time above 0"};
    if (change.work == ClipWork::loop && !(change.blend > 0.0 && std::isfinite(change.blend)))
        return Problem{text_of(change.blend) + " s: the end must drift for a time above 0"};
    return std::nullopt;
}

/// Frames of PLAY within the part; a problem if it does not begin and end with frames.
Result<void, Problem> trim_plays(ClipKeys& clip, float from, float to) {
    const double rate = clip.view->frame_rate;
    const double first = (double{from} - clip.start) * rate;
    const double last = (double{to} - clip.start) * rate;
    for (PlayRecord& play : clip.plays) {
        const double end = play.closed != 0 ? play.frames : play.frames - 1.0;
        const double begin_frame = std::min(std::round(first), end);
        const double end_frame = std::min(std::round(last), end);
        const bool is_whole = begin_frame == 0.0 && end_frame == end;
        if (is_whole) continue;
        const bool has_frames =
            std::abs(first - std::round(first)) <= kFrameError && std::abs(last - std::round(last)) <= kFrameError;
        if (!has_frames || (play.closed != 0 && end_frame == end)) {
            const double latest = clip.start + (play.frames - 1.0) / rate;
            return Problem{"it plays " + std::to_string(play.frames) + " stored frames, " + text_of(rate) +
                           " per second; a part of it must begin and end with a frame, the last at " + text_of(latest) +
                           " s"};
        }
        play.first += static_cast<std::uint32_t>(begin_frame);
        play.frames = static_cast<std::uint32_t>(end_frame - begin_frame) + 1;
        play.closed = 0;
    }
    return {};
}

/// Where the drift was largest, for the report.
struct Largest {
    double amount = 0.0;
    std::uint32_t joint = kNone;

    void add(double more, std::uint32_t of) {
        if (more <= amount) return;
        amount = more;
        joint = of;
    }
};

class ClipChanger {
public:
    ClipChanger(const Source& source, const ClipChange& what, Log& log)
        : source_(source), what_(what), log_(log), rewrite_(source.tree) {
        for (std::size_t o = 0; o < source.document.objects.size(); ++o) {
            for (std::size_t k = 0; k < source.document.objects[o].clips.size(); ++k) {
                places_.emplace_back(o, k);
                names_.push_back(source.document.objects[o].clips[k].name);
            }
        }
    }

    Edited change() {
        if (names_.empty()) return Problem{"the file has no clips"};
        std::set<std::size_t> chosen;
        for (const std::string& wanted : what_.clips) {
            const auto found = find_named(names_, wanted, "clip");
            if (!found) return found.error();
            chosen.insert(found->begin(), found->end());
        }
        if (what_.work == ClipWork::keep) return keep(chosen);
        for (const std::size_t number : chosen) {
            const auto done = what_.work == ClipWork::copy ? copy(number) : change_one(number);
            if (!done) return Problem{"clip " + in_quotes(names_[number]) + ": " + done.error().message};
        }
        if (unchanged_.size() == chosen.size()) return Problem{unchanged_.front()};
        log_.warnings.insert(log_.warnings.end(), unchanged_.begin(), unchanged_.end());
        return finish(rewrite_);
    }

private:
    [[nodiscard]] const ObjectView& object_of(std::size_t number) const {
        return source_.document.objects[places_[number].first];
    }
    [[nodiscard]] const ClipView& clip_of(std::size_t number) const {
        return object_of(number).clips[places_[number].second];
    }

    Edited keep(const std::set<std::size_t>& chosen) {
        Kept kept = everything(source_.document);
        std::vector<std::size_t> gone;
        for (std::size_t number = 0; number < names_.size(); ++number) {
            if (chosen.contains(number)) continue;
            kept.objects[places_[number].first].clips[places_[number].second] = false;
            gone.push_back(number);
        }
        log_.done.push_back(gone.empty()
                                ? "all clips are kept"
                                : "stripped " + counted(gone.size(), "clip") + ": " + list_names(names_, gone));
        if (const auto updated = keep_only(source_, kept, rewrite_, log_); !updated) return updated.error();
        return finish(rewrite_);
    }

    Result<void, Problem> copy(std::size_t number) {
        const ClipView& clip = clip_of(number);
        const auto name = renamed({what_.clips.front(), what_.name}, clip.name).value_or(what_.name);
        if (taken_.empty()) taken_.insert(names_.begin(), names_.end());
        if (!taken_.insert(name).second) return Problem{"there is a clip " + in_quotes(name) + " already"};
        Rewrite sending(source_.tree);
        const std::uint32_t chunk = source_.tree.find(clip.chunk, FourCC("NAME"));
        if (chunk != kNone) {
            sending.replace(chunk, as_byte_span(name));
        } else {
            sending.prepend(clip.chunk, whole_leaf(FourCC("NAME"), as_byte_span(name)));
        }
        rewrite_.insert_after(clip.chunk, sending.write(clip.chunk));
        log_.done.push_back("copied clip " + in_quotes(clip.name) + " as " + in_quotes(name));
        return {};
    }

    Result<void, Problem> change_one(std::size_t number) {
        auto keys = read_keys(source_.tree, object_of(number), clip_of(number));
        if (!keys) return keys.error();
        if (const auto done = work_on(*keys, places_[number].first); !done) return done.error();
        if (const auto written = write_keys(source_.tree, *keys, rewrite_); !written) return written.error();
        if (keys->decoded != 0) {
            log_.warnings.push_back("clip " + in_quotes(names_[number]) + ": " + std::to_string(keys->decoded) +
                                    " packed tracks are ordinary keys now; `bendy convert --compact` packs them again");
        }
        return {};
    }

    Result<void, Problem> work_on(ClipKeys& clip, std::size_t object) {
        switch (what_.work) {
            case ClipWork::trim:
                return trim(clip);
            case ClipWork::resample:
                return take_samples(clip);
            case ClipWork::mirror:
                return mirror(clip, object);
            case ClipWork::loop:
                return loop(clip);
            case ClipWork::on_the_spot:
                return keep_on_the_spot(clip, what_.window, log_);
            default:
                return move_root(clip, what_.from_joint, what_.to_joint, log_);
        }
    }

    Result<void, Problem> trim(ClipKeys& clip) {
        const auto at = [&](double seconds) {  // where it was meant to be
            const double inside = std::clamp(seconds, double{clip.start}, double{clip.end});
            const bool is_open = !std::isfinite(seconds);
            return is_open || std::abs(inside - seconds) <= kTypingError ? static_cast<float>(inside) : NAN;
        };
        const float from = at(what_.from);
        const float to = at(what_.to);
        if (std::isnan(from) || std::isnan(to)) {
            return Problem{"it lasts from " + text_of(clip.start) + " to " + text_of(clip.end) + " s, and " +
                           text_of(std::isnan(from) ? what_.from : what_.to) + " s is outside"};
        }
        if (!(from <= to)) return Problem{"its part would end before it begins"};
        const bool is_part = from > clip.start || to < clip.end;
        if (const auto trimmed = trim_plays(clip, from, to); !trimmed) return trimmed.error();
        bool is_good = true;
        clip.change_keys([&](KeyTrack& track) { is_good = cut(track, from, to) && is_good; });
        if (!is_good) return Problem{"keys would have the same time, because the clip is far from the time 0"};
        std::vector<std::string_view> lost;
        std::vector<ClipMarker> markers;
        for (const ClipMarker& marker : clip.markers) {
            if (marker.seconds < from || marker.seconds > to) {
                lost.emplace_back(marker.name);
            } else {
                markers.push_back({static_cast<float>(double{marker.seconds} - from), marker.name});
            }
        }
        if (!lost.empty()) {
            std::vector<std::size_t> all;
            for (std::size_t k = 0; k < lost.size(); ++k) all.push_back(k);
            log_.warnings.push_back("clip " + in_quotes(clip.view->name) +
                                    ": markers outside the part are left out: " + list_names(lost, all));
        }
        clip.markers = std::move(markers);
        clip.start = 0.0f;
        clip.end = static_cast<float>(double{to} - from);
        if (is_part && clip.loop) {
            log_.warnings.push_back("clip " + in_quotes(clip.view->name) +
                                    " still repeats, from the end of the part to its start; --loop makes them equal");
        }
        log_.done.push_back("trimmed clip " + in_quotes(clip.view->name) + " to " + text_of(from) + ".." + text_of(to) +
                            " s");
        return {};
    }

    Result<void, Problem> take_samples(ClipKeys& clip) {
        const double frames = (double{clip.end} - clip.start) * what_.rate;
        if (!(frames < kMostKeys)) {
            return Problem{"it would have " + text_of(frames) + " keys, and more than " + text_of(kMostKeys) +
                           " are too many"};
        }
        std::vector<float> times;
        for (std::uint32_t k = 0; k <= frames; ++k) {
            const auto time = static_cast<float>(clip.start + k / what_.rate);
            if (time < clip.end && (times.empty() || time > times.back())) times.push_back(time);
        }
        // The last frame is the end if it would be next to it by rounding.
        const double gap = times.empty() ? 0.0 : (double{clip.end} - times.back()) * what_.rate;
        if (times.size() > 1 && gap < kFrameError) times.pop_back();
        times.push_back(clip.end);
        std::uint64_t before = 0;
        std::uint64_t after = 0;
        std::uint64_t numbers = 0;
        for (const ClipTrack& track : clip.tracks) numbers += track.components * times.size();
        if (numbers > (1u << 28u))
            return Problem{"it would have " + text_of(static_cast<double>(numbers)) + " numbers"};
        bool is_changed = false;
        clip.change_keys([&](KeyTrack& track) {
            before += track.times.size();
            is_changed = resample(track, times) || is_changed;
            after += track.times.size();
        });
        if (!is_changed) {
            unchanged_.push_back("clip " + in_quotes(clip.view->name) + " cannot be resampled: " +
                                 (before != 0          ? "its tracks step, or have one key each"
                                  : clip.plays.empty() ? "it has no keys"
                                                       : "it plays stored frames, which have a rate of their own"));
            return {};
        }
        if (!clip.plays.empty()) {
            log_.warnings.push_back("clip " + in_quotes(clip.view->name) +
                                    ": its stored frames keep their rate; only its keys are resampled");
        }
        log_.done.push_back("resampled clip " + in_quotes(clip.view->name) + " to " + text_of(what_.rate) +
                            " keys per second: " + std::to_string(after) + " keys instead of " +
                            std::to_string(before));
        return {};
    }

    Result<void, Problem> mirror(ClipKeys& clip, std::size_t object) {
        auto known = mirrors_.find(object);
        if (known == mirrors_.end()) {
            auto mirror = Mirror::of(source_.document, *clip.object);
            if (!mirror) return mirror.error();
            known = mirrors_.try_emplace(object, *std::move(mirror)).first;
        }
        if (const auto done = known->second.change(clip, log_); !done) return done.error();
        for (const FourCC id : {FourCC("EXTR"), FourCC("MORE")}) {
            const std::uint32_t chunk = source_.tree.find(clip.view->chunk, id);
            if (chunk == kNone ||
                other_side(as_text(source_.tree.payload(chunk))) == as_text(source_.tree.payload(chunk)))
                continue;
            log_.warnings.push_back("clip " + in_quotes(clip.view->name) + ": " + id.letters().data() +
                                    " tells left or right, and stays as it is");
        }
        log_.done.push_back("mirrored clip " + in_quotes(clip.view->name));
        return {};
    }

    Result<void, Problem> loop(ClipKeys& clip) {
        const double length = double{clip.end} - clip.start;
        if (what_.blend > length + kTypingError)
            return Problem{"it lasts " + text_of(length) + " s, which is less than " + text_of(what_.blend) + " s"};
        for (const PlayRecord& play : clip.plays) {
            if (play.closed == 0) return Problem{"it plays stored frames, which cannot drift to those of the start"};
        }
        const auto from = static_cast<float>(std::max<double>(clip.end - what_.blend, clip.start));
        if (!(from < clip.end)) return Problem{"its last " + text_of(what_.blend) + " s are too short for its times"};
        Largest moved;
        Largest turned;
        for (const ClipTrack& track : clip.tracks) find_gap(track, clip, moved, turned);
        clip.change_keys([&](KeyTrack& track) { close_loop(track, clip.start, from, clip.end); });
        clip.loop = true;
        const auto names = names_of(clip.object->skeleton.joints);
        std::string text = "clip " + in_quotes(clip.view->name) + " repeats";
        if (moved.joint != kNone) {
            text += "; the end of joint " + in_quotes(names[moved.joint]) + " is moved by " +
                    text_of(moved.amount * 1e3) + " mm, the most";
        }
        if (turned.joint != kNone) {
            text += "; that of " + in_quotes(names[turned.joint]) + " is turned by " + text_of(turned.amount) +
                    " degrees, the most";
        }
        log_.done.push_back(text);
        return {};
    }

    static void find_gap(const ClipTrack& track, const ClipKeys& clip, Largest& moved, Largest& turned) {
        if (track.path != TrackPath::translation && track.path != TrackPath::rotation) return;
        std::array<double, 4> first{};
        std::array<double, 4> last{};
        sample(track, clip.start, std::span(first).first(track.components));
        sample(track, clip.end, std::span(last).first(track.components));
        double square = 0.0;
        double dot = 0.0;
        for (std::size_t c = 0; c < 4; ++c) dot += first.at(c) * last.at(c);
        const double sign = track.is_rotation && dot < 0.0 ? -1.0 : 1.0;
        for (std::size_t c = 0; c < 4; ++c)
            square += (first.at(c) - sign * last.at(c)) * (first.at(c) - sign * last.at(c));
        const double gap = std::sqrt(square);
        constexpr double kDegrees = 180.0 / 3.14159265358979323846;
        if (track.path == TrackPath::translation) moved.add(gap, track.target);
        if (track.is_rotation) turned.add(4.0 * std::asin(std::min(1.0, gap / 2.0)) * kDegrees, track.target);
    }

    const Source& source_;
    const ClipChange& what_;
    Log& log_;
    Rewrite rewrite_;
    std::vector<std::pair<std::size_t, std::size_t>> places_;  // object and clip
    std::vector<std::string_view> names_;
    std::set<std::string, std::less<>> taken_;
    std::map<std::size_t, Mirror> mirrors_;  // by object
    std::vector<std::string> unchanged_;     // why, for each clip that stays as it is
};

}  // namespace

std::span<const ClipWord> clip_words() {
    return kClipWords;
}

Result<ClipChange, Problem> parse_clip_change(std::string_view word, std::span<const std::string> texts) {
    const auto* const found =
        std::find_if(kClipWords.begin(), kClipWords.end(), [&](const ClipWord& known) { return known.word == word; });
    if (found == kClipWords.end()) return Problem{in_quotes(word) + " is not a change of clips"};
    ClipChange change;
    change.work = found->work;
    std::vector<std::string> clips;
    for (const std::string& text : texts) {
        if (!read_text(text, change)) return Problem{in_quotes(text) + " is not " + std::string(found->shape)};
        clips.insert(clips.end(), change.clips.begin(), change.clips.end());
    }
    change.clips = std::move(clips);
    if (const auto wrong = check_numbers(change)) return *wrong;
    return change;
}

Edited change_clips(Bytes file, const ClipChange& what, Log& log) {
    if (const auto wrong = check_numbers(what)) return *wrong;
    const auto source = open_source(file);
    if (!source) return source.error();
    return ClipChanger(*source, what, log).change();
}

}  // namespace bendy::edit
