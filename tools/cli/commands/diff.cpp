#include "commands/commands.h"
#include "commands/model_options.h"
#include "files/input.h"
#include "files/output.h"
#include "files/progress.h"
#include "files/signals.h"
#include "reports/differences.h"
#include "reports/json.h"
#include "reports/messages.h"

#include <bendy/converter/compare_characters.h>
#include <bendy/converter/error_bound.h>
#include <bendy/diff/compare_files.h>
#include <bendy/format/diagnostics.h>

#include <array>
#include <charconv>
#include <exception>
#include <iomanip>
#include <iostream>
#include <memory>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

namespace bendy::tools {
namespace {

using converter::CharacterComparison;
using converter::CharacterDifference;
using diff::Difference;
using diff::Differences;
using diff::ReadFile;
using Kind = Difference::Kind;

constexpr int kDiffers = 1;
constexpr int kTrouble = 2;  // as in diff(1), unlike the other commands

struct DiffArguments {
    std::array<std::filesystem::path, 2> files;
    std::optional<converter::ErrorBound> bound;  // for positions; without one, chunks are compared
    std::filesystem::path root;
    bool json = false;
};

/// The shortest digits that read back to the same number, as the float that it was in the file.
std::string number_text(double number) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<float>(number)).ptr;
    return {digits.data(), end};
}

std::string scalar_text(const diff::Scalar& scalar) {
    if (const auto* text = std::get_if<std::string>(&scalar)) return '"' + brief(*text) + '"';
    if (const auto* number = std::get_if<double>(&scalar)) return number_text(*number);
    if (const auto* whole = std::get_if<std::uint64_t>(&scalar)) return std::to_string(*whole);
    if (const auto* truth = std::get_if<bool>(&scalar)) return *truth ? "true" : "false";
    return "none";
}

/// A record's field: one value or a list of them.
std::string value_text(const diff::Value& value) {
    std::string text;
    for (const diff::Scalar& item : value.items) text += (text.empty() ? "" : " ") + scalar_text(item);
    return text;
}

/// "3 of 300 numbers differ, by up to 0.25; the first: element 4, component 1: 0 -> 0.25".
std::string numbers_text(const Difference& difference) {
    std::string text = grouped(difference.count) + " of " + grouped(difference.of) + " numbers differ, by up to " +
                       number_text(difference.largest) + "; the first: element " +
                       std::to_string(difference.first_element);
    if (difference.first_component != 0) text += ", component " + std::to_string(difference.first_component);
    return text + ": " + value_text(difference.a_value) + " -> " + value_text(difference.b_value);
}

std::string bytes_text(const Difference& difference) {
    std::string text = grouped(difference.count) + " of " + grouped(difference.of) + " bytes differ, the first at " +
                       std::to_string(difference.first_element);
    if (difference.a_value != difference.b_value)
        text += "; " + value_text(difference.a_value) + " bytes -> " + value_text(difference.b_value);
    return text;
}

std::string what_text(const Difference& difference) {
    std::string text = difference.part.empty() ? "" : difference.part + ": ";
    switch (difference.kind) {
        case Kind::only_in_a:
            return text + "only in A";
        case Kind::only_in_b:
            return text + "only in B";
        case Kind::order:
            return text + "is in another order";
        case Kind::value:
            return text + value_text(difference.a_value) + " -> " + value_text(difference.b_value);
        case Kind::numbers:
            return text + numbers_text(difference);
        case Kind::bytes:
            return text + bytes_text(difference);
        case Kind::storage:
            return text + "the same content, stored differently";
    }
    return text;
}

