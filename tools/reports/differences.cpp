#include "reports/differences.h"

#include <bendy/converter/export.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>

#include <array>
#include <type_traits>
#include <utility>
#include <variant>

namespace bendy::tools {
namespace {

using Json = OrderedJson;
using converter::CharacterComparison;
using converter::CharacterDifference;
using diff::Difference;
using diff::Differences;
using diff::ReadFile;
using Kind = Difference::Kind;

Json to_json(const diff::Value& value) {
    Json list = Json::array();
    for (const diff::Scalar& item : value.items) {
        std::visit(
            [&](const auto& scalar) {
                if constexpr (std::is_same_v<decltype(scalar), const std::monostate&>) {
                    list.push_back(nullptr);
                } else {
                    list.push_back(scalar);
                }
            },
            item);
    }
    return value.is_list ? list : list.front();
}

const char* kind_name(Kind kind) {
    constexpr std::array kNames{"onlyInA", "onlyInB", "order", "value", "numbers", "bytes", "storage"};
    return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace

std::string name_around(const ChunkTree& tree, std::uint32_t number) {
    constexpr unsigned kMostSteps = 3;
    for (unsigned step = 0; step < kMostSteps && number != 0; ++step) {
        const std::uint32_t name = tree[number].is_container() ? tree.find(number, FourCC("NAME")) : kNone;
        if (name != kNone) return std::string(as_text(tree.payload(name)));
        number = tree[number].parent;
    }
    return {};
}

Json differences_as_json(const std::string& a_name, const std::string& b_name, const ReadFile& a, const ReadFile& b,
                         const Differences& differences) {
    Json list = Json::array();
    for (const Difference& difference : differences.list()) {
        const auto& [here, there] = difference.chunks;
        Json entry{{"kind", kind_name(difference.kind)}};
        if (here != kNone) entry["pathInA"] = whole_chunk_path(a.tree.bytes(), a.tree[here].offset);
        if (there != kNone) entry["pathInB"] = whole_chunk_path(b.tree.bytes(), b.tree[there].offset);
        const std::string name = here != kNone ? name_around(a.tree, here) : name_around(b.tree, there);
        if (!name.empty()) entry["name"] = name;
        if (!difference.part.empty()) entry["part"] = difference.part;
        if (difference.kind == Kind::value || difference.kind == Kind::numbers) {
            entry["a"] = to_json(difference.a_value);
            entry["b"] = to_json(difference.b_value);
        }
        if (difference.kind == Kind::bytes) {
            entry["bytesInA"] = to_json(difference.a_value);
            entry["bytesInB"] = to_json(difference.b_value);
            entry["first"] = difference.first_element;
        }
        if (difference.kind == Kind::numbers) {
            entry["largest"] = difference.largest;
            entry["element"] = difference.first_element;
            entry["component"] = difference.first_component;
        }
        if (difference.kind == Kind::numbers || difference.kind == Kind::bytes) {
            entry["differing"] = difference.count;
            entry["of"] = difference.of;
        }
        list.push_back(std::move(entry));
    }
    Json report{{"a", a_name}, {"b", b_name}, {"same", differences.count() == 0}};
    report["differences"] = std::move(list);
    report["differencesLeftOut"] = differences.left_out();
    return report;
}

Result<ComparedCharacter, converter::ImportError> read_compared(Bytes bytes, converter::Report& report) {
    auto scene = converter::import_bendy(bytes, report);
    if (!scene) return scene.error();
    return ComparedCharacter{*std::move(scene),
                             converter::write_rig(diff::read_file(bytes)->document.objects.front(), false)};
}

CharacterComparison compare_characters(const ComparedCharacter& a, const ComparedCharacter& b,
                                       const converter::ErrorBound& tolerance,
                                       const std::function<void(double)>& progress) {
    CharacterComparison comparison = converter::compare_characters(a.scene, b.scene, tolerance, progress);
    if (a.rig != b.rig) {
        comparison.differences.push_back(
            {CharacterDifference::Kind::value, "rig", "constraints or IK chains differ; `bendy rig` writes them", 0.0});
    }
    return comparison;
}

Json comparison_as_json(const std::string& a_name, const std::string& b_name, const CharacterComparison& comparison) {
    constexpr std::array kKinds{"onlyInA", "onlyInB", "value", "distance"};
    Json report{{"a", a_name},
                {"b", b_name},
                {"same", comparison.differences.empty()},
                {"tolerance", comparison.tolerance},
                {"unit", "metres"},
                {"worst", comparison.worst ? Json(*comparison.worst) : Json()},
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

}  // namespace bendy::tools
