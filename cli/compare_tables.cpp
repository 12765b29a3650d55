#include "compare_leaves.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

// Comparing the tables that stand for many chunks, JNTS, JNAM, LODD; and markers.
namespace bendy::cli {
namespace {

using Json = nlohmann::ordered_json;

struct JointTable {
    std::span<const RestRecord> rests;
    std::span<const JointPolygons> polygons;
};

JointTable joint_table(Bytes payload) {
    JointsRecord record;
    copy_at(payload, 0, record);
    const std::uint64_t polygons_at = sizeof record + std::uint64_t{record.joints} * sizeof(RestRecord);
    return {view_at<RestRecord>(payload, sizeof record, record.joints),
            view_at<JointPolygons>(payload, polygons_at, record.polygons)};
}

/// Texts with a zero behind each.
std::vector<std::string_view> names_in(Bytes payload) {
    std::vector<std::string_view> names;
    for (std::string_view text = as_text(payload); !text.empty();) {
        const std::size_t end = std::min(text.find('\0'), text.size() - 1);
        names.push_back(text.substr(0, end));
        text.remove_prefix(end + 1);
    }
    return names;
}

std::string joint_part(const ObjectView& object, std::size_t joint) {
    const std::string_view name =
        joint < object.skeleton.joints.size() ? object.skeleton.joints[joint].name : std::string_view();
    return "joint " + std::to_string(joint) + (name.empty() ? "" : " \"" + std::string(name) + '"') + ": ";
}

Json ranges_text(const JointPolygons& range) {
    const PolygonRecord& polygons = range.polygons;
    return Json::array(
        {range.joint, polygons.pool, polygons.material, polygons.first, polygons.count, polygons.topology});
}

}  // namespace

void ContentComparer::compare_joint_tables(ChunkPair leaves) {
    const ObjectView& object = *a_.tables[leaves.a];
    const JointTable a = joint_table(a_.tree.payload(leaves.a));
    const JointTable b = joint_table(b_.tree.payload(leaves.b));
    if (a.rests.size() != b.rests.size()) add_value(leaves, "joints", a.rests.size(), b.rests.size());
    if (a.polygons.size() != b.polygons.size()) add_value(leaves, "polygons", a.polygons.size(), b.polygons.size());
    for (std::size_t j = 0; j < std::min(a.rests.size(), b.rests.size()); ++j) {
        const auto compare = [&](const char* field, const auto& here, const auto& there) {
            const bool is_same =
                std::equal(here.begin(), here.end(), there.begin(), [&](float x, float y) { return is_near(x, y); });
            if (!is_same) add_value(leaves, joint_part(object, j) + field, here, there);
        };
        compare("rotation", a.rests[j].rotation, b.rests[j].rotation);
        compare("translation", a.rests[j].translation, b.rests[j].translation);
        compare("scale", a.rests[j].scale, b.rests[j].scale);
        compare("shear", a.rests[j].shear, b.rests[j].shear);
    }
    for (std::size_t k = 0; k < std::min(a.polygons.size(), b.polygons.size()); ++k) {
        const Json here = ranges_text(a.polygons[k]);
        const Json there = ranges_text(b.polygons[k]);
        if (here != there) {
            add_value(leaves, "range " + std::to_string(k) + " (joint, pool, material, first, count, topology)", here,
                      there);
        }
    }
}

void ContentComparer::compare_joint_names(ChunkPair leaves) {
    const auto a = names_in(a_.tree.payload(leaves.a));
    const auto b = names_in(b_.tree.payload(leaves.b));
    if (a.size() != b.size()) add_value(leaves, "names", a.size(), b.size());
    for (std::size_t j = 0; j < std::min(a.size(), b.size()); ++j) {
        if (a[j] != b[j]) add_value(leaves, "joint " + std::to_string(j), a[j], b[j]);
    }
}

void ContentComparer::compare_markers(ChunkPair leaves, const CycleView& a, const CycleView& b) {
    if (a.markers.size() != b.markers.size()) add_value(leaves, "markers", a.markers.size(), b.markers.size());
    for (std::size_t k = 0; k < std::min(a.markers.size(), b.markers.size()); ++k) {
        const Marker& here = a.markers[k];
        const Marker& there = b.markers[k];
        const std::string part = "marker " + std::to_string(k) + ": ";
        if (!is_near(here.seconds, there.seconds)) add_value(leaves, part + "seconds", here.seconds, there.seconds);
        if (here.name != there.name) add_value(leaves, part + "name", here.name, there.name);
    }
}

void ContentComparer::compare_collapses(ChunkPair leaves) {
    const CollapseView& a = *a_.tables[leaves.a]->collapse;
    const CollapseView& b = *b_.tables[leaves.b]->collapse;
    if (a.levels != b.levels) add_value(leaves, "levels", a.levels, b.levels);
    if (a.pools.size() != b.pools.size()) return add_value(leaves, "pools", a.pools.size(), b.pools.size());
    const std::uint32_t levels = std::min(a.levels, b.levels);
    compare_numbers(
        leaves, "errors of the levels", levels, 1,
        [&](std::uint64_t k) { return a.error(static_cast<std::uint32_t>(k)); },
        [&](std::uint64_t k) { return b.error(static_cast<std::uint32_t>(k)); });
    for (std::uint32_t p = 0; p < a.pools.size(); ++p) {
        const PoolCollapseView& here = a.pools[p];
        const PoolCollapseView& there = b.pools[p];
        const std::string part = "pool " + std::to_string(here.pool) + ": ";
        if (here.pool != there.pool) add_value(leaves, part + "number", here.pool, there.pool);
        if (here.base != there.base) add_value(leaves, part + "base", here.base, there.base);
        const auto compare = [&](const char* what, std::uint64_t count, const auto& number) {
            compare_numbers(
                leaves, part + what, count, 1,
                [&](std::uint64_t k) { return static_cast<double>(number(a, static_cast<std::uint32_t>(k))); },
                [&](std::uint64_t k) { return static_cast<double>(number(b, static_cast<std::uint32_t>(k))); });
        };
        compare("vertices of the levels", levels,
                [p](const CollapseView& view, std::uint32_t level) { return view.alive(level, p); });
        if (here.base != there.base || here.vertices != there.vertices) continue;
        const std::uint32_t base = here.base;
        compare("targets", here.vertices - base,
                [&](const CollapseView& view, std::uint32_t k) { return view.pools[p].target(base + k); });
        compare("joined bits", here.vertices - base,
                [&](const CollapseView& view, std::uint32_t k) { return view.pools[p].is_joined(base + k) ? 1u : 0u; });
    }
}

}  // namespace bendy::cli
