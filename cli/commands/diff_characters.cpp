#include "commands/diff_characters.h"

#include "files/input.h"
#include "terminal/problem.h"
#include "terminal/progress.h"
#include "terminal/text.h"

#include <bendy/converter/compare_characters.h>
#include <bendy/converter/export.h>
#include <bendy/converter/import.h>
#include <bendy/diff/compare_files.h>

#include <nlohmann/json.hpp>

#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>

namespace bendy::cli {
namespace {

using Json = nlohmann::ordered_json;
using converter::CharacterComparison;
using converter::CharacterDifference;

struct ComparedCharacter {
    converter::Scene scene;
    std::string rig;  // as a rig file
};

ComparedCharacter read_compared(const std::filesystem::path& path) {
    const InputBytes file = open_bendy_file(path);
    converter::Report report;
    auto scene = converter::import_bendy(file.bytes(), report);
    if (!scene) fail(path, printable(scene.error().message));
    for (const converter::Warning& warning : report.warnings()) {
        const std::string place = warning.first_place.empty() ? "" : warning.first_place + ": ";
        warn(path, printable("not compared: " + place + warning.message));
    }
    return {*std::move(scene), converter::write_rig(diff::read_file(file.bytes())->document.objects.front(), false)};
}

/// Three digits, in millimetres where that is not too many.
std::string length_text(double metres) {
    constexpr double kMillimetres = 1e3;
    std::ostringstream text;
    text << std::setprecision(3);
    if (metres < 1.0) {
        text << metres * kMillimetres << " mm";
    } else {
        text << metres << " m";
    }
    return text.str();
}

std::string three_digits(double number) {
    std::ostringstream text;
    text << std::setprecision(3) << number;
    return text.str();
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
    std::cout << "tolerance " << length_text(comparison.tolerance) << "; worst measured "
              << length_text(comparison.worst);
    if (!comparison.worst_place.empty()) std::cout << ": " << printable(comparison.worst_place);
    std::cout << '\n';
    for (const converter::LookDifference& look : comparison.looks) {
        if (look.apart == 0.0) continue;
        std::cout << "  " << printable(look.place) << ": up to " << three_digits(look.apart)
                  << (look.unit.empty() ? "" : ' ' + look.unit) << " apart, of " << three_digits(look.allowed)
                  << " allowed\n";
    }
}

Json to_json(const std::array<std::filesystem::path, 2>& files, const CharacterComparison& comparison) {
    constexpr std::array kKinds{"onlyInA", "onlyInB", "value", "distance"};
    Json report{{"a", files[0].string()},
                {"b", files[1].string()},
                {"same", comparison.differences.empty()},
                {"tolerance", comparison.tolerance},
                {"unit", "metres"},
                {"worst", comparison.worst},
                {"worstPlace", comparison.worst_place}};
    Json looks = Json::array();
    for (const converter::LookDifference& look : comparison.looks)
        looks.push_back({{"place", look.place}, {"apart", look.apart}, {"allowed", look.allowed}, {"unit", look.unit}});
    report["looks"] = std::move(looks);
    Json list = Json::array();
    for (const CharacterDifference& difference : comparison.differences) {
        Json entry{{"kind", kKinds[static_cast<std::size_t>(difference.kind)]}, {"place", difference.place}};
        if (!difference.what.empty()) entry["what"] = difference.what;
        if (difference.kind == CharacterDifference::Kind::distance) entry["metres"] = difference.metres;
        list.push_back(std::move(entry));
    }
    report["differences"] = std::move(list);
    report["differencesLeftOut"] = comparison.left_out;
    return report;
}

}  // namespace

bool are_characters_alike(const std::array<std::filesystem::path, 2>& files, const converter::ErrorBound& tolerance,
                          bool as_json) {
    const ComparedCharacter a = read_compared(files[0]);
    const ComparedCharacter b = read_compared(files[1]);
    CharacterComparison comparison;
    {
        ProgressBar bar("comparing");
        std::uint64_t shown = 0;
        comparison = converter::compare_characters(a.scene, b.scene, tolerance, [&](double share) {
            const auto percent = static_cast<std::uint64_t>(100.0 * share);
            if (percent > shown) bar.show(shown = percent, 100);
        });
    }
    if (comparison.gave_up) {
        fail(files[0], "too many polygons lie within " + length_text(comparison.tolerance) +
                           " of one another; a smaller tolerance can tell them apart");
    }
    if (a.rig != b.rig) {
        comparison.differences.push_back(
            {CharacterDifference::Kind::value, "rig", "constraints or IK chains differ; `bendy rig` writes them", 0.0});
    }
    if (as_json) {
        std::cout << to_json(files, comparison).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
    } else {
        print_text(comparison);
    }
    return comparison.differences.empty();
}

}  // namespace bendy::cli
