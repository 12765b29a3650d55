// bendy_bench_peers [--rounds N] SECTION [FILE...]: Bendy's runtime beside ozz-animation and cgltf, on the same
// characters, by turns in one process. docs/benchmarks.md says how the peers are set up; `run` prints the whole table.
#include "sections.h"

#include <bendy/runtime/kernels.h>

#include <charconv>
#include <cstddef>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace bendy::bench;
using bendy::Solver;

constexpr int kRounds = 41;

int print_usage() {
    std::fprintf(stderr,
                 "usage: bendy_bench_peers [--rounds N] SECTION [FILE...]\n"
                 "  check, sample, matrices, blend, skin, reach, crowd   FILE.bendy...\n"
                 "  packed                                               FILE.bendy COMPACT.bendy ...\n"
                 "  open                                                 FILE.bendy SOURCE.glb ...\n"
                 "  large, chains                                        no files\n"
                 "N is the largest number of rounds, %d unless it is given. BENDY_KERNEL selects our kernel.\n",
                 kRounds);
    return 2;
}

/// What a section does with each file, or with each two, or once without any.
struct Section {
    std::string_view name;
    std::size_t files = 1;
    void (*run)(Table& table, std::span<const std::string> files);
};

template <void (*Measure)(Table&, const Character&)>
void each(Table& table, std::span<const std::string> files) {
    Measure(table, *open_character(files.front()));
}

/// Leaves out characters without clips.
template <void (*Measure)(Table&, const Character&)>
void each_animated(Table& table, std::span<const std::string> files) {
    const auto character = open_character(files.front());
    if (character->is_animated()) Measure(table, *character);
}

constexpr Section kSections[] = {
    {"check", 1, [](Table&, std::span<const std::string> files) { print_difference(*open_character(files[0])); }},
    {"sample", 1, each_animated<measure_sampling>},
    {"matrices", 1, each<measure_matrices>},
    {"blend", 1, each_animated<measure_blending>},
    {"skin", 1, each<measure_skinning>},
    {"reach", 1, each_animated<measure_reaching>},
    {"crowd", 1, each_animated<measure_crowds>},
    {"packed", 2,
     [](Table& table, std::span<const std::string> files) {
         measure_packed(table, *open_character(files[0]), open_model(files[1]));
     }},
    {"open", 2, [](Table& table, std::span<const std::string> files) { measure_opening(table, files[0], files[1]); }},
    {"large", 0, [](Table& table, std::span<const std::string>) { measure_large(table); }},
    {"chains", 0,
     [](Table& table, std::span<const std::string>) {
         measure_chain(table, Solver::two_bone);
         measure_chain(table, Solver::aim);
     }},
};

const Section* find_section(std::string_view name) {
    for (const Section& section : kSections) {
        if (section.name == name) return &section;
    }
    return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::string> arguments(argv + 1, argv + argc);
    int rounds = kRounds;
    if (arguments.size() > 1 && arguments[0] == "--rounds") {
        const std::string& number = arguments[1];
        const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), rounds);
        if (error != std::errc() || end != number.data() + number.size() || rounds < 1) {
            std::fprintf(stderr, "bendy_bench_peers: --rounds %s: expected a whole number from 1 on\n", number.c_str());
            return 2;
        }
        arguments.erase(arguments.begin(), arguments.begin() + 2);
    }
    if (arguments.empty()) return print_usage();
    const Section* const section = find_section(arguments[0]);
    const std::span<const std::string> files = std::span(arguments).subspan(1);
    if (section == nullptr) {
        std::fprintf(stderr, "bendy_bench_peers: no section \"%s\"\n", arguments[0].c_str());
        return print_usage();
    }
    const bool is_right = section->files == 0 ? files.empty() : !files.empty() && files.size() % section->files == 0;
    if (!is_right) {
        constexpr const char* kExpected[] = {"no files", "one file or more", "pairs of files"};
        std::fprintf(stderr, "bendy_bench_peers: %s: expected %s\n", arguments[0].c_str(), kExpected[section->files]);
        return print_usage();
    }
    const std::string_view kernel = bendy::kernel_name(bendy::kernel());
    std::printf("%s, kernel %.*s\n\n", arguments[0].c_str(), static_cast<int>(kernel.size()), kernel.data());
    if (section->name != "check") Table::print_head();
    Table table(rounds);
    if (section->files == 0) section->run(table, {});
    for (std::size_t k = 0; k < files.size(); k += section->files)
        section->run(table, files.subspan(k, section->files));
    table.print_notes();
    return 0;
}
