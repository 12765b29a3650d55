#include "choices.h"
#include "commands/commands.h"
#include "commands/model_options.h"
#include "files/input.h"
#include "files/output.h"
#include "reports/json.h"
#include "reports/messages.h"

#include <bendy/edit/clips.h>
#include <bendy/edit/edit.h>
#include <bendy/format/diagnostics.h>
#include <bendy/json/json.h>
#include <bendy/motion/retarget_clips.h>
#include <bendy/motion/stand.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace bendy::tools {
namespace {

using Buffer = std::vector<std::byte>;

struct EditArguments {
    std::filesystem::path input;
    std::filesystem::path output;
    std::map<std::string, std::vector<std::string>> texts;  // of each option that makes steps, in its order
    std::filesystem::path root;
    std::string same_name = "error";
    std::string limits = std::string(motion::kLimitsWords.front());
    bool free_feet = false, rests_alike = false;
    bool in_place = false;
    bool quiet = false;
    bool strict = false, json = false;
};

/// One change; successive renames of the same kind are one change.
using Step = std::function<edit::Edited(Bytes, edit::Log&)>;

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
Buffer read_other(const std::filesystem::path& path, const std::filesystem::path& root, Outputs& outputs) {
    converter::Report unheard;
    const auto file = read_character(path, root, unheard);
    for (const converter::SourceFile& source : unheard.sources()) outputs.reads(source.file);
    if (!file) fail(file_of(file.error(), path), describe(file.error()));
    return {file->bytes().begin(), file->bytes().end()};
}

/// "walk.glb:Walk" is a file and a clip in it, unless there is a file of that name.
std::pair<std::filesystem::path, std::string> split_clip(const std::string& text) {
    std::error_code ignored;
    std::size_t colon = text.rfind(':');
    if (std::filesystem::exists(text, ignored)) colon = std::string::npos;
    for (; colon != std::string::npos && colon > 0; colon = text.rfind(':', colon - 1)) {
        if (std::filesystem::exists(text.substr(0, colon), ignored))
            return {text.substr(0, colon), text.substr(colon + 1)};
    }
    return {text, ""};
}

/// The steps in the order of the command line.
class Steps {
public:
    /// \param outputs  is told what the steps read
    Steps(const EditArguments& arguments, Outputs& outputs) : arguments_(arguments), outputs_(outputs) {}

    void add(const std::string& option) {
        const auto texts = arguments_.texts.find(option);
        if (texts == arguments_.texts.end()) return;
        const std::string& text = texts->second[seen_[option]++];
        const auto maker = kMakers.find(option);
        if (maker == kMakers.end()) return add_clip_change(option, text);
        (this->*maker->second)(text);
    }
    std::vector<Step> take() {
        close();
        return std::move(steps_);
    }

private:
    using Maker = void (Steps::*)(const std::string& text);
    static const std::map<std::string, Maker> kMakers;  // of the options that are not changes of clips

    template <class Work>
    void push(Work work) {
        close();
        steps_.emplace_back(std::move(work));
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
        outputs_.reads(path);
        push([path](Bytes file, edit::Log& log) { return edit::rename(file, read_table(path), log); });
    }

