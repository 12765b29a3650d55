#include "choices.h"
#include "commands/commands.h"
#include "commands/model_options.h"
#include "convert/batch.h"
#include "convert/depfile.h"
#include "files/input.h"
#include "files/output.h"
#include "files/progress.h"
#include "reports/console.h"
#include "reports/conversion.h"
#include "reports/json.h"
#include "reports/messages.h"
#include "reports/summary.h"

#include <bendy/converter/convert.h>
#include <bendy/converter/source_format.h>
#include <bendy/runtime.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <iomanip>
#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace bendy::tools {
namespace {

/// The files of the input whose bytes are in the output.
void print_embedded(const std::vector<converter::EmbeddedFile>& files, std::ostream& out) {
    for (const converter::EmbeddedFile& file : files) {
        out << "  embedded       " << printable(file.file.string()) << " (" << grouped(file.size) << " bytes"
            << (file.media_type.empty() ? "" : ", " + file.media_type) << ")\n";
    }
}

/// Bytes by kind before and after, and the worst error.
void print_compact(const converter::CompactReport& report, std::ostream& out) {
    std::uint64_t before = 0;
    std::uint64_t after = 0;
    const auto print_line = [&out](std::string_view kind, std::uint64_t exact, std::uint64_t compact) {
        out << "  " << std::left << std::setw(19) << kind << std::right << std::setw(14) << grouped(exact)
            << std::setw(14) << grouped(compact) << '\n';
    };
    out << "  bytes                       exact       compact\n";
    for (std::size_t k = 0; k < report.compact.size(); ++k) {
        before += report.exact[k].bytes;
        after += report.compact[k].bytes;
        if (report.exact[k].bytes + report.compact[k].bytes != 0)
            print_line(kind_in_words(report.compact[k].kind), report.exact[k].bytes, report.compact[k].bytes);
    }
    print_line("total", before, after);
    if (report.lod_bytes) {
        const std::int64_t bytes = *report.lod_bytes;
        out << "  levels         cost " << (bytes < 0 ? "-" : "")
            << grouped(static_cast<std::uint64_t>(std::abs(bytes)))
            << " of these bytes in all: their order of vertices compresses less\n";
    }
    constexpr double kMillimetres = 1e3;
    out << std::setprecision(3) << "  error          at most " << report.max_error * kMillimetres
        << " mm; worst measured " << report.measured_error * kMillimetres << " mm";
    if (!report.place.empty()) out << ": " << printable(report.place);
    out << '\n';
    if (report.curves == 0) return;
    constexpr double kPercent = 100.0;
    out << "  curves         " << report.packed_curves << " of " << report.curves << " packed";
    if (report.packed_curves != 0)
        out << "; largest error " << report.curve_error * kPercent << " % of the range of values";
    out << '\n';
}

/// Calls converter::convert for a file, or for standard input if the name is a dash. A rig file may be a dash too. If
/// standard input cannot be read, prints the error and throws Failed.
Result<std::vector<std::byte>, converter::ImportError> convert_input(const std::filesystem::path& input,
                                                                     converter::ConvertOptions options,
                                                                     converter::Report& report) {
    const std::filesystem::path name = "standard input";
    if (options.rig && is_dash(*options.rig)) {
        const InputBytes rig = InputBytes::read(*options.rig);
        options.rig_text = std::string(as_text(rig.bytes()));
        options.rig = name;
    }
    if (!is_dash(input)) return converter::convert(input, options, report);
    return converter::convert(InputBytes::read(input).take(), name, options, report);
}

auto convert_with_progress(const ConvertArguments& arguments, converter::ConvertOptions options,
                           converter::Report& report) {
    const std::filesystem::path& input = arguments.inputs.front();
    LiveProgress progress("converting " + shown_name(input.filename()), !arguments.quiet);
    options.output = is_dash(arguments.output) ? "standard output" : arguments.output;
    options.progress = [&](double share) { progress.set(share); };
    return convert_input(input, options, report);
}

void print_summary(const ConvertArguments& arguments, Bytes bytes, bool with_bytes_by_kind) {
    const Model model = read_model(output_name(arguments.output), bytes);
    const Stream stream = is_dash(arguments.output) ? Stream::error : Stream::output;
    summary_stream(arguments.output) << summary_as_text(summarize(model, bytes), output_name(arguments.output),
                                                        columns_of(stream), with_bytes_by_kind);
}

/// The sources that exist, as a rule for Make and Ninja.
std::string depfile_of(const ConvertArguments& arguments, const converter::Report& report) {
    std::vector<std::string> sources;
    for (const converter::SourceFile& source : report.sources()) {
        if (source.stamp.is_there) sources.push_back(source.file.generic_string());
    }
    auto rule = depfile_text(arguments.output.generic_string(), sources);
    if (!rule) {
        fail(output_name(arguments.depfile), "cannot hold the file name " +
                                                 converter::quoted_for_shell(escaped(rule.error().name)) +
                                                 ": Make or Ninja would misread it");
    }
    return *std::move(rule);
}

/// \returns the number of bytes written
std::vector<std::byte> convert_and_write(const ConvertArguments& arguments, NamedBy named, converter::Report& report) {
    const std::filesystem::path& input = arguments.inputs.front();
    if (named == NamedBy::user) require_folder_of(arguments.output);  // otherwise it is the input's
    require_folder_of(arguments.depfile);
    Outputs outputs(arguments.force);
    outputs.reads(input);
    if (!arguments.rig.empty()) outputs.reads(arguments.rig);
    if (!arguments.texture.empty()) outputs.reads(arguments.texture);
    outputs.writes(arguments.output, named, Content::binary);
    check_suffix({"convert", "--output", {".bendy"}}, input, arguments.output);
    if (!arguments.depfile.empty()) outputs.writes(arguments.depfile, NamedBy::user, Content::text);
    auto bytes = convert_with_progress(arguments, options_of(arguments), report);
    if (!bytes) fail(file_of(bytes.error(), input), describe(bytes.error()));
    for (const converter::SourceFile& source : report.sources()) outputs.reads(source.file);
    if (arguments.depfile.empty()) {
        outputs.write(arguments.output, *bytes);
    } else {
        const std::string rule = depfile_of(arguments, report);
        const std::array<FileContents, 2> files{{{arguments.output, *bytes}, {arguments.depfile, as_byte_span(rule)}}};
        outputs.write(files);
    }
    return *std::move(bytes);
}

void convert_file(const ConvertArguments& arguments, NamedBy named) {
    const std::filesystem::path& input = arguments.inputs.front();
    converter::Report report;
    if (arguments.json) {
        try {
            const std::vector<std::byte> bytes = convert_and_write(arguments, named, report);
            print_report(converted_report(input, arguments.output, report, bytes));
        } catch (const Failed& failed) {
            print_report(failed_report(input, arguments.output, report, failed.file, failed.what));
            throw;
        }
        return;
    }
    const std::vector<std::byte> bytes = convert_and_write(arguments, named, report);
    print_warnings(input, report);
    if (!arguments.quiet) print_proposals(input, report, arguments.verbose);
    if (!arguments.quiet) print_summary(arguments, bytes, !report.compact);
    if (!arguments.quiet) print_embedded(report.embedded(), summary_stream(arguments.output));
    if (!arguments.quiet && report.compact) print_compact(*report.compact, summary_stream(arguments.output));
}

/// Fails if one run cannot do what is asked of standard input, standard output and the names.
void check_names(const ConvertArguments& arguments, bool is_many) {
    if (is_many && is_dash(arguments.rig))
        throw CLI::ValidationError("--rig", "goes to standard input only with one input");
    if (is_many) check_batch(arguments.inputs, arguments.output);
    const bool takes_output = is_dash(arguments.output) || is_dash(arguments.depfile);
    if (arguments.json && takes_output)
        throw CLI::ValidationError("--json", "goes to standard output, and so does a file: give that a name");
    if (!arguments.depfile.empty() && is_dash(arguments.output))
        throw CLI::ValidationError("--depfile", "goes with an output that has a name");
    if (const auto format = format_named_by(arguments.depfile); !format.empty()) {
        throw CLI::ValidationError("--depfile", escaped(arguments.depfile.string()) + " would be " +
                                                    std::string(format) + ", not a rule for Make");
    }
}

void run(ConvertArguments arguments) {
    const std::filesystem::path& input = arguments.inputs.front();
    const NamedBy named = arguments.output.empty() ? NamedBy::program : NamedBy::user;
    const bool is_many = is_batch(arguments.inputs, arguments.output);
    if (arguments.output.empty() && !is_many)
        arguments.output = is_dash(input) ? input : std::filesystem::path(input).replace_extension(".bendy");
    check_names(arguments, is_many);
    if (!is_many) return convert_file(arguments, named);
    if (!arguments.depfile.empty())
        throw CLI::ValidationError("--depfile", "goes with one input and the file that it becomes, not with a folder");
    convert_batch(arguments);
}

/// The options of convert_options.def, and --exact.
void add_options(CLI::App& command, ConvertArguments& arguments) {
    std::map<std::string, CLI::Option*, std::less<>> added;  // CLI11's own look-up aborts if memory runs out
    visit_options(arguments, [&](const ConvertOption& option, auto& value) {
        CLI::Option*& place = added[std::string(option.name)];
        if (option.name == "root") {
            place = add_root(command, arguments.root);
        } else if constexpr (std::is_same_v<std::decay_t<decltype(value)>, option::flag>) {
            place = command.add_flag(option.flag(), value, option.full_help());
        } else {
            place = command.add_option(option.flag(), value, option.full_help());
            if (!option.values.empty()) place->check(one_of(words_of(option.values)))->capture_default_str();
        }
        if (!option.group.empty()) place->group(std::string(option.group));
    });
    added["exact"] = command.add_flag("--exact", arguments.exact, "keep every number exactly; this is the default")
                         ->group("What is kept");
    visit_options(arguments, [&](const ConvertOption& option, const auto&) {
        for (const std::string& other : words_of(option.excludes))
            added.at(std::string(option.name))->excludes(added.at(other));
    });
    for (const char* name : {"ticks_per_second", "unit"}) added.at(name)->check(CLI::PositiveNumber);
    added.at("max_error")->check([](const std::string& text) {
        const auto bound = converter::parse_error_bound(text);
        return bound ? std::string() : bound.error();
    });
}

}  // namespace