void print_lines(const ReadFile& a, const ReadFile& b, const Differences& differences) {
    for (const Difference& difference : differences.list()) {
        const auto& [here, there] = difference.chunks;
        const bool only_in_b = here == kNone;
        const ReadFile& file = only_in_b ? b : a;
        const std::uint32_t chunk = only_in_b ? there : here;
        const std::string path = chunk_path(file.tree.bytes(), file.tree[chunk].offset);
        const char mark = difference.kind == Kind::only_in_a ? '-' : difference.kind == Kind::only_in_b ? '+' : '!';
        std::string line = std::string(1, mark) + ' ' + path;
        if (const std::string name = name_around(file.tree, chunk); !name.empty()) line += " \"" + brief(name) + '"';
        if (here != kNone && there != kNone) {
            const std::string other = chunk_path(b.tree.bytes(), b.tree[there].offset);
            if (other != path) line += " (in B: " + other + ')';
        }
        std::cout << line << ": " << printable(what_text(difference)) << '\n';
    }
    if (differences.left_out() != 0) std::cout << grouped(differences.left_out()) << " more differences\n";
}

/// Refuses a damaged file before anything is compared: its sums would be meaningless.
std::unique_ptr<ReadFile> open(const std::filesystem::path& path, const CharacterFile& file) {
    const Faults faults = validate(file.bytes());
    if (!faults.empty()) fail(path, faults.list().front(), file.bytes());
    return diff::read_file(file.bytes());
}

ComparedCharacter open_compared(const std::filesystem::path& path, const std::filesystem::path& root) {
    Outputs outputs;
    const CharacterFile file = open_character(path, root, outputs);
    converter::Report report;
    auto character = read_compared(file.bytes(), report);
    if (!character) fail(path, printable(character.error().message));
    for (const converter::Warning& warning : report.warnings()) {
        const std::string place = warning.first_place.empty() ? "" : warning.first_place + ": ";
        warn(path, printable("not compared: " + place + warning.message));
    }
    return *std::move(character);
}

std::string three_digits(double number) {
    std::ostringstream text;
    text << std::setprecision(3) << number;
    return text.str();
}

/// In millimetres, unless there are too many.
std::string length_text(double metres) {
    constexpr double kMillimetres = 1e3;
    return metres < 1.0 ? three_digits(metres * kMillimetres) + " mm" : three_digits(metres) + " m";
}

void print_line(const CharacterDifference& difference) {
    const bool is_lone = difference.kind == CharacterDifference::Kind::only_in_a ||
                         difference.kind == CharacterDifference::Kind::only_in_b;
    const char mark = difference.kind == CharacterDifference::Kind::only_in_a   ? '-'
                      : difference.kind == CharacterDifference::Kind::only_in_b ? '+'
                                                                                : '!';
    std::string what = difference.what;
    if (is_lone) what += std::string(what.empty() ? "" : ", ") + (mark == '-' ? "only in A" : "only in B");
    if (difference.kind == CharacterDifference::Kind::distance) what = length_text(difference.metres) + " apart";
    std::cout << mark << ' ' << printable(difference.place) << ": " << printable(what) << '\n';
}

void print_text(const CharacterComparison& comparison) {
    for (const CharacterDifference& difference : comparison.differences) print_line(difference);
    if (comparison.left_out != 0) std::cout << grouped(comparison.left_out) << " more differences\n";
    std::cout << "tolerance " << length_text(comparison.tolerance) << "; "
              << (comparison.worst ? "worst measured " + length_text(*comparison.worst)
                                   : "not measured: the skeletons differ");
    if (!comparison.worst_place.empty()) std::cout << ": " << printable(comparison.worst_place);
    std::cout << '\n';
    for (const converter::LookDifference& look : comparison.looks) {
        if (look.apart == 0.0) continue;
        std::cout << "  " << printable(look.place) << ": up to " << three_digits(look.apart)
                  << (look.unit.empty() ? "" : ' ' + look.unit) << " apart, of " << three_digits(look.allowed)
                  << " allowed\n";
    }
}

