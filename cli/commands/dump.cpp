#include "commands/commands.h"
#include "files/input.h"
#include "files/output.h"
#include "terminal/problem.h"
#include "terminal/progress.h"

#include <bendy/format/chunk_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/text_form/text_form.h>

#include <memory>

namespace bendy::cli {
namespace {

struct DumpArguments {
    std::filesystem::path file;
    std::filesystem::path output = "-";
    bool decode = false;
    bool ignore_sums = false;
};

void run(const DumpArguments& arguments) {
    Outputs outputs;
    outputs.reads(arguments.file);
    outputs.writes(arguments.output, NamedBy::user, Content::text);
    check_suffix({"dump", "--output", {".json", ".txt"}}, arguments.file, arguments.output);
    require_folder_of(arguments.output);
    const InputBytes file = open_bendy_file(arguments.file);
    const Bytes bytes = file.bytes();
    Result<ChunkTree> tree = read_chunk_tree(bytes);
    if (!tree) fail(arguments.file, tree.error(), bytes);
    Faults faults;
    check_sums(*tree, faults);
    if (!faults.empty()) {
        const std::string what = describe_with_place(faults.list().front(), bytes);
        if (!arguments.ignore_sums) fail(arguments.file, what + "; --ignore-sums writes the text anyway");
        warn(arguments.file, what + "; the text will not show it");
    }
    decode_leaves(*tree);
    text_form::DumpOptions options;
    options.decode = arguments.decode;
    LateProgress progress("dumping");
    const std::string text = text_form::dump(*tree, options, progress.callback());
    outputs.write(arguments.output, text);
}

}  // namespace

void add_dump(CLI::App& program) {
    const auto arguments = std::make_shared<DumpArguments>();
    CLI::App* command = program.add_subcommand(
        "dump", "Write a file as JSON to read and edit; `bendy assemble` turns it back into the same bytes");
    command->add_option("FILE", arguments->file, "a bendy file")->required();
    command->add_option("-o,--output", arguments->output, "where to write; standard output if not given");
    command->add_flag(
        "--decode", arguments->decode,
        "write encoded chunks decoded: the text is shorter, and assembles to the same content without encodings");
    command->add_flag("--ignore-sums", arguments->ignore_sums,
                      "accept a file with wrong checksums; assembling corrects them");
    command->footer("spec/text.md describes the text form.\nExample: bendy dump fox.bendy -o fox.bendy.json");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::cli
