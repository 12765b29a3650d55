#include <bendy/motion/retarget_clips.h>

#include "other_characters.h"
#include "play_on_target.h"

#include <bendy/format/curve.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>
#include <bendy/format/names.h>
#include <bendy/runtime/model.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace bendy::motion {
namespace {

using edit::Log;
using edit::Problem;
using edit::Transfer;

template <class Things>
std::vector<std::string_view> names_of(const Things& things) {
    std::vector<std::string_view> names;
    names.reserve(things.size());
    for (const auto& thing : things) names.push_back(thing.name);
    return names;
}

/// printf for one number.
std::string with(const char* format, double number) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, number);
    return text.data();
}

std::string quoted(std::string_view name, std::size_t number) {
    return name.empty() ? "#" + std::to_string(number) : in_quotes(name);
}

std::string millimetres(double metres) {
    return with(metres < 0.1 ? "%.2g mm" : "%.0f mm", metres * 1e3);
}

std::string degrees(double radians) {
    const double angle = radians * 180.0 / std::numbers::pi;
    return with(angle < 10.0 ? "%.2g degrees" : "%.0f degrees", angle);
}

/// Opens the object that the clips are of, or the first one.
Result<Model, Problem> open_model(Bytes file, bool needs_clips, const char* what) {
    if (const Faults faults = validate(file); !faults.empty())
        return Problem{std::string(what) + " cannot be opened: " + describe_with_place(faults.list().front(), file)};
    std::optional<Model> first;
    for (std::uint32_t object = 0;; ++object) {
        auto model = Model::from_memory(file, {object});
        if (!model && first) return *first;
        if (!model) return Problem{std::string(what) + " cannot be opened: " + describe(model.error())};
        if (!needs_clips || !model->clips().empty()) return *std::move(model);
        if (!first) first = *model;
    }
}

/// Says why two characters cannot be retargeted, what was found and what to write.
Problem explain(const RetargetError& error, const Model& source, const Model& target) {
    const Model& model = error.is_source ? source : target;
    std::vector<std::size_t> numbers(model.joints().size());
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = k;
    std::string text = error_text(error);
    if (error.reason != RetargetError::Reason::no_roles) return {text};
    text +=
        " (it has " + counted(numbers.size(), "joint") + ": " + list_names(names_of(model.joints()), numbers, 6) + ")";
    return {text + R"(, as in {"bendy_rig": 1, "roles": {"hips": "NAME"}})"};
}

/// In how many clips something is far from the source's motion, and where it is worst.
struct Doubt {
    std::size_t clips = 0;
    std::uint32_t joint = kNone;  ///< of the target, in the worst clip
    std::size_t clip = 0;         ///< the worst one
    double most = 0.0;
    float seconds = 0.0f;

    void add(std::uint32_t at, std::size_t in_clip, double amount, float when) {
        if (!(amount > 0.0)) return;
        ++clips;
        if (amount <= most) return;
        joint = at;
        clip = in_clip;
        most = amount;
        seconds = when;
    }
};

class ClipRetargeting {
public:
    ClipRetargeting(Retarget retarget, const RetargetClips& options, Log& log)
        : retarget_(std::move(retarget)),
          comparison_(retarget_, options.retarget),
          source_(retarget_.source()),
          target_(retarget_.target()),
          options_(options),
          log_(log) {
        lost_.resize(source_.joints().size());
        stretched_.resize(source_.joints().size());
        pair_joints();
        pair_weights();
    }

    /// Whether feet miss their places, or hips are lowered, by more than kFarMiss in any clip.
    [[nodiscard]] bool misses_far() const { return missed_.clips + lowered_.clips > 0; }
    /// The sum of that over the clips, metres.
    [[nodiscard]] double all_missed() const { return all_missed_; }
    [[nodiscard]] float scale() const { return retarget_.scale(); }
    [[nodiscard]] std::vector<RetargetedClip> take_numbers() { return std::move(numbers_); }