/// Compares the content of two bendy files; prints what differs by more than the tolerance, and the largest distance
/// found. Returns true if nothing differs. Throws Failed if a file is bad, or if the tolerance is too large to
/// distinguish anything.
bool are_characters_alike(const DiffArguments& arguments, const converter::ErrorBound& tolerance) {
    const auto& files = arguments.files;
    const ComparedCharacter a = open_compared(files[0], arguments.root);
    const ComparedCharacter b = open_compared(files[1], arguments.root);
    CharacterComparison comparison;
    {
        ProgressBar bar("comparing");
        std::uint64_t shown = 0;
        comparison = compare_characters(a, b, tolerance, [&](double share) {
            const auto percent = static_cast<std::uint64_t>(100.0 * share);
            if (percent > shown) bar.show(shown = percent, 100);
        });
    }
    if (comparison.gave_up) {
        fail(files[0], "too many polygons lie within " + length_text(comparison.tolerance) +
                           " of one another; a smaller tolerance can tell them apart");
    }
    if (arguments.json) {
        print_report(comparison_as_json(files[0].string(), files[1].string(), comparison), 2);
    } else {
        print_text(comparison);
    }
    return comparison.differences.empty();
}

bool are_same(const DiffArguments& arguments) {
    if (arguments.bound) return are_characters_alike(arguments, *arguments.bound);
    Outputs outputs;
    const auto open_one = [&](const std::filesystem::path& path) {
        return open_character(path, arguments.root, outputs);
    };
    const std::array files{open_one(arguments.files[0]), open_one(arguments.files[1])};
    std::array<std::unique_ptr<ReadFile>, 2> read;
    for (std::size_t i = 0; i < 2; ++i) read[i] = open(arguments.files[i], files[i]);
    const Differences differences = diff::compare_files(*read[0], *read[1]);
    if (arguments.json) {
        print_report(differences_as_json(arguments.files[0].string(), arguments.files[1].string(), *read[0], *read[1],
                                         differences),
                     2);
    } else {
        print_lines(*read[0], *read[1], differences);
    }
    return differences.count() == 0;
}

void run(const DiffArguments& arguments) {
    bool same = false;
    set_status_of_failures(kTrouble);
    try {
        same = are_same(arguments);
        std::cout.flush();
        if (!std::cout) fail("standard output", "cannot be written");
    } catch (const Failed&) {
        throw Failed{kTrouble};
    } catch (const diff::TooMuchToCompare&) {
        std::cerr << error_label() << shown_name(arguments.files[0])
                  << ": tracks share more keys than can be compared\n";
        throw Failed{kTrouble};
    } catch (const std::bad_alloc&) {
        throw;  // the program says so, and ends with the status of failures
    } catch (const std::exception& problem) {
        std::cerr << error_label() << printable(problem.what()) << '\n';
        throw Failed{kTrouble};
    }
    if (!same) throw Failed{kDiffers};
}

}  // namespace

void add_diff(CLI::App& program) {
    const auto arguments = std::make_shared<DiffArguments>();
    const auto tolerance = std::make_shared<std::string>();
    CLI::App* command = program.add_subcommand(
        "diff", "Show the differences between two files, chunk by chunk, or between the characters in them");
    command
        ->add_option("A", arguments->files[0],
                     "a bendy file, or one that `bendy convert` reads, which is converted on the fly")
        ->required();
    command->add_option("B", arguments->files[1], "another")->required();
    add_root(*command, arguments->root);
    CLI::Option* given =
        command->add_option("--tolerance", *tolerance,
                            "compare the characters instead of the chunks, for example an exact file with its compact "
                            "version: the largest distance by which a point of the skin may differ in any clip, as a "
                            "length (0.1mm) or a share of the height (0.005%)");
    command->add_flag("--json", arguments->json, "print a JSON report");
    command->footer(
        "Exits with 0 if the files are the same, 1 if they differ, and 2 if a file is invalid or the command line is "
        "wrong.\nExample: bendy diff fox.bendy build/fox.bendy\nExample: bendy diff fox.bendy compact.bendy "
        "--tolerance 0.005%");
    command->callback([arguments, tolerance, given] {
        if (given->count() != 0) {
            const auto bound = converter::parse_error_bound(*tolerance);
            if (!bound) throw CLI::ValidationError("--tolerance", bound.error());
            arguments->bound = *bound;
        }
        run(*arguments);
    });
}

}  // namespace bendy::tools