void add_convert(CLI::App& program) {
    const auto arguments = std::make_shared<ConvertArguments>();
    const std::string extensions = converter::list_readable_suffixes();
    CLI::App* command =
        program.add_subcommand("convert", "Convert characters (" + extensions + "), or bendy files, to bendy files");
    command
        ->add_option("IN", arguments->inputs,
                     "a file (" + extensions +
                         ", or a bendy file), told apart by content; or several, or folders: all such files "
                         "in them and below, bendy files apart")
        ->required();
    command->add_option("-o,--output", arguments->output,
                        "where to write; the input's name with .bendy if not given. For several inputs or a folder, "
                        "the folder to write to: it is created if need be, and files from a folder keep their places "
                        "in it; beside each input if not given");
    add_options(*command, *arguments);
    command->add_flag("--force", arguments->force,
                      "overwrite outputs that bendy did not write (with -o FILE that is always allowed); with several "
                      "inputs, also convert files that have not changed");
    CLI::Option* const quiet =
        command->add_flag("-q,--quiet", arguments->quiet, "no summary; warnings and errors only");
    command
        ->add_flag("-v,--verbose", arguments->verbose,
                   "list everything that --auto-rig and --auto-skin propose, one line each")
        ->excludes(quiet);
    constexpr const char* kMany = "Several files, scripts and build systems";
    command
        ->add_option("-j,--jobs", arguments->jobs,
                     "with several inputs, how many to convert at a time; with one and --compact, how many threads "
                     "to use, which does not change the output; one per processor if not given")
        ->check(CLI::Range(1u, 1024u))
        ->group(kMany);
    command
        ->add_flag("--json", arguments->json,
                   "print one JSON object per input, each on one line, instead of the summary and warnings")
        ->group(kMany);
    command
        ->add_option("--depfile", arguments->depfile,
                     "for a single input: write the files that were read as a rule for Make or Ninja")
        ->group(kMany);
    command->footer(
        "Everything is kept exactly, unless you use --compact. A warning names what the format cannot store.\nExample: "
        "bendy convert fox.glb -o build/fox.bendy\n         bendy convert *.glb\n         bendy convert models/ -o "
        "build/models --compact");
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::tools
