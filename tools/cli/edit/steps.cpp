#include "edit/edit_work.h"

#include "commands/model_options.h"
#include "files/batch_plan.h"
#include "files/input.h"
#include "reports/messages.h"

#include <bendy/edit/clips.h>
#include <bendy/format/diagnostics.h>
#include <bendy/motion/stand.h>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <span>
#include <string_view>
#include <system_error>

namespace bendy::tools {
namespace {

using Buffer = std::vector<std::byte>;

std::pair<edit::Named, std::string> split_rename(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) throw CLI::ValidationError("--rename", '"' + text + "\" is not KIND:OLD=NEW");
    const auto kind = edit::parse_named(std::string_view(text).substr(0, colon));
    if (!kind) throw CLI::ValidationError("--rename", kind.error().message);
    return {*kind, text.substr(colon + 1)};
}

/// {"old": "new", ...}
edit::Rename read_table(const std::filesystem::path& path) {
    const InputBytes file = open_file(path);
    edit::Rename rename;
    rename.all_must_match = false;
    const auto table = OrderedJson::parse(as_text(file.bytes()));
    if (!table) fail(path, "is not JSON");
    if (!table->is_object()) fail(path, "must be a JSON object, from old names to new ones");
    for (const auto& [before, after] : table->items()) {
        if (!after.is_string()) fail(path, "\"" + printable(before) + "\" has no text as its new name");
        rename.names.emplace_back(before, after.get<std::string>());
    }
    return rename;
}

/// A bendy file, or a file of another kind converted to one.
Result<Buffer, Failure> read_other(const std::filesystem::path& path, const std::filesystem::path& root,
                                   EditReport& report) {
    converter::Report unheard;
    const auto file = read_character(path, root, unheard);
    for (const converter::SourceFile& source : unheard.sources()) report.read.push_back(source.file);
    if (!file) return Failure{file_of(file.error(), path), describe(file.error())};
    return Buffer(file->bytes().begin(), file->bytes().end());
}

bool is_folder(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::is_directory(path, ignored);
}

/// The steps in the order of the command line.
class Steps {
public:
    explicit Steps(const EditArguments& arguments) : arguments_(arguments) {}

    void add(const std::string& option) {
        const auto texts = arguments_.texts.find(option);
        if (texts == arguments_.texts.end()) return;
        const std::string& text = texts->second[seen_[option]++];
        const auto maker = kMakers.find(option);
        if (maker == kMakers.end()) return add_clip_change(option, text);
        (this->*maker->second)(text);
    }
    EditSteps take() {
        close();
        return std::move(taken_);
    }

private:
    using Maker = void (Steps::*)(const std::string& text);
    /// Makes something of the file and another one.
    using Take = std::function<edit::Edited(Bytes file, Bytes other, EditReport& report)>;
    static const std::map<std::string, Maker> kMakers;  // of the options that are not changes of clips

    /// \param work  takes the file and the log, and returns the edited file
    template <class Work>
    void push(Work work) {
        close();
        append(std::move(work));
    }
    template <class Work>
    void append(Work work) {
        taken_.steps.emplace_back([work = std::move(work)](Bytes file, EditReport& report) -> Result<Buffer, Failure> {
            auto edited = work(file, report.log);
            if (!edited) return Failure{{}, edited.error().message};
            return *std::move(edited);
        });
    }

    void add_strip(const std::string& text) {
        const auto what = edit::parse_strip(text);
        if (!what) throw CLI::ValidationError("--strip", what.error().message);
        push([what = *what](Bytes file, edit::Log& log) { return edit::strip(file, what, log); });
    }

    void add_rename(const std::string& text) {
        const auto [kind, pair] = split_rename(text);
        add_pair("--rename", kind, pair);
    }

    void add_joint_rename(const std::string& text) { add_pair("--rename-joint", edit::Named::joint, text); }

    void add_pair(const char* option, edit::Named kind, const std::string& text) {
        const auto pair = edit::parse_pair(text);
        if (!pair) throw CLI::ValidationError(option, pair.error().message);
        if (rename_.names.empty() || rename_.kind != kind) close();
        rename_.kind = kind;
        rename_.names.push_back(*pair);
    }

    void add_table(const std::string& text) {
        const std::filesystem::path path(text);
        taken_.reads.push_back(path);
        push([table = read_table(path)](Bytes file, edit::Log& log) { return edit::rename(file, table, log); });
    }

