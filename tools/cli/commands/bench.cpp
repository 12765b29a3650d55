#include "choices.h"
#include "commands/commands.h"
#include "commands/model_options.h"
#include "files/input.h"
#include "files/progress.h"
#include "reports/json.h"
#include "reports/messages.h"

#include <bendy/runtime.h>
#include <bendy/runtime/kernels.h>
#include <bendy/stages/stages.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>

namespace bendy::tools {
namespace {

struct BenchArguments {
    std::filesystem::path file;
    std::vector<std::string> kernels;
    std::string clip;
    int rounds = 41;
    bool json = false;
};

std::vector<std::string> names_of(std::span<const Kernel> kernels) {
    std::vector<std::string> names;
    for (const Kernel kernel : kernels) names.emplace_back(kernel_name(kernel));
    return names;
}

/// The names of all kernels, including those that this machine lacks, so that the help is the same everywhere.
std::vector<std::string> kernel_names() {
    using enum Kernel;
    return names_of(std::array{plain, sse4, avx2, neon, wasm});
}

/// Returns why a kernel's name is not usable; empty if this machine has the kernel.
std::string check_kernel(const std::string& name) {
    const std::vector<std::string> here = names_of(kernels());
    if (std::find(here.begin(), here.end(), name) != here.end()) return {};
    return name + " does not run here; these do: " + CLI::detail::join(here, ", ");
}

std::vector<Kernel> chosen_kernels(const BenchArguments& arguments) {
    std::vector<Kernel> chosen;
    for (const Kernel kernel : kernels()) {
        const auto& names = arguments.kernels;
        if (std::find(names.begin(), names.end(), kernel_name(kernel)) != names.end()) chosen.push_back(kernel);
    }
    if (chosen.empty()) chosen.push_back(kernel());
    return chosen;
}

/// Nanoseconds per item, over the rounds.
struct Timing {
    double median = 0.0;
    double least = 0.0;
};

double median_of(std::vector<double> numbers) {
    std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2), numbers.end());
    return numbers[numbers.size() / 2];
}

/// One Timing per kernel. Other programs use the machine too, so the kernels take turns. A turn takes about two
/// milliseconds, or one run if that is longer; if a round takes longer than a tenth of a second, there are fewer
/// rounds, at least 5.
std::vector<Timing> time_stage(const stages::Stage& stage, const std::vector<Kernel>& kernels, int rounds) {
    using Clock = std::chrono::steady_clock;
    const auto nanoseconds = [&stage](Kernel kernel, std::size_t times) {
        const auto start = Clock::now();
        for (std::size_t k = 0; k < times; ++k) {
            (void)set_kernel(kernel);
            stage.run();
        }
        return std::chrono::duration<double, std::nano>(Clock::now() - start).count() / static_cast<double>(times);
    };
    std::vector<std::size_t> times;
    double round_time = 0.0;
    for (const Kernel kernel : kernels) {
        nanoseconds(kernel, 1);  // warms up
        const double once = nanoseconds(kernel, 1);
        times.push_back(static_cast<std::size_t>(std::max(1.0, 2e6 / once)));
        round_time += std::max(2e6, once);
    }
    constexpr double kLong = 1e8;  // nanoseconds
    constexpr int kFewest = 5;
    if (round_time > kLong) rounds = std::min(rounds, std::max(kFewest, static_cast<int>(rounds * kLong / round_time)));
    std::vector<std::vector<double>> taken(kernels.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t k = 0; k < kernels.size(); ++k)
            taken[k].push_back(nanoseconds(kernels[k], times[k]) / stage.items);
    }
    std::vector<Timing> timings;
    timings.reserve(taken.size());
    for (const std::vector<double>& own : taken)
        timings.push_back({median_of(own), *std::min_element(own.begin(), own.end())});
    return timings;
}

/// Formats a duration with three digits and a unit.
std::string brief_time(double nanoseconds) {
    constexpr std::array kUnits{"ns", "us", "ms", "s"};
    std::size_t unit = 0;
    for (; nanoseconds >= 1000.0 && unit + 1 < kUnits.size(); ++unit) nanoseconds /= 1000.0;
    std::array<char, 32> text{};
    const int decimals = nanoseconds < 10.0 ? 2 : nanoseconds < 100.0 ? 1 : 0;
    std::snprintf(text.data(), text.size(), "%.*f %s", decimals, nanoseconds, kUnits.at(unit));
    return text.data();
}

struct Row {
    const stages::Stage* stage;
    std::vector<Timing> timings;  // one per kernel
};

std::string padded(std::string text, std::size_t width) {
    if (text.size() < width) text.insert(0, width - text.size(), ' ');
    return text;
}