    Result<Transfer, Problem> run(const std::vector<std::size_t>& clips) {
        std::vector<std::size_t> useless;
        for (const std::size_t number : clips) {
            const Clip& clip = source_.clips()[number];
            if (!has_counterpart(clip)) {
                useless.push_back(number);
                continue;
            }
            auto followed = play_on_target(retarget_, comparison_, clip, options_.retarget, sampled_);
            if (!followed) return Problem{"clip " + quoted(clip.name, number) + " has numbers that are not finite"};
            put(number, *std::move(followed));
        }
        const std::string names = list_names(names_of(source_.clips()), useless);
        if (transfer_.clips.empty()) {
            const auto others = tell_other_characters(source_, "the source");
            return Problem{"its clips animate no joint that has a role or a joint of the same name here: " + names +
                           (others ? "; " + *others : "")};
        }
        if (!useless.empty()) log_.warnings.push_back("clips that animate nothing in this file are left out: " + names);
        warn();
        warn_of_doubts();
        return std::move(transfer_);
    }

private:
    void pair_joints() {
        transfer_.joints.assign(source_.joints().size(), kNone);
        has_role_.resize(source_.joints().size());
        for (const JointRole& role : source_.roles()) has_role_[role.joint] = true;
        for (std::uint32_t joint = 0; joint < retarget_.joints().size(); ++joint) {
            const std::uint32_t from = retarget_.joints()[joint];
            if (from != kNone && transfer_.joints[from] == kNone) transfer_.joints[from] = joint;
        }
    }

    /// A mesh whose targets all follow those of one mesh there, which no other mesh follows, gets its tracks as they
    /// are; others get sampled ones.
    void pair_weights() {
        transfer_.weights.resize(source_.meshes().size());
        std::vector<std::set<std::uint32_t>> meshes_of(target_.meshes().size());
        std::vector<std::size_t> followers(source_.meshes().size());
        for (std::uint32_t mesh = 0; mesh < target_.meshes().size(); ++mesh) {
            for (const std::uint32_t from : targets_of(mesh)) {
                if (from != kNone && meshes_of[mesh].insert(mesh_of(from)).second) ++followers[mesh_of(from)];
            }
        }
        for (std::uint32_t mesh = 0; mesh < target_.meshes().size(); ++mesh) {
            if (meshes_of[mesh].empty()) continue;
            const std::uint32_t there = *meshes_of[mesh].begin();
            if (meshes_of[mesh].size() > 1 || followers[there] > 1) {
                sampled_.push_back(mesh);
                continue;
            }
            std::vector<std::uint32_t> from = targets_of(mesh);
            for (std::uint32_t& target : from) target -= target == kNone ? 0 : source_.first_morph_target(there);
            transfer_.weights[there] = {mesh, std::move(from)};
        }
    }

    /// The source's morph target for each of the mesh's.
    [[nodiscard]] std::vector<std::uint32_t> targets_of(std::uint32_t mesh) const {
        const auto all = retarget_.morph_targets();
        const auto mine = all.subspan(target_.first_morph_target(mesh), target_.meshes()[mesh].targets.size());
        return {mine.begin(), mine.end()};
    }

    [[nodiscard]] std::uint32_t mesh_of(std::uint32_t source_target) const {
        std::uint32_t mesh = 0;
        while (source_.first_morph_target(mesh + 1) <= source_target) ++mesh;
        return mesh;
    }

    [[nodiscard]] bool has_counterpart(const Clip& clip) const {
        const auto counts = [&](std::uint32_t joint) { return transfer_.joints[joint] != kNone || has_role_[joint]; };
        const bool any_track = std::any_of(clip.tracks.begin(), clip.tracks.end(), [&](const TrackView& track) {
            if (track.path != TrackPath::weights) return counts(track.target);
            return transfer_.weights[track.target].mesh != kNone || follows(track.target);
        });
        if (any_track || !clip.packed) return any_track;
        for (std::uint32_t joint = 0; joint < clip.packed->record.joints; ++joint) {
            for (const TrackPath path : {TrackPath::rotation, TrackPath::translation, TrackPath::scale}) {
                if (clip.packed->animates(joint, path) && counts(joint)) return true;
            }
        }
        return false;
    }

