#include "commands/commands.h"
#include "files/input.h"
#include "files/output.h"
#include "files/progress.h"
#include "reports/messages.h"

#include <bendy/converter/source_format.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>
#include <bendy/text_form/text_form.h>

#include <iostream>
#include <memory>

// `bendy dump` and `bendy assemble`: from a file to JSON, and back.
namespace bendy::tools {
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
    ChunkTree tree = read_tree(arguments.file, bytes);
    Faults faults;
    check_sums(tree, faults);
    if (!faults.empty()) {
        const std::string what = describe_with_place(faults.list().front(), bytes);
        if (!arguments.ignore_sums) fail(arguments.file, what + "; --ignore-sums writes the text anyway");
        warn(arguments.file, what + "; the text will not show it");
    }
    decode_leaves(tree);
    text_form::DumpOptions options;
    options.decode = arguments.decode;
    LateProgress progress("dumping");
    const std::string text = text_form::dump(tree, options, progress.callback());
    outputs.write(arguments.output, text);
}

struct AssembleArguments {
    std::filesystem::path file;
    std::filesystem::path output;
    bool force = false;
    bool allow_invalid = false;
};

/// fox.bendy.json and fox.json become fox.bendy; standard input goes to standard output.
std::filesystem::path default_output(const std::filesystem::path& file) {
    if (is_dash(file)) return file;
    std::filesystem::path stem = file;
    if (stem.extension() == ".json") stem.replace_extension();
    if (stem.extension() != ".bendy") stem += ".bendy";
    return stem;
}

/// Fails for a file that is known not to be our text form, and names the command that reads it.
void refuse_other_kinds(const std::filesystem::path& file, Bytes bytes) {
    const auto kind = converter::find_file_kind(bytes, file);
    if (!kind) return;
    if (kind->format == converter::SourceFormat::bendy)
        fail(file, "is a bendy file, not the text of one, which `bendy dump` writes");
    if (kind->format || !kind->way_in.empty()) fail(file, printable(converter::why_not_bendy(*kind, file)));
}

void run(AssembleArguments arguments) {
    require_folder_of(arguments.output);
    const NamedBy named = arguments.output.empty() ? NamedBy::program : NamedBy::user;
    if (arguments.output.empty()) arguments.output = default_output(arguments.file);
    Outputs outputs(arguments.force);
    outputs.reads(arguments.file);
    outputs.writes(arguments.output, named, Content::binary);
    check_suffix({"assemble", "--output", {".bendy"}}, arguments.file, arguments.output);
    const InputBytes file = open_file(arguments.file);
    refuse_other_kinds(arguments.file, file.bytes());

    LateProgress progress("assembling");
    const auto bytes = text_form::assemble(as_text(file.bytes()), progress.callback());
    if (!bytes) {
        const text_form::TextFault& fault = bytes.error();
        const std::string place = std::to_string(fault.line) + ':' + std::to_string(fault.column);
        fail(std::filesystem::path(shown_name(arguments.file)) += ':' + place, printable(fault.what));
    }
    const Faults faults = validate(*bytes);
    if (!faults.empty() && !arguments.allow_invalid) {
        print_fault_lines(std::cerr, arguments.file, faults, *bytes);
        fail(arguments.file, "the result would be invalid and is not written; --allow-invalid writes it anyway");
    }
    outputs.write(arguments.output, *bytes);
    if (!faults.empty()) warn_of_faults(output_name(arguments.output), faults, *bytes);
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

void add_assemble(CLI::App& program) {
    const auto arguments = std::make_shared<AssembleArguments>();
    CLI::App* command = program.add_subcommand("assemble", "Build a bendy file from the JSON that `bendy dump` writes");
    command->add_option("FILE", arguments->file, "a text: FILE.bendy.json")->required();
    command->add_option("-o,--output", arguments->output, "where to write; FILE.bendy if not given");
    command->add_flag("--force", arguments->force, "replace FILE.bendy even if bendy did not write it");
    command->add_flag("--allow-invalid", arguments->allow_invalid,
                      "write the file even if it is invalid, to test readers; otherwise the errors are listed and the "
                      "exit status is 1");
    command->footer(
        "spec/text.md describes the text form; spec/text.schema.json is its JSON Schema.\nExample: bendy assemble "
        "fox.bendy.json -o edited.bendy");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::tools
