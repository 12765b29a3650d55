#include "parse_rig.h"

#include "failure.h"
#include "fields.h"
#include "parse_chain.h"
#include "parse_limit.h"
#include "source/read_file.h"

#include <unordered_set>

namespace bendy::converter {
namespace {

constexpr std::uint64_t kVersion = 1;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;

}  // namespace

Rig parse_rig(std::string_view text, Report& report) {
    const auto root = parse_json_text<OrderedJson>(text, report);
    Fields fields(root, {}, AngleUnit::degrees);
    Rig rig;
    if (const OrderedJson& version = fields.need("bendy_rig"); version != kVersion)
        fail("bendy_rig", "layout " + shown(version) + " is not supported, only 1");
    fields.read("complete", rig.complete);
    if (const OrderedJson* joints = fields.find("joints"); joints != nullptr) {
        Fields entries(*joints, "joints", AngleUnit::degrees);  // an object, every key once
        for (const auto& [name, value] : joints->items()) {
            const std::string place = entries.place_of(name);
            rig.joints.push_back({parse_joint_key(name, place), place, parse_limits(value, place, AngleUnit::degrees)});
        }
    }
    std::unordered_set<std::string> names;
    if (const OrderedJson* chains = fields.find("chains"); chains != nullptr) {
        need_list(*chains, "chains");
        for (std::size_t i = 0; i < chains->size(); ++i) {
            RigChain chain = parse_chain((*chains)[i], at("chains", i), AngleUnit::degrees);
            if (!names.insert(chain.name).second)
                fail(at("chains", i) + ".name", "there is an earlier chain " + quote(chain.name));
            rig.chains.push_back(std::move(chain));
        }
    }
    if (const OrderedJson* cycles = fields.find("markers"); cycles != nullptr) {
        Fields entries(*cycles, "markers", AngleUnit::degrees);
        rig.cycles.emplace();
        for (const auto& [key, value] : cycles->items()) {
            const std::string place = entries.place_of(key);
            rig.cycles->push_back({key, place, parse_markers(value, place, WrongMarkers::fail, report)});
        }
    }
    std::string schema;
    fields.read("$schema", schema);  // for editors
    fields.refuse_others();
    return rig;
}

Rig read_rig(const std::filesystem::path& file, Report& report) {
    const auto bytes = read_file(file, {}, kMostBytes);
    Rig rig = parse_rig({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, report);
    rig.source = file.filename().string() + ": ";
    return rig;
}

}  // namespace bendy::converter