void print_page(const BenchArguments& arguments, const Model& model, const Clip* clip,
                const std::vector<Kernel>& kernels, const std::vector<Row>& rows) {
    std::cout << shown_name(arguments.file.filename()) << ": " << grouped(model.joints().size()) << " joints, "
              << grouped(model.vertex_count()) << " vertices, " << grouped(model.morph_target_count()) << " targets";
    if (clip != nullptr) std::cout << "; clip \"" << printable(clip->name) << '"';
    std::cout << "\none thread; median of " << arguments.rounds << " turns (and the shortest)\n\n"
              << std::string(36, ' ');
    constexpr std::size_t kWidth = 22;
    for (const Kernel kernel : kernels) std::cout << padded(std::string(kernel_name(kernel)), kWidth);
    std::cout << '\n';
    for (const Row& row : rows) {
        std::string name = row.stage->name;
        name.resize(std::max<std::size_t>(name.size(), 36), ' ');
        std::cout << name;
        for (const Timing& timing : row.timings)
            std::cout << padded(brief_time(timing.median) + " (" + brief_time(timing.least) + ')', kWidth);
        std::cout << "  a " << row.stage->item << '\n';
    }
}

void print_json(const BenchArguments& arguments, const Model& model, const Clip* clip,
                const std::vector<Kernel>& kernels, const std::vector<Row>& rows) {
    Json stages = Json::array();
    for (const Row& row : rows) {
        Json times = Json::object();
        for (std::size_t k = 0; k < kernels.size(); ++k) {
            times[std::string(kernel_name(kernels[k]))] = {{"medianNs", row.timings[k].median},
                                                           {"leastNs", row.timings[k].least}};
        }
        stages.push_back(
            {{"name", row.stage->name}, {"item", row.stage->item}, {"items", row.stage->items}, {"perItem", times}});
    }
    const Json report = {{"file", arguments.file.string()},
                         {"joints", model.joints().size()},
                         {"vertices", model.vertex_count()},
                         {"targets", model.morph_target_count()},
                         {"clip", clip == nullptr ? Json() : Json(clip->name)},
                         {"rounds", arguments.rounds},
                         {"stages", stages}};
    print_report(report, 2);
}

void run(const BenchArguments& arguments) {
    const InputBytes file = open_bendy_file(arguments.file, Storage::copied);
    const Model model = read_valid_model(arguments.file, file.bytes());
    const Clip* clip = model.clips().empty() ? nullptr : model.clips().data();
    if (!arguments.clip.empty()) clip = &find_clip(arguments.clip, arguments.file, model);

    const std::vector<Kernel> kernels = chosen_kernels(arguments);
    const auto open = [&](const OpenOptions& options) {
        return is_dash(arguments.file) ? Model::from_memory(file.bytes(), options)
                                       : Model::open(arguments.file, options);
    };
    const stages::Stages steps(open, model, clip);
    std::vector<Row> rows;
    {
        ProgressBar bar("measuring");
        for (const stages::Stage& stage : steps.list()) {
            bar.show(rows.size(), steps.list().size());
            rows.push_back({&stage, time_stage(stage, kernels, arguments.rounds)});
        }
    }
    (arguments.json ? print_json : print_page)(arguments, model, clip, kernels, rows);
}

}  // namespace

void add_bench(CLI::App& program) {
    const auto arguments = std::make_shared<BenchArguments>();
    CLI::App* command =
        program.add_subcommand("bench", "Measure the cost of each step, from opening a file to its vertices");
    command->add_option("FILE", arguments->file, "a bendy file")->required();
    command
        ->add_option("--kernel", arguments->kernels,
                     "the kernel to measure, if the machine supports it; may be repeated, and the kernels then run in "
                     "turn; the fastest if not given")
        ->check(one_of(kernel_names()))
        ->check(check_kernel)
        ->allow_extra_args(false);
    command->add_option("--clip", arguments->clip,
                        "the clip to play, " + std::string(kByKey) + "; the first if not given");
    command->add_option("--rounds", arguments->rounds, "measurements of about 2 ms per step")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    command->add_flag("--json", arguments->json, "print a JSON report, in nanoseconds");
    command->footer(
        "Times are for one joint, vertex, ... on one thread, with everything in the caches. Other programs disturb\n"
        "them: compare what was measured by turns, in one run.\n"
        "Example: bendy bench fox.bendy\n"
        "         bendy bench fox.bendy --clip Run --kernel plain --kernel " +
        std::string(kernel_name(kernels().front())));
    command->callback([arguments] { run(*arguments); });
}

}  // namespace bendy::tools
