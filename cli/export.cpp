#include "commands.h"
#include "problem.h"
#include "warnings.h"

#include <bendy/converter/export_gltf.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>

#include <iostream>
#include <memory>
#include <span>
#include <string>

namespace bendy::cli {
namespace {

struct ExportArguments {
    std::filesystem::path file;
    std::filesystem::path output;
    std::string format;
    bool quiet = false;
};

void write(const std::filesystem::path& file, Bytes bytes) {
    if (const auto written = write_file(file, bytes); !written) fail(file, describe(written.error()));
}

/// What the output's name says, if nothing else does.
std::string format_of(const ExportArguments& arguments) {
    if (!arguments.format.empty()) return arguments.format;
    return arguments.output.extension() == ".gltf" ? "gltf" : "glb";
}

void run(ExportArguments arguments) {
    const std::string format = format_of(arguments);
    if (arguments.output.empty()) {
        arguments.output = arguments.file;
        arguments.output.replace_extension(format);
    }
    const bool is_glb = format == "glb";
    std::filesystem::path buffer_file;
    if (!is_glb) buffer_file = std::filesystem::path(arguments.output).replace_extension("bin");
    std::error_code ignored;
    for (const auto& output : {arguments.output, buffer_file}) {
        if (std::filesystem::equivalent(arguments.file, output, ignored))
            fail(arguments.file, "the output would be the input: give another name with -o");
    }

    converter::Report report;
    const auto asset = converter::export_gltf(arguments.file, buffer_file.filename(), report);
    print_warnings(arguments.file, report);
    if (!asset) fail(arguments.file, printable(asset.error().message));
    std::size_t size = asset->json.size() + asset->buffer.size();
    if (is_glb) {
        const auto glb = converter::make_glb(*asset);
        if (!glb) fail(arguments.output, glb.error().message);
        size = glb->size();
        write(arguments.output, *glb);
    } else {
        if (!asset->buffer.empty()) write(buffer_file, asset->buffer);
        write(arguments.output, std::as_bytes(std::span(asset->json)));
    }
    if (!arguments.quiet) std::cout << printable(arguments.output.string()) << ": " << grouped(size) << " bytes\n";
}

}  // namespace

void add_export(CLI::App& program) {
    const auto arguments = std::make_shared<ExportArguments>();
    CLI::App* command = program.add_subcommand("export", "Write a bendy file as glTF 2.0");
    command->add_option("FILE", arguments->file, "a bendy file")->required();
    command->add_option("-o,--output", arguments->output, "where to write; the input's name with .glb if not given");
    command
        ->add_option(
            "--format", arguments->format,
            "glb: one file; gltf: JSON, and the numbers in a .bin file beside it; by the output's name if not given")
        ->check(CLI::IsMember({"glb", "gltf"}));
    command->add_flag("-q,--quiet", arguments->quiet, "warnings and errors only");
    command->footer(
        "Numbers are kept to the bit; constraints and IK chains go into the scene's extras, where `bendy convert` "
        "finds "
        "them.\nExample: bendy export fox.bendy -o fox.glb");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::cli