    /// True if a sampled mesh here has a target of this mesh there.
    [[nodiscard]] bool follows(std::uint32_t mesh) const {
        const std::uint32_t first = source_.first_morph_target(mesh);
        const auto all = retarget_.morph_targets();
        return std::any_of(all.begin(), all.end(), [&](std::uint32_t from) {
            return from != kNone && from >= first && from - first < source_.meshes()[mesh].targets.size();
        });
    }

    void put(std::size_t number, Followed followed) {
        for (std::size_t joint = 0; joint < lost_.size(); ++joint) {
            const bool is_here = transfer_.joints[joint] != kNone;
            lost_[joint] = lost_[joint] || (followed.moves[joint] && !is_here && !is_column(joint));
            stretched_[joint] = stretched_[joint] || followed.stretches[joint];
        }
        collect_doubts(number, followed);
        Transfer::Clip& clip = transfer_.clips.emplace_back();
        clip.number = number;
        clip.report = report(followed);
        numbers_.push_back(numbers_of(number, followed));
        clip.kept = std::move(followed.kept);
        clip.tracks = std::move(followed.tracks);
        for (const ContactCurve& contact : followed.contacts) {
            const std::string path = std::string("/extras/") + kContactNames[contact.contact];  // as spec/rig.md has it
            CurveView curve;
            curve.name = kContactNames[contact.contact];
            curve.path = path;
            curve.keys = static_cast<std::uint32_t>(contact.times.size());
            curve.times = contact.times;
            curve.values = contact.values;
            clip.curves.push_back(write_curve(curve));
        }
    }

    /// Columns of other numbers of joints share the turns of spine, neck, tail and wings: none of theirs is lost.
    [[nodiscard]] bool is_column(std::size_t joint) const {
        return std::any_of(source_.roles().begin(), source_.roles().end(), [&](const JointRole& one) {
            const auto role = static_cast<Role>(one.role);
            const bool is_leg = role >= Role::left_front_leg && role <= Role::right_hind_leg;
            return one.joint == joint &&
                   ((role > Role::hips && role < Role::head) || (role >= kFirstChainRole && !is_leg));
        });
    }

    [[nodiscard]] std::string name_of(std::uint32_t joint) const { return quoted(target_.joints()[joint].name, joint); }

    [[nodiscard]] RetargetedClip numbers_of(std::size_t number, const Followed& followed) const {
        const auto at = [&](std::uint32_t joint, float seconds, double amount) {
            return joint == kNone ? Worst() : Worst{std::string(target_.joints()[joint].name), seconds, amount};
        };
        const FarthestOff& off = followed.farthest_off;
        RetargetedClip clip{std::string(source_.clips()[number].name), followed.frames, followed.limited};
        clip.mean_off = followed.mean_off;
        clip.off = at(off.joint, off.seconds, off.angle);
        clip.missed = at(followed.missed_joint, followed.missed_at, followed.missed);
        clip.lowered = followed.lowered;
        clip.mean_error = followed.mean_error;
        clip.error = followed.error;
        for (const JointPop& pop : followed.pops)
            clip.pops.push_back({at(pop.joint, pop.seconds, pop.turn), pop.of_source});
        return clip;
    }

    /// What had to give way.
    [[nodiscard]] std::string report(const Followed& followed) const {
        const auto kept = static_cast<std::size_t>(std::count(followed.kept.begin(), followed.kept.end(), true));
        std::string text;
        if (!followed.tracks.empty()) {
            text = counted(followed.tracks.size(), "track") + ", off by " + millimetres(followed.mean_error) +
                   " on average, " + millimetres(followed.error) + with(" at %.3g s", followed.error_at);
        }
        if (kept != 0) text += (text.empty() ? "" : ", ") + counted(kept, "joint") + " as in the source";
        if (followed.has_contacts) text += ", feet by its contact curves";
        if (followed.farthest_off.joint != kNone) {
            text += std::string(text.empty() ? "" : "; ") + "bones point " + degrees(followed.mean_off) +
                    " off the source's on average, " + degrees(followed.farthest_off.angle) + " at " +
                    name_of(followed.farthest_off.joint) + with(" at %.3g s", followed.farthest_off.seconds);
        }
        if (followed.limited == 0 && options_.retarget.limits != Limits::off) text += "; no limit acted";
        if (followed.limited != 0) text += limits_text(followed);
        if (followed.missed > 1e-4) {
            text += "; " + name_of(followed.missed_joint) + " misses its place by " + millimetres(followed.missed) +
                    " at " + with("%.3g s", followed.missed_at);
        }
        if (followed.lowered > 1e-4) text += "; the hips are lowered by up to " + millimetres(followed.lowered);
        return text;
    }

