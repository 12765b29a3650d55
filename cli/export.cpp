#include "commands.h"
#include "input_file.h"
#include "level_of_detail.h"
#include "output_folder.h"
#include "problem.h"
#include "warnings.h"

#include <bendy/converter/export_gltf.h>
#include <bendy/converter/export_x.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>
#include <bendy/runtime/model.h>

#include <cstdint>
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
    float lod = 1.0f;
    bool quiet = false;
};

void write(const std::filesystem::path& file, Bytes bytes) {
    if (const auto written = write_file(file, bytes); !written) fail(file, describe(written.error()));
}

/// What the output's name says, if nothing else does.
std::string format_of(const ExportArguments& arguments) {
    if (!arguments.format.empty()) return arguments.format;
    const std::string extension = arguments.output.extension().string();
    if (extension == ".x" || extension == ".X") return "x";
    return extension == ".gltf" ? "gltf" : "glb";
}

void refuse_input(const std::filesystem::path& input, const std::filesystem::path& output) {
    std::error_code ignored;
    if (std::filesystem::equivalent(input, output, ignored))
        fail(input, "the output would be the input: give another name with -o");
}

/// Where it goes, and the level of detail.
converter::ExportOptions options_of(const ExportArguments& arguments) {
    converter::ExportOptions options;
    options.output = arguments.output;
    if (!(arguments.lod < 1.0f)) return options;
    const MappedFile file = open_bendy_file(arguments.file);
    const Result<Model> model = Model::from_memory(file.bytes());
    if (!model) fail(arguments.file, model.error(), file.bytes());
    const Lod lod = level_of(arguments.file, *model, arguments.lod);
    for (std::uint32_t pool = 0; pool < model->pools().size(); ++pool) options.vertices.push_back(lod.vertices(pool));
    return options;
}

/// \return bytes that were written
std::uint64_t export_gltf(const ExportArguments& arguments, bool is_glb, converter::Report& report) {
    std::filesystem::path buffer_file;
    if (!is_glb) {
        buffer_file = std::filesystem::path(arguments.output).replace_extension("bin");
        refuse_input(arguments.file, buffer_file);
    }
    const auto asset = converter::export_gltf(arguments.file, buffer_file.filename(), report, options_of(arguments));
    print_warnings(arguments.file, report);
    if (!asset) fail(arguments.file, printable(asset.error().message));
    if (is_glb) {
        const auto glb = converter::make_glb(*asset);
        if (!glb) fail(arguments.output, glb.error().message);
        write(arguments.output, *glb);
        return glb->size();
    }
    if (!asset->buffer.empty()) write(buffer_file, asset->buffer);
    write(arguments.output, std::as_bytes(std::span(asset->json)));
    return asset->json.size() + asset->buffer.size();
}

/// \return bytes that were written
std::uint64_t export_x(const ExportArguments& arguments, converter::Report& report) {
    const auto asset =
        converter::export_x(arguments.file, arguments.output.stem().string(), report, options_of(arguments));
    print_warnings(arguments.file, report);
    if (!asset) fail(arguments.file, printable(asset.error().message));
    std::uint64_t size = asset->text.size();
    for (const converter::XAsset::File& image : asset->images) {
        const std::filesystem::path file = arguments.output.parent_path() / image.name;
        refuse_input(arguments.file, file);
        write(file, image.bytes);
        size += image.bytes.size();
    }
    write(arguments.output, std::as_bytes(std::span(asset->text)));
    if (!arguments.quiet && !asset->images.empty()) {
        std::cout << "images beside it:";
        for (const converter::XAsset::File& image : asset->images) std::cout << ' ' << printable(image.name);
        std::cout << '\n';
    }
    return size;
}

void run(ExportArguments arguments) {
    require_folder_of(arguments.output);
    const std::string format = format_of(arguments);
    if (arguments.output.empty()) {
        arguments.output = arguments.file;
        arguments.output.replace_extension(format);
    }
    static_cast<void>(open_bendy_file(arguments.file));  // what is wrong with it comes first
    refuse_input(arguments.file, arguments.output);
    converter::Report report;
    const std::uint64_t size =
        format == "x" ? export_x(arguments, report) : export_gltf(arguments, format == "glb", report);
    if (!arguments.quiet) std::cout << printable(arguments.output.string()) << ": " << grouped(size) << " bytes\n";
}

}  // namespace

void add_export(CLI::App& program) {
    const auto arguments = std::make_shared<ExportArguments>();
    CLI::App* command = program.add_subcommand("export", "Write a bendy file as glTF 2.0, or as a DirectX X-file");
    command->add_option("FILE", arguments->file, "a bendy file")->required();
    command->add_option("-o,--output", arguments->output, "where to write; the input's name with .glb if not given");
    command
        ->add_option(
            "--format", arguments->format,
            "glb: one file; gltf: JSON, and the numbers in a .bin file beside it; x: a DirectX X-file in text, images "
            "beside it; by the output's name if not given")
        ->check(CLI::IsMember({"glb", "gltf", "x"}));
    add_lod(*command, arguments->lod);
    command->add_flag("-q,--quiet", arguments->quiet, "warnings and errors only");
    command->footer(
        "glTF: numbers are kept to the bit; constraints and IK chains go into the scene's extras, where `bendy "
        "convert` "
        "finds them.\nX-files: constraints and chains go into templates of our own (spec/xfile.md); what has no place "
        "is named.\nExample: bendy export fox.bendy -o fox.glb\n         bendy export lod.bendy --lod 0.25 -o far.glb");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::cli
