#include "choices.h"
#include "commands/commands.h"
#include "commands/model_options.h"
#include "edit/edit_work.h"
#include "files/batch_plan.h"
#include "files/input.h"
#include "files/output.h"
#include "reports/json.h"
#include "reports/messages.h"

#include <bendy/edit/clips.h>
#include <bendy/edit/edit.h>
#include <bendy/motion/retarget_clips.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::tools {
namespace {

/// Converts a file of another kind; --in-place replaces only bendy files.
CharacterFile open_edited(const EditArguments& arguments, Outputs& outputs) {
    const std::filesystem::path& input = arguments.inputs.front();
    if (arguments.in_place) return CharacterFile(open_bendy_file(input));
    return open_character(input, arguments.root, outputs);
}

void edit_file(EditArguments arguments, const EditSteps& steps) {
    const std::filesystem::path& input = arguments.inputs.front();
    if (arguments.in_place) arguments.output = input;
    Outputs outputs;
    for (const std::filesystem::path& file : steps.reads) outputs.reads(file);
    if (!arguments.in_place) outputs.reads(input);
    outputs.writes(arguments.output, NamedBy::user, Content::binary);
    check_suffix({"edit", "--output", {".bendy"}}, input, arguments.output);
    require_folder_of(arguments.output);
    CharacterFile file = open_edited(arguments, outputs);
    const std::uint64_t size_before = file.bytes().size();
    EditReport report;
    const auto edited = do_steps(arguments, steps.steps, file.bytes(), report);
    const bool tells_warnings = edited ? !arguments.json : arguments.strict;
    for (const std::string& warning : report.log.warnings) {
        if (tells_warnings) warn(input, printable(warning));
    }
    if (!edited) fail(edited.error().file.empty() ? input : edited.error().file, printable(edited.error().what));
    for (const std::filesystem::path& read : report.read) outputs.reads(read);
    file = CharacterFile(InputBytes());  // the output may be the input, and Windows cannot replace a mapped file
    outputs.write(arguments.output, *edited);
    if (arguments.json) return print_report(edited_report(arguments.output, edited->size(), report), 2);
    if (arguments.quiet) return;
    print_size(arguments.output, edited->size()) << change_of_size(size_before, edited->size()) << '\n';
    for (const std::string& line : report.log.done) summary_stream(arguments.output) << "  " << printable(line) << '\n';
}

void run(const EditArguments& arguments, const std::vector<std::string>& options) {
    const bool is_many = is_batch(arguments.inputs, arguments.output);
    if (arguments.in_place && is_dash(arguments.inputs.front()))
        throw CLI::ValidationError("--in-place", "goes with a file, not with standard input: -o - writes on");
    if (is_many) check_batch(arguments.inputs, arguments.output);
    const EditSteps steps = make_steps(arguments, options);
    if (steps.steps.empty()) {
        throw CLI::ValidationError(
            "edit",
            "there is nothing to do: --strip, --rename-joint, --role, --trim, --merge, --retarget, --extract, ...");
    }
    is_many ? edit_batch(arguments, steps) : edit_file(arguments, steps);
}

}  // namespace

void add_edit(CLI::App& program) {
    const auto arguments = std::make_shared<EditArguments>();
    CLI::App* command = program.add_subcommand("edit", "Change a bendy file without converting it again");
    command
        ->add_option("FILE", arguments->inputs,
                     "a bendy file, or a file that convert reads; or several, or folders: all such files in them and "
                     "below, each of which gets the same changes")
        ->required();
    command->add_option("-o,--output", arguments->output,
                        "where to write; never FILE itself. For several files or a folder, the folder to write to");
    command->add_flag("-i,--in-place", arguments->in_place,
                      "replace each FILE, a bendy file, with the result; use instead of --output");
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
        "FILE, FILE:CLIP or FOLDER; put the clips of another character, or of all files in a folder, on this one, "
        "whatever its build: as this one's limits allow, with planted feet");
    command
        ->add_option("--limits", arguments->limits,
                     "of --retarget: soft, a joint may be up to 15 degrees beyond limits that --auto-rig or another "
                     "program proposed, not beyond an author's; hard, beyond none; off, limits do not act")
        ->check(one_of({motion::kLimitsWords.begin(), motion::kLimitsWords.end()}))
        ->capture_default_str();
    command->add_flag("--free-feet", arguments->free_feet,
                      "of --retarget: do not bring feet, hands and body to the ground, nor hands to each other");
    auto* const alike = command->add_flag(
        "--rests-alike", arguments->rests_alike,
        "of --retarget: both characters rest in the same pose, as VRM demands; joints then turn exactly as the "
        "other's. Between animals on four legs, this is chosen if feet then miss their places by a quarter less");
    command
        ->add_flag("--rests-measured", arguments->rests_measured,
                   "of --retarget: limbs have the other's directions, also where --rests-alike would be chosen")
        ->excludes(alike);
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
    command->add_flag(
        "--json", arguments->json,
        "print a JSON report instead of the summary and warnings; of several files one each, on one line");
    command
        ->add_option("-j,--jobs", arguments->jobs,
                     "how many of several files to edit at a time; one per processor if not given")
        ->check(CLI::Range(1u, 1024u));
    command->footer(
        "Names may have * and ?. A number may stand for a name: 0, or #0 beside something called 0, which is =0 then.\n"
        "Options are applied in their order; renames of one kind that follow one another happen at once, and so does\n"
        "--keep-clip. What is not touched keeps its bytes, unknown chunks too.\n"
        "Example: bendy edit fox.bendy -o out.bendy --strip textures --merge run.glb --rename clip:mixamo.com=Run");
    command->callback([arguments, command] {
        if (arguments->output.empty() == !arguments->in_place)
            throw CLI::ValidationError("--output", "is missing; --output FILE or --in-place says where to write");
        if (arguments->json && is_dash(arguments->output))
            throw CLI::ValidationError("--json", "goes to standard output, and so does the file: give that a name");
        std::vector<std::string> options;
        for (const CLI::Option* option : command->parse_order()) options.push_back(option->get_name());
        run(*arguments, options);
    });
}

}  // namespace bendy::tools