    [[nodiscard]] std::string limits_text(const Followed& followed) const {
        std::vector<std::pair<std::uint32_t, Held>> worst(followed.held.begin(), followed.held.end());
        std::stable_sort(worst.begin(), worst.end(),
                         [](const auto& a, const auto& b) { return a.second.angle > b.second.angle; });
        constexpr std::size_t kShown = 3;
        if (worst.size() > kShown) worst.resize(kShown);
        std::string text = "; limits acted in " + std::to_string(followed.limited) + " of " +
                           counted(followed.frames, "frame") + ", most at";
        for (std::size_t k = 0; k < worst.size(); ++k) {
            const auto& [joint, held] = worst[k];
            const Constraint* limit = target_.constraint(joint);
            const std::string kind =
                limit == nullptr
                    ? ""
                    : std::string(kShownNames<ConstraintModel>[static_cast<std::size_t>(limit->record.model)]) + ", ";
            text += (k == 0 ? " " : ", ") + name_of(joint) + " (" + kind + degrees(held.angle) +
                    with(" at %.3g s)", held.seconds);
        }
        return text;
    }

    /// Counts the clip for each way in which it is visibly unlike the source's.
    void collect_doubts(std::size_t clip, const Followed& followed) {
        for (std::size_t cause = 0; cause < kCauses; ++cause) {
            const FarthestOff& off = followed.far_off[cause];
            doubts_[cause].add(off.joint, clip, off.angle, off.seconds);
        }
        all_missed_ += double{followed.missed} + double{followed.lowered};
        const double far = kFarMiss * double{retarget_.leg()};
        if (followed.missed > far) missed_.add(followed.missed_joint, clip, followed.missed, followed.missed_at);
        if (followed.lowered > far) lowered_.add(kNone, clip, followed.lowered, 0.0f);
        const auto most = std::max_element(followed.pops.begin(), followed.pops.end(),
                                           [](const JointPop& a, const JointPop& b) { return a.turn < b.turn; });
        if (most == followed.pops.end()) return;
        if (most->turn > popped_.most) most_of_source_ = most->of_source;
        popped_.add(most->joint, clip, most->turn, most->seconds);
    }

    void warn_of_doubts() {
        const std::string most = " far from the source's directions in ";
        tell(doubts_[static_cast<std::size_t>(Cause::rests)], "bones point" + most, degrees,
             "one of the bodies does not stand in its rest pose, or is built differently: --stand says how it stands, "
             "--rests-alike takes turns from rest");
        tell(doubts_[static_cast<std::size_t>(Cause::limits)], "limits turn bones" + most, degrees,
             "--limits off goes beyond them");
        tell(doubts_[static_cast<std::size_t>(Cause::ground)], "feet on the ground turn legs" + most, degrees,
             "--free-feet lets them go");
        const double leg = retarget_.leg();
        const auto of_leg = [leg](double metres) {
            return millimetres(metres) + with(", %.0f %% of the leg,", 100.0 * metres / leg);
        };
        tell(missed_, "feet or hands miss their places in ", of_leg, "try --limits off or --free-feet");
        tell(
            popped_, "joints turn in jumps in ",
            [this](double turn) { return degrees(turn) + " (the source: " + degrees(most_of_source_) + " at most)"; },
            options_.retarget.limits == Limits::off ? "--free-feet lets the legs go"
                                                    : "try --limits soft, --limits off or --free-feet");
        tell(lowered_, "the hips are lowered, so that feet reach the ground, in ", of_leg, "--free-feet leaves them");
    }

