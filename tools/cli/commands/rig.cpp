#include "commands/commands.h"
#include "files/input.h"
#include "files/output.h"
#include "reports/messages.h"

#include <bendy/converter/export.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>

#include <memory>

namespace bendy::tools {
namespace {

struct RigArguments {
    std::filesystem::path file;
    std::filesystem::path output = "-";
};

void run(const RigArguments& arguments) {
    Outputs outputs;
    outputs.reads(arguments.file);
    outputs.writes(arguments.output, NamedBy::user, Content::text);
    check_suffix({"rig", "--output", {".json"}}, arguments.file, arguments.output);
    require_folder_of(arguments.output);
    const InputBytes file = open_bendy_file(arguments.file);
    const Bytes bytes = file.bytes();
    ChunkTree tree = read_tree(arguments.file, bytes);
    Faults faults;
    check_sums(tree, faults);
    decode_leaves(tree);
    const Document document = read_document(tree, faults);
    if (faults.empty()) check_values(tree, document, faults);
    if (!faults.empty()) fail(arguments.file, faults.list().front(), bytes);
    if (document.objects.empty()) fail(arguments.file, "there is no object in the file");
    if (document.objects.size() > 1)
        warn(arguments.file, "there are " + grouped(document.objects.size()) + " objects; the rig is the first one's");

    outputs.write(arguments.output, converter::write_rig(document.objects.front()));
}

}  // namespace

void add_rig(CLI::App& program) {
    const auto arguments = std::make_shared<RigArguments>();
    CLI::App* command = program.add_subcommand(
        "rig", "Write the joint constraints, IK chains, roles, markers and curves of a file as JSON");
    command->add_option("FILE", arguments->file, "a bendy file")->required();
    command->add_option("-o,--output", arguments->output, "where to write; standard output if not given");
    command->footer(
        "Edit it and put it back with `bendy convert --rig`; the layout is spec/rig.md.\n"
        "Example: bendy rig fox.bendy -o fox.rig.json");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::tools