    /// Makes one step of the options that belong together: renames of one kind, clips to keep.
    void close() {
        if (!rename_.names.empty()) {
            append(
                [rename = std::move(rename_)](Bytes file, edit::Log& log) { return edit::rename(file, rename, log); });
        }
        if (!kept_clips_.clips.empty()) {
            append([kept = std::move(kept_clips_)](Bytes file, edit::Log& log) {
                return edit::change_clips(file, kept, log);
            });
        }
        rename_ = {};
        kept_clips_ = {};
    }

    void add_clip_change(const std::string& option, const std::string& text) {
        const auto what = edit::parse_clip_change(option.substr(2), std::span(&text, 1));
        if (!what) throw CLI::ValidationError(option, what.error().message);
        if (what->work == edit::ClipWork::keep) {
            if (kept_clips_.clips.empty()) close();
            kept_clips_.clips.push_back(text);
            return;
        }
        push([what = *what](Bytes file, edit::Log& log) { return edit::change_clips(file, what, log); });
    }

    void add_influences(const std::string& text) {
        std::uint32_t most = 0;
        if (!CLI::detail::lexical_cast(text, most) || most == 0)
            throw CLI::ValidationError("--influences", '"' + text + "\" is not a number of influences, 1 or more");
        push([most](Bytes file, edit::Log& log) { return edit::limit_influences(file, most, log); });
    }

    void add_role(const std::string& text) {
        const auto what = edit::parse_role(text);
        if (!what) throw CLI::ValidationError("--role", what.error().message);
        push([what = *what](Bytes file, edit::Log& log) { return edit::set_role(file, what, log); });
    }

    void add_stand(const std::string& text) {
        const std::size_t sign = text.rfind('@');
        double seconds = 0.0;
        if (sign == std::string::npos || !CLI::detail::lexical_cast(text.substr(sign + 1), seconds))
            throw CLI::ValidationError("--stand", '"' + text + "\" is not CLIP@SECONDS");
        push([clip = text.substr(0, sign), seconds](Bytes file, edit::Log& log) {
            return motion::stand_as_in_clip(file, clip, seconds, log);
        });
    }

    void add_stand_as(const std::string& path) {
        add_other("standing as", path, [](Bytes file, Bytes other, EditReport& report) {
            return motion::stand_as(file, other, report.log);
        });
    }

    void add_set(const std::string& text) {
        const auto what = edit::parse_set(text);
        if (!what) throw CLI::ValidationError("--set", what.error().message);
        push([what = *what](Bytes file, edit::Log& log) { return edit::set_material(file, what, log); });
    }

    void add_merge(const std::string& path) {
        const edit::SameName same_name = read_same_name();
        add_other("merging", path, [same_name](Bytes file, Bytes other, EditReport& report) {
            return edit::add_clips(file, other, same_name, report.log);
        });
    }

    void add_retarget(const std::string& text) {
        const auto [path, clip] = split_clip(text);
        motion::RetargetClips options{clip, {}, read_same_name()};
        options.chooses_rests = !arguments_.rests_alike && !arguments_.rests_measured;
        options.retarget.limits = *motion::parse_limits(arguments_.limits);  // checked
        options.retarget.plants_feet = !arguments_.free_feet;
        if (arguments_.rests_alike) options.retarget.rest_poses = RestPoses::alike;
        if (is_folder(path)) return add_retarget_all(path, options);
        add_other("retargeting", path, retargeting(path, options));
    }

    /// Takes the clips of all files in a folder. Those that cannot be retargeted are left out with a warning, unless
    /// all of them are.
    void add_retarget_all(const std::filesystem::path& folder, const motion::RetargetClips& options) {
        std::string problem;
        const std::vector<std::filesystem::path> files = files_in(folder, true, problem);
        if (problem.empty() && files.empty()) problem = "has no file with clips";
        if (!problem.empty()) fail(folder, problem);
        close();
        taken_.reads.insert(taken_.reads.end(), files.begin(), files.end());
        std::vector<Step> all;
        all.reserve(files.size());
        for (const std::filesystem::path& file : files)
            all.push_back(step_with(file, "retargeting", retargeting(file, options)));
        taken_.steps.emplace_back([all, folder](Bytes bytes, EditReport& report) -> Result<Buffer, Failure> {
            Buffer edited(bytes.begin(), bytes.end());
            std::size_t left_out = 0;
            for (const Step& step : all) {
                auto next = step(edited, report);
                if (next) {
                    edited = *std::move(next);
                    continue;
                }
                ++left_out;
                const std::string place = next.error().file.empty() ? "" : next.error().file.string() + ": ";
                report.log.warnings.push_back("left out: " + place + next.error().what);
            }
            if (left_out < all.size()) return edited;
            const Failure none{{}, report.log.warnings.back() + ", like all files of " + folder.string()};
            return none;
        });
    }