    /// Makes one step of the options that belong together: renames of one kind, clips to keep.
    void close() {
        if (!rename_.names.empty()) {
            steps_.emplace_back(
                [rename = std::move(rename_)](Bytes file, edit::Log& log) { return edit::rename(file, rename, log); });
        }
        if (!kept_clips_.clips.empty()) {
            steps_.emplace_back([kept = std::move(kept_clips_)](Bytes file, edit::Log& log) {
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
        add_other("standing as", path,
                  [](Bytes file, Bytes other, edit::Log& log) { return motion::stand_as(file, other, log); });
    }

    void add_set(const std::string& text) {
        const auto what = edit::parse_set(text);
        if (!what) throw CLI::ValidationError("--set", what.error().message);
        push([what = *what](Bytes file, edit::Log& log) { return edit::set_material(file, what, log); });
    }

    void add_merge(const std::string& path) {
        const edit::SameName same_name = read_same_name();
        add_other("merging", path, [same_name](Bytes file, Bytes other, edit::Log& log) {
            return edit::merge_clips(file, other, same_name, log);
        });
    }

    void add_retarget(const std::string& text) {
        const auto [path, clip] = split_clip(text);
        motion::RetargetClips options{clip, {}, read_same_name()};
        options.retarget.limits = *motion::parse_limits(arguments_.limits);  // checked
        options.retarget.plants_feet = !arguments_.free_feet;
        if (arguments_.rests_alike) options.retarget.rest_poses = RestPoses::alike;
        add_other("retargeting", path, [options](Bytes file, Bytes other, edit::Log& log) {
            return motion::retarget_clips(file, other, options, log);
        });
    }

    [[nodiscard]] edit::SameName read_same_name() const {
        const auto same_name = edit::parse_same_name(arguments_.same_name);
        if (!same_name) throw CLI::ValidationError("--same-name", same_name.error().message);
        return *same_name;
    }

    /// A step that takes clips from another file.
    void add_other(const std::string& doing, const std::filesystem::path& path,
                   const std::function<edit::Edited(Bytes file, Bytes other, edit::Log& log)>& take) {
        outputs_.reads(path);
        push([doing, path, take, root = arguments_.root, &outputs = outputs_](Bytes file,
                                                                              edit::Log& log) -> edit::Edited {
            const Buffer other = read_other(path, root, outputs);
            const auto first = log.warnings.size();
            auto taken = take(file, other, log);
            for (std::size_t k = first; k < log.warnings.size(); ++k)
                log.warnings[k] = path.string() + ": " + log.warnings[k];
            if (taken) return taken;
            std::string text = doing + ' ' + path.string() + ": " + taken.error().message;
            if (text.ends_with("already")) text += "; --same-name replace or --same-name number says what to do";
            if (text.ends_with("retarget its clips instead")) text += ": --retarget " + path.string();
            return edit::Problem{std::move(text)};
        });
    }

    void add_extract(const std::string& joint) {
        push([joint](Bytes file, edit::Log& log) { return edit::extract(file, joint, log); });
    }

    const EditArguments& arguments_;
    Outputs& outputs_;
    std::map<std::string, std::size_t> seen_;
    edit::Rename rename_;
    edit::ClipChange kept_clips_;
    std::vector<Step> steps_;
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

void print_change(const EditArguments& arguments, std::uint64_t before, std::uint64_t after) {
    std::ostream& out = print_size(arguments.output, after);
    if (after != before) {
        out << ", " << grouped(after < before ? before - after : after - before)
            << (after < before ? " less" : " more");
    }
    out << '\n';
}

/// Converts a file of another kind; --in-place replaces only bendy files.
CharacterFile open_edited(const EditArguments& arguments, Outputs& outputs) {
    if (arguments.in_place) return CharacterFile(open_bendy_file(arguments.input));
    return open_character(arguments.input, arguments.root, outputs);
}

Json list_of(const std::vector<std::string>& lines) {
    Json list = Json::array();
    for (const std::string& line : lines) list.push_back(line);
    return list;
}

/// \param outputs  is told what is read besides the file itself
void run(const EditArguments& arguments, const std::vector<Step>& steps, Outputs& outputs) {
    if (!arguments.in_place) outputs.reads(arguments.input);
    outputs.writes(arguments.output, NamedBy::user, Content::binary);
    check_suffix({"edit", "--output", {".bendy"}}, arguments.input, arguments.output);
    require_folder_of(arguments.output);
    CharacterFile file = open_edited(arguments, outputs);
    const std::uint64_t size_before = file.bytes().size();
    Buffer bytes;
    edit::Log log;
    for (const Step& step : steps) {
        auto edited = step(bytes.empty() ? file.bytes() : Bytes(bytes), log);
        if (!edited) fail(arguments.input, printable(edited.error().message));
        bytes = *std::move(edited);
    }
    if (arguments.strict && !log.warnings.empty()) {
        for (const std::string& warning : log.warnings) warn(arguments.input, printable(warning));
        fail(arguments.input, "there are warnings, and --strict: nothing is written");
    }
    file = CharacterFile(InputBytes());  // the output may be the input, and Windows cannot replace a mapped file
    outputs.write(arguments.output, bytes);
    if (arguments.json) {
        print_report(Json{{"file", arguments.output.string()},
                          {"bytes", bytes.size()},
                          {"done", list_of(log.done)},
                          {"warnings", list_of(log.warnings)}},
                     2);
        return;
    }
    for (const std::string& warning : log.warnings) warn(arguments.input, printable(warning));
    if (arguments.quiet) return;
    print_change(arguments, size_before, bytes.size());
    for (const std::string& line : log.done) summary_stream(arguments.output) << "  " << printable(line) << '\n';
}

}  // namespace

void add_edit(CLI::App& program) {
    const auto arguments = std::make_shared<EditArguments>();
    CLI::App* command = program.add_subcommand("edit", "Change a bendy file without converting it again");
    add_character(*command, arguments->input)->required();
    command->add_option("-o,--output", arguments->output, "where to write; never FILE itself");
    command->add_flag("-i,--in-place", arguments->in_place,
                      "replace FILE, a bendy file, with the result; use instead of --output");
    const auto add = [&](const std::string& name, const std::string& help) {
        command->add_option(name, arguments->texts[name], help)->allow_extra_args(false);
    };
    add("--strip",
        "take out all " + edit::strip_words() +
            "; or one: texture:NAME, clip:Run, mesh:Hat, target:Smile, chain:Arm, constraint:JOINT, chunk:ID");
    add("--rename-joint", "OLD=NEW; * matches anything: 'mixamorig:*=*' removes a prefix");
    add("--rename-joints", R"(a JSON file, {"old": "new", ...})");
    add("--rename", "KIND:OLD=NEW; KIND is joint, clip, chain, mesh, target, material, texture or object");
    add("--role",
        "ROLE=JOINT: what a joint is in the body, as in left_hand=Hand.L or tail:2=Tail3; without JOINT, nobody");
    add("--stand", "CLIP@SECONDS: the body stands upright then; retargeting measures from it, not from the rest pose");
    add("--stand-as", "FILE: the body stands as that file's character rests, joints by name");
    add("--set",
        "material:NAME.FIELD=VALUE, as in material:Wood.roughness=0.4, base_colour=1,0.5,0,1, alpha_mode=blend or "
        "normal_texture.texture=Bark; any other FIELD lists them all");
    for (const edit::ClipWord& word : edit::clip_words())
        add("--" + std::string(word.word), std::string(word.shape) + ": " + std::string(word.help));
    add("--influences", "N: at most N influences per vertex, the largest, scaled to the same sum");
    add("--merge", "add the clips of another file (bendy or glTF); tracks go to the joints of the same name");
    add("--retarget",
        "FILE or FILE:CLIP; put the clips of another character on this one, whatever its build: as this one's limits "
        "allow, with planted feet");
    command
        ->add_option("--limits", arguments->limits,
                     "of --retarget: soft, a joint may be up to 15 degrees beyond limits that --auto-rig or another "
                     "program proposed, not beyond an author's; hard, beyond none; off, limits do not act")
        ->check(one_of({motion::kLimitsWords.begin(), motion::kLimitsWords.end()}))
        ->capture_default_str();
    command->add_flag("--free-feet", arguments->free_feet, "of --retarget: do not bring feet to the ground");
    command->add_flag("--rests-alike", arguments->rests_alike,
                      "of --retarget: both characters rest in the same pose, as VRM demands; joints then turn exactly "
                      "as the other's");
    command
        ->add_option("--same-name", arguments->same_name,
                     "what --merge and --retarget do if a clip of that name exists: error; replace the existing clip; "
                     "or number the "
                     "new one, as in Run.001")
        ->check(one_of({"error", "replace", "number"}))
        ->capture_default_str();
    add_root(*command, arguments->root);
    add("--extract", "make a character of this joint and its descendants; it keeps its place in every clip");
    command->add_flag("-q,--quiet", arguments->quiet, "no summary; warnings and errors only");
    command->add_flag("--strict", arguments->strict, "exit with 1 and write nothing if there is a warning");
    command->add_flag("--json", arguments->json, "print a JSON report instead of the summary and warnings");
    command->footer(
        "Names may have * and ?. A number may stand for a name: 0, or #0 beside something called 0, which is =0 then.\n"
        "Options are applied in their order; renames of one kind that follow one another happen at once, and so does\n"
        "--keep-clip. What is not touched keeps its bytes, unknown chunks too.\n"
        "Example: bendy edit fox.bendy -o out.bendy --strip textures --merge run.glb --rename clip:mixamo.com=Run");
    command->callback([arguments, command] {
        if (arguments->output.empty() == !arguments->in_place)
            throw CLI::ValidationError("--output", "is missing; --output FILE or --in-place says where to write");
        if (arguments->in_place) arguments->output = arguments->input;
        if (arguments->in_place && is_dash(arguments->input))
            throw CLI::ValidationError("--in-place", "goes with a file, not with standard input: -o - writes on");
        if (arguments->json && is_dash(arguments->output))
            throw CLI::ValidationError("--json", "goes to standard output, and so does the file: give that a name");
        Outputs outputs;
        Steps steps(*arguments, outputs);
        for (const CLI::Option* option : command->parse_order()) steps.add(option->get_name());
        const auto taken = steps.take();
        if (taken.empty()) {
            throw CLI::ValidationError(
                "edit",
                "there is nothing to do: --strip, --rename-joint, --role, --trim, --merge, --retarget, --extract, ...");
        }
        run(*arguments, taken, outputs);
    });
}

}  // namespace bendy::tools