    template <class Amount>
    void tell(const Doubt& doubt, const std::string& what, const Amount& amount, const std::string& remedy) {
        if (doubt.clips == 0) return;
        std::string text = what + counted(doubt.clips, "clip") + ", most";
        if (doubt.joint != kNone) text += ' ' + name_of(doubt.joint);
        text += " by " + amount(doubt.most) + " in " + quoted(source_.clips()[doubt.clip].name, doubt.clip);
        if (doubt.joint != kNone) text += with(" at %.3g s", doubt.seconds);
        log_.warnings.push_back(text + "; " + remedy);
    }

    static std::vector<std::size_t> numbers_in(const std::vector<bool>& set) {
        std::vector<std::size_t> numbers;
        for (std::size_t k = 0; k < set.size(); ++k) {
            if (set[k]) numbers.push_back(k);
        }
        return numbers;
    }

    void warn() {
        const auto names = names_of(source_.joints());
        if (const auto lost = numbers_in(lost_); !lost.empty()) {
            log_.warnings.push_back("nothing here follows " + counted(lost.size(), "joint") + ": " +
                                    list_names(names, lost));
        }
        if (const auto still = missing_there(); !still.empty()) {
            log_.warnings.push_back("the source has no counterpart of " + counted(still.size(), "joint") +
                                    " here, left at rest: " + list_names(names_of(target_.joints()), still));
        }
        if (const auto stretched = numbers_in(stretched_); !stretched.empty()) {
            log_.warnings.push_back("limbs keep their lengths; the clips move or scale " +
                                    counted(stretched.size(), "joint") + " against " +
                                    (stretched.size() == 1 ? "its parent: " : "their parents: ") +
                                    list_names(names, stretched));
        }
        std::set<std::uint32_t> found(retarget_.morph_targets().begin(), retarget_.morph_targets().end());
        std::vector<std::string_view> lost;
        for (std::uint32_t mesh = 0; mesh < source_.meshes().size(); ++mesh) {
            if (!animates(mesh)) continue;
            const auto& targets = source_.meshes()[mesh].targets;
            for (std::uint32_t k = 0; k < targets.size(); ++k) {
                if (!found.contains(source_.first_morph_target(mesh) + k)) lost.push_back(targets[k].name);
            }
        }
        if (lost.empty()) return;
        std::vector<std::size_t> all(lost.size());
        for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
        log_.warnings.push_back("there are no morph targets here for the weights of " + list_names(lost, all));
    }

    /// Joints of the target's hips, head and limbs that nothing moves.
    [[nodiscard]] std::vector<std::size_t> missing_there() const {
        constexpr std::array kParts{Role::hips,
                                    Role::head,
                                    Role::left_upper_leg,
                                    Role::left_lower_leg,
                                    Role::left_foot,
                                    Role::right_upper_leg,
                                    Role::right_lower_leg,
                                    Role::right_foot,
                                    Role::left_upper_arm,
                                    Role::left_lower_arm,
                                    Role::left_hand,
                                    Role::right_upper_arm,
                                    Role::right_lower_arm,
                                    Role::right_hand};
        std::vector<std::size_t> still;
        for (const JointRole& role : target_.roles()) {
            const bool counts = std::find(kParts.begin(), kParts.end(), static_cast<Role>(role.role)) != kParts.end();
            if (counts && retarget_.joints()[role.joint] == kNone) still.push_back(role.joint);
        }
        return still;
    }

    [[nodiscard]] bool animates(std::uint32_t mesh) const {
        return std::any_of(transfer_.clips.begin(), transfer_.clips.end(), [&](const Transfer::Clip& one) {
            const auto& tracks = source_.clips()[one.number].tracks;
            return std::any_of(tracks.begin(), tracks.end(), [&](const TrackView& track) {
                return track.path == TrackPath::weights && track.target == mesh;
            });
        });
    }