    static Take retargeting(const std::filesystem::path& path, const motion::RetargetClips& options) {
        return [path, options](Bytes file, Bytes other, EditReport& report) {
            std::vector<motion::RetargetedClip> clips;
            auto edited = motion::retarget_clips(file, other, options, report.log, &clips);
            for (motion::RetargetedClip& clip : clips) report.clips.emplace_back(path.string(), std::move(clip));
            return edited;
        };
    }

    [[nodiscard]] edit::SameName read_same_name() const {
        const auto same_name = edit::parse_same_name(arguments_.same_name);
        if (!same_name) throw CLI::ValidationError("--same-name", same_name.error().message);
        return *same_name;
    }

    /// A step that takes something from another file.
    void add_other(const std::string& doing, const std::filesystem::path& path, const Take& take) {
        taken_.reads.push_back(path);
        close();
        taken_.steps.push_back(step_with(path, doing, take));
    }

    [[nodiscard]] Step step_with(const std::filesystem::path& path, const std::string& doing, const Take& take) const {
        return [doing, path, take, root = arguments_.root](Bytes file, EditReport& report) -> Result<Buffer, Failure> {
            const auto other = read_other(path, root, report);
            if (!other) return other.error();
            auto& warnings = report.log.warnings;
            const auto first = warnings.size();
            auto taken = take(file, *other, report);
            for (std::size_t k = first; k < warnings.size(); ++k) warnings[k] = path.string() + ": " + warnings[k];
            if (taken) return *std::move(taken);
            std::string text = doing + ' ' + path.string() + ": " + taken.error().message;
            if (text.ends_with("already")) text += "; --same-name replace or --same-name number says what to do";
            if (text.ends_with("retarget its clips instead")) text += ": --retarget " + path.string();
            return Failure{{}, std::move(text)};
        };
    }

    void add_extract(const std::string& joint) {
        push([joint](Bytes file, edit::Log& log) { return edit::extract(file, joint, log); });
    }

    const EditArguments& arguments_;
    std::map<std::string, std::size_t> seen_;
    edit::Rename rename_;
    edit::ClipChange kept_clips_;
    EditSteps taken_;
};

const std::map<std::string, Steps::Maker> Steps::kMakers{{"--strip", &Steps::add_strip},
                                                         {"--rename", &Steps::add_rename},
                                                         {"--rename-joint", &Steps::add_joint_rename},
                                                         {"--rename-joints", &Steps::add_table},
                                                         {"--role", &Steps::add_role},
                                                         {"--stand", &Steps::add_stand},
                                                         {"--stand-as", &Steps::add_stand_as},
                                                         {"--set", &Steps::add_set},
                                                         {"--merge", &Steps::add_merge},
                                                         {"--retarget", &Steps::add_retarget},
                                                         {"--extract", &Steps::add_extract},
                                                         {"--influences", &Steps::add_influences}};

}  // namespace

EditSteps make_steps(const EditArguments& arguments, const std::vector<std::string>& options) {
    Steps steps(arguments);
    for (const std::string& option : options) steps.add(option);
    return steps.take();
}

Result<Buffer, Failure> do_steps(const EditArguments& arguments, const std::vector<Step>& steps, Bytes file,
                                 EditReport& report) {
    Buffer bytes;
    for (const Step& step : steps) {
        auto edited = step(bytes.empty() ? file : Bytes(bytes), report);
        if (!edited) return edited.error();
        bytes = *std::move(edited);
    }
    if (arguments.strict && !report.log.warnings.empty())
        return Failure{{}, "there are warnings, and --strict: nothing is written"};
    return bytes;
}

}  // namespace bendy::tools
