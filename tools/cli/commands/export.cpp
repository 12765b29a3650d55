#include "choices.h"
#include "commands/commands.h"
#include "commands/model_options.h"
#include "files/input.h"
#include "files/output.h"
#include "reports/messages.h"

#include <bendy/converter/export.h>
#include <bendy/runtime/model.h>

#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace bendy::tools {
namespace {

struct ExportArguments {
    std::filesystem::path file;
    std::filesystem::path output;
    std::string format;
    float lod = 1.0f;
    bool force = false;
    bool quiet = false;
};

/// The format: --format, or else the suffix of the output's name.
std::string export_format(const ExportArguments& arguments) {
    if (!arguments.format.empty()) return arguments.format;
    const std::string suffix = suffix_of(arguments.output);
    return suffix == ".x" || suffix == ".gltf" ? suffix.substr(1) : "glb";
}

/// Returns an output name that fits the format.
void check_output(const ExportArguments& arguments, const std::string& format) {
    const bool has_meaning = !arguments.format.empty() || !arguments.output.has_extension();
    check_suffix({"export", "--output", {".glb", ".gltf", ".x"}, has_meaning}, arguments.file, arguments.output,
                 arguments.format);
    if (format != "glb" && is_dash(arguments.output))
        throw CLI::ValidationError("--output", format + " may need files beside it: only glb goes to standard output");
}

/// Adds the options for the output and the level of detail.
converter::ExportOptions options_of(const ExportArguments& arguments, Bytes file) {
    converter::ExportOptions options;
    options.output = is_dash(arguments.output) ? "standard output" : arguments.output;
    if (!(arguments.lod < 1.0f)) return options;
    const Model model = read_valid_model(arguments.file, file);
    const Lod lod = level_of(arguments.file, model, arguments.lod);
    for (std::uint32_t mesh = 0; mesh < model.meshes().size(); ++mesh) options.vertices.push_back(lod.vertices(mesh));
    return options;
}

/// \return the number of bytes written
std::uint64_t export_gltf(const ExportArguments& arguments, Bytes file, bool is_glb, Outputs& outputs,
                          converter::Report& report) {
    std::filesystem::path buffer_file;
    if (!is_glb) buffer_file = std::filesystem::path(arguments.output).replace_extension("bin");
    const converter::ExportOptions options = options_of(arguments, file);
    const auto asset = is_dash(arguments.file)
                           ? converter::export_gltf(file, buffer_file.filename(), report, options)
                           : converter::export_gltf(arguments.file, buffer_file.filename(), report, options);
    print_warnings(arguments.file, report);
    if (!asset) fail(arguments.file, printable(asset.error().message));
    if (is_glb) {
        const auto glb = converter::make_glb(*asset);
        if (!glb) fail(output_name(arguments.output), glb.error().message);
        outputs.write(arguments.output, *glb);
        return glb->size();
    }
    std::vector<FileContents> files{{arguments.output, as_byte_span(asset->json)}};
    if (!asset->buffer.empty()) {
        outputs.writes_beside(buffer_file, arguments.output);
        files.push_back({buffer_file, asset->buffer});
    }
    outputs.write(files);
    return asset->json.size() + asset->buffer.size();
}

#ifdef BENDY_X_FILES
/// \return the number of bytes written
std::uint64_t export_x(const ExportArguments& arguments, Bytes file, Outputs& outputs, converter::Report& report) {
    const converter::ExportOptions options = options_of(arguments, file);
    const std::string stem = arguments.output.stem().string();
    const auto asset = is_dash(arguments.file) ? converter::export_x(file, stem, report, options)
                                               : converter::export_x(arguments.file, stem, report, options);
    print_warnings(arguments.file, report);
    if (!asset) fail(arguments.file, printable(asset.error().message));
    std::uint64_t size = asset->text.size();
    const std::filesystem::path folder = arguments.output.parent_path();
    std::vector<FileContents> files{{arguments.output, as_byte_span(asset->text)}};
    for (const converter::XAsset::File& image : asset->images) {
        outputs.writes_beside(folder / image.name, arguments.output);
        files.push_back({folder / image.name, image.bytes});
        size += image.bytes.size();
    }
    outputs.write(files);
    if (!arguments.quiet && !asset->images.empty()) {
        std::cout << "images beside it:";
        for (const converter::XAsset::File& image : asset->images) std::cout << ' ' << escaped(image.name);
        std::cout << '\n';
    }
    return size;
}
#else
std::uint64_t export_x(const ExportArguments& arguments, Bytes /*file*/, Outputs& /*outputs*/,
                       converter::Report& /*report*/) {
    fail(arguments.file, "this bendy was built without X-files (BENDY_X_FILES)");
}
#endif

void run(ExportArguments arguments) {
    require_folder_of(arguments.output);
    const std::string format = export_format(arguments);
    const NamedBy named = arguments.output.empty() ? NamedBy::program : NamedBy::user;
    if (arguments.output.empty()) {
        arguments.output = arguments.file;
        if (!is_dash(arguments.file)) arguments.output.replace_extension(format);
    }
    Outputs outputs(arguments.force);
    outputs.reads(arguments.file);
    outputs.writes(arguments.output, named, format == "glb" ? Content::binary : Content::text);
    check_output(arguments, format);
    const InputBytes file = open_bendy_file(arguments.file);
    converter::Report report;
    const std::uint64_t size = format == "x" ? export_x(arguments, file.bytes(), outputs, report)
                                             : export_gltf(arguments, file.bytes(), format == "glb", outputs, report);
    if (!arguments.quiet) print_size(arguments.output, size) << '\n';
}

}  // namespace

void add_export(CLI::App& program) {
    const auto arguments = std::make_shared<ExportArguments>();
    CLI::App* command = program.add_subcommand("export", "Write a bendy file as glTF 2.0, or as a DirectX X-file");
    command->add_option("FILE", arguments->file, "a bendy file")->required();
    command->add_option("-o,--output", arguments->output, "where to write; the input's name with .glb if not given");
    command->add_flag("--force", arguments->force,
                      "overwrite files that bendy did not write and -o does not name: the default output, and files "
                      "written next to an output");
    command
        ->add_option("--format", arguments->format,
                     "glb: one file; gltf: JSON with a .bin file next to it; x: a DirectX X-file in text form, with "
                     "images next to it; from the output's name if not given")
        ->check(one_of({"glb", "gltf", "x"}));
    add_lod(*command, arguments->lod);
    command->add_flag("-q,--quiet", arguments->quiet, "warnings and errors only");
    command->footer(
        "glTF: numbers are kept to the bit; constraints and IK chains go into extensions of our own (spec/gltf.md), "
        "where `bendy convert` finds them.\nX-files: constraints and chains go into templates of our own "
        "(spec/xfile.md); what has no place "
        "is named.\nExample: bendy export fox.bendy -o fox.glb\n         bendy export lod.bendy --lod 0.25 -o far.glb");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::tools