    Retarget retarget_;
    BoneComparison comparison_;
    Model source_, target_;
    const RetargetClips& options_;
    Log& log_;
    Transfer transfer_;
    std::vector<std::uint32_t> sampled_;  // meshes of the target
    std::vector<bool> has_role_, lost_, stretched_;
    std::array<Doubt, kCauses> doubts_;
    Doubt missed_, lowered_, popped_;
    double most_of_source_ = 0.0;  // where a joint pops most: what the source turns
    std::vector<RetargetedClip> numbers_;
    double all_missed_ = 0.0;
};

bool has_four_legs(const Model& model) {
    return std::any_of(model.roles().begin(), model.roles().end(),
                       [](const JointRole& one) { return static_cast<Role>(one.role) == Role::left_front_leg; });
}

/// The clips, by the rest poses that options name or, if they leave the choice, by those that bring feet nearer.
Result<Transfer, Problem> transfer_clips(Retarget retarget, const std::vector<std::size_t>& clips,
                                         const RetargetClips& options, Log& log, std::vector<RetargetedClip>* numbers) {
    const Model source = retarget.source(), target = retarget.target();
    const auto take = [&](ClipRetargeting& one, const Log& said) {
        log.done.insert(log.done.end(), said.done.begin(), said.done.end());
        log.warnings.insert(log.warnings.end(), said.warnings.begin(), said.warnings.end());
        log.done.push_back("legs are " + with("%.3g", one.scale()) + " times as long as the source's");
        if (numbers != nullptr) *numbers = one.take_numbers();
    };
    Log of_first;
    ClipRetargeting first(std::move(retarget), options, of_first);
    auto transfer = first.run(clips);
    if (transfer && options.chooses_rests && first.misses_far() && has_four_legs(target)) {
        RetargetClips alike = options;
        alike.retarget.rest_poses = RestPoses::alike;
        auto other = Retarget::make(source, target, alike.retarget);
        if (other) {
            Log of_second;
            ClipRetargeting second(*std::move(other), alike, of_second);
            auto better = second.run(clips);
            if (better && second.all_missed() < kBetter * first.all_missed()) {
                take(second, of_second);
                log.done.push_back("joints turn as from rest (--rests-alike): feet miss and hips sink by " +
                                   millimetres(second.all_missed()) + " in sum over the clips, not by " +
                                   millimetres(first.all_missed()) + " as with --rests-measured");
                return better;
            }
        }
    }
    if (transfer) take(first, of_first);
    return transfer;
}

}  // namespace

std::optional<Limits> parse_limits(std::string_view word) {
    const auto found = std::find(kLimitsWords.begin(), kLimitsWords.end(), word);
    if (found == kLimitsWords.end()) return std::nullopt;
    return static_cast<Limits>(found - kLimitsWords.begin());
}

edit::Edited retarget_clips(Bytes file, Bytes other, const RetargetClips& options, Log& log,
                            std::vector<RetargetedClip>* numbers) {
    const auto source = open_model(other, true, "the source");
    if (!source) return source.error();
    if (source->clips().empty()) return Problem{"the source has no clips"};
    const auto target = open_model(file, false, "the target");
    if (!target) return target.error();
    auto retarget = Retarget::make(*source, *target, options.retarget);
    if (!retarget) return explain(retarget.error(), *source, *target);
    std::vector<std::size_t> clips(source->clips().size());
    for (std::size_t k = 0; k < clips.size(); ++k) clips[k] = k;
    if (!options.clip.empty()) {
        auto named = edit::find_named(names_of(source->clips()), options.clip, "clip");
        if (!named) return named.error();
        clips = *std::move(named);
    }
    for (const auto& [model, what] : {std::pair(&*source, "the source"), std::pair(&*target, "the target")}) {
        if (auto others = tell_other_characters(*model, what)) log.warnings.push_back(*std::move(others));
    }
    const auto transfer = transfer_clips(*std::move(retarget), clips, options, log, numbers);
    if (!transfer) return transfer.error();
    return edit::put_clips(file, other, *transfer, options.same_name, log);
}

}  // namespace bendy::motion
