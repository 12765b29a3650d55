#include "commands.h"
#include "problem.h"
#include "progress_bar.h"
#include "warnings.h"

#include <bendy/converter/convert.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>
#include <bendy/runtime.h>

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::cli {
namespace {

struct ConvertArguments {
    std::filesystem::path input;
    std::filesystem::path output;
    std::string scene;
    std::string images = "embed";
    std::filesystem::path rig;
    bool exact = true;
    bool auto_rig = false;
    bool compact = false;
    std::string max_error;
    bool lod = false;
    bool sort_vertices = false;
    bool quiet = false;
};

void print_proposals(const converter::Report& report) {
    for (const std::string& line : report.proposals()) std::cerr << "bendy: proposed: " << printable(line) << '\n';
}

std::string counted(std::uint64_t count, std::string_view one, std::string_view many) {
    return grouped(count) + ' ' + std::string(count == 1 ? one : many);
}

std::string list_cycles(const Model& model) {
    constexpr std::size_t kShown = 20;
    std::ostringstream list;
    list << std::setprecision(3);
    for (std::size_t i = 0; i < std::min(model.cycles().size(), kShown); ++i) {
        const Cycle& cycle = model.cycles()[i];
        list << (i == 0 ? ": " : ", ") << (cycle.name.empty() ? '#' + std::to_string(i) : printable(cycle.name)) << ' '
             << cycle.end - cycle.start << " s";
    }
    if (model.cycles().size() > kShown) list << ", ...";
    return list.str();
}

std::string list_chains(const Model& model) {
    constexpr std::size_t kShown = 20;
    const auto chains = model.chains();
    std::string list;
    for (std::size_t i = 0; i < std::min(chains.size(), kShown); ++i)
        list += (i == 0 ? ": " : ", ") + (chains[i].name.empty() ? '#' + std::to_string(i) : printable(chains[i].name));
    return chains.size() > kShown ? list + ", ..." : list;
}

/// Bytes by kind before and after, and the worst error.
void print_compact(const converter::CompactReport& report) {
    std::uint64_t before = 0;
    std::uint64_t after = 0;
    const auto print_line = [](std::string_view kind, std::uint64_t exact, std::uint64_t compact) {
        std::cout << "  " << std::left << std::setw(10) << kind << std::right << std::setw(14) << grouped(exact)
                  << std::setw(14) << grouped(compact) << '\n';
    };
    std::cout << "  bytes              exact       compact\n";
    for (std::size_t k = 0; k < report.compact.size(); ++k) {
        before += report.exact[k].bytes;
        after += report.compact[k].bytes;
        if (report.exact[k].bytes + report.compact[k].bytes != 0)
            print_line(report.compact[k].kind, report.exact[k].bytes, report.compact[k].bytes);
    }
    print_line("total", before, after);
    constexpr double kMillimetres = 1e3;
    std::cout << std::setprecision(3) << "  error      at most " << report.max_error * kMillimetres << " mm; worst met "
              << report.measured_error * kMillimetres << " mm";
    if (!report.place.empty()) std::cout << ": " << printable(report.place);
    std::cout << '\n';
}

auto convert_with_bar(const ConvertArguments& arguments, converter::ConvertOptions options, converter::Report& report) {
    ProgressBar bar("compacting");
    std::uint64_t shown = 0;
    if (!arguments.quiet) {
        options.progress = [&](double share) {
            const auto percent = static_cast<std::uint64_t>(100.0 * share);
            if (percent > shown) bar.show(shown = percent, 100);
        };
    }
    return converter::convert(arguments.input, options, report);
}

void print_summary(const ConvertArguments& arguments, Bytes bytes) {
    const Result<Model> model = Model::from_memory(bytes);
    if (!model) fail(arguments.output, model.error(), bytes);
    std::uint64_t triangles = 0;
    std::uint64_t most_influences = 0;
    for (const Draw& draw : model->draws()) triangles += draw.topology == Topology::triangles ? draw.count / 3 : 0;
    for (const Pool& pool : model->pools())
        most_influences = std::max<std::uint64_t>(most_influences, pool.bones ? pool.bones->components : 0);
    std::set<std::string_view> targets;
    for (const Pool& pool : model->pools()) {
        for (const TargetView& target : pool.targets) targets.insert(target.name);
    }
    std::uint64_t images = 0;
    for (const Texture& texture : model->textures()) {
        for (const ImageView& image : texture.images) images += image.bytes.size();
    }

    std::cout << printable(arguments.output.string()) << ": " << grouped(bytes.size()) << " bytes";
    if (images != 0) std::cout << ", " << grouped(images) << " of them images";
    std::cout << "\n  skeleton   " << counted(model->joints().size(), "joint", "joints");
    if (!model->constraints().empty() || !model->chains().empty())
        std::cout << "\n  rig        " << counted(model->constraints().size(), "constraint", "constraints");
    if (!model->chains().empty())
        std::cout << ", " << counted(model->chains().size(), "chain", "chains") << list_chains(*model);
    std::cout << "\n  skin       " << counted(model->vertex_count(), "vertex", "vertices") << " in "
              << counted(model->pools().size(), "pool", "pools") << ", " << counted(triangles, "triangle", "triangles");
    if (most_influences != 0)
        std::cout << ", up to " << counted(most_influences, "influence", "influences") << " a vertex";
    if (model->collapse() != nullptr) {
        Lod lod(*model);
        lod.set_share(0.0f);
        std::cout << "\n  detail     from " << counted(triangles, "triangle", "triangles") << " down to "
                  << grouped(lod.triangles());
    }
    if (model->target_count() != 0) {
        std::cout << "\n  targets    " << grouped(model->target_count());
        const char* separator = ": ";
        for (const std::string_view name : targets) {
            if (name.empty()) continue;
            std::cout << separator << printable(name);
            separator = ", ";
        }
    }
    std::cout << "\n  cycles     " << grouped(model->cycles().size()) << list_cycles(*model);
    std::cout << "\n  surface    " << counted(model->materials().size(), "material", "materials") << ", "
              << counted(model->textures().size(), "texture", "textures") << '\n';
}

void run(ConvertArguments arguments) {
    if (arguments.output.empty()) arguments.output = std::filesystem::path(arguments.input).replace_extension(".bendy");
    converter::ConvertOptions options;
    if (!arguments.scene.empty()) options.gltf.scene = arguments.scene;
    options.gltf.embed_images = arguments.images == "embed";
    if (!arguments.rig.empty()) options.rig = arguments.rig;
    options.auto_rig = arguments.auto_rig;
    if (arguments.compact) options.compact = converter::ErrorBound();
    if (!arguments.max_error.empty()) options.compact = *converter::parse_error_bound(arguments.max_error);
    options.lod = arguments.lod;
    options.sort_vertices = arguments.sort_vertices;
    converter::Report report;
    const auto bytes = convert_with_bar(arguments, options, report);
    if (!bytes) {
        const converter::ImportError& error = bytes.error();
        fail(error.file.empty() ? arguments.input : error.file,
             printable(error.place.empty() ? error.message : error.place + ": " + error.message));
    }
    std::error_code ignored;
    if (std::filesystem::equivalent(arguments.input, arguments.output, ignored))
        fail(arguments.output, "is the input itself");
    if (const auto written = write_file(arguments.output, *bytes); !written)
        fail(arguments.output, describe(written.error()));
    print_warnings(arguments.input, report);
    print_proposals(report);
    if (!arguments.quiet) print_summary(arguments, *bytes);
    if (!arguments.quiet && report.compact) print_compact(*report.compact);
}

}  // namespace

void add_convert(CLI::App& program) {
    const auto arguments = std::make_shared<ConvertArguments>();
    CLI::App* command = program.add_subcommand("convert",
                                               "Convert a glTF 2.0 character (.gltf, .glb), an X-file (.x), a Quake II "
                                               "model (.md2) or a bendy file to a bendy file");
    command->add_option("IN", arguments->input, "a .gltf, .glb, .x, .md2 or bendy file, told apart by content")
        ->required();
    command->add_option("-o,--output", arguments->output, "where to write; the input's name with .bendy if not given");
    command->add_option("--scene", arguments->scene,
                        "the scene of a glTF file to take, by name or number; the file's default if not given");
    command
        ->add_option("--images", arguments->images,
                     "of glTF and X-files; embed: copy image files into the output; link: keep them as URIs")
        ->check(CLI::IsMember({"embed", "link"}))
        ->capture_default_str();
    command->add_option("--rig", arguments->rig,
                        "a rig file: joint constraints and IK chains, see spec/rig.md; `bendy rig` writes one");
    CLI::Option* exact =
        command->add_flag("--exact", arguments->exact, "every number as the source has it; this is the default");
    command->add_flag("--auto-rig", arguments->auto_rig,
                      "propose IK chains and joint limits by the joints' names, and list them");
    CLI::Option* compact =
        command
            ->add_flag(
                "--compact", arguments->compact,
                "encode for size; the error is measured and printed. 0.005% if --max-error does not say otherwise")
            ->excludes(exact);
    CLI::Option* max_error =
        command
            ->add_option("--max-error", arguments->max_error,
                         "how far a point of the skin may move: a length (0.1mm, 1cm, 50um, 0.001m) or a share of the "
                         "character's height (0.005%); implies --compact")
            ->check([](const std::string& text) {
                const auto bound = converter::parse_error_bound(text);
                return bound ? std::string() : bound.error();
            });
    CLI::Option* lod = command->add_flag(
        "--lod", arguments->lod,
        "compute levels of detail: the sequence in which vertices are collapsed; vertices are put in its order");
    command
        ->add_flag(
            "--sort-vertices", arguments->sort_vertices,
            "put vertices that follow the same bones beside one another: less work in every frame. Else they keep "
            "the source's order; --lod and --compact have orders of their own")
        ->excludes(lod)
        ->excludes(compact)
        ->excludes(max_error);
    command->add_flag("-q,--quiet", arguments->quiet, "no summary; warnings and errors only");
    command->footer(
        "Everything is kept exactly, but with --compact; what the format cannot hold is named in a warning.\n"
        "Example: bendy convert fox.glb -o build/fox.bendy");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::cli
