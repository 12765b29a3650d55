#include "quake2.h"

#include <bendy/format/charconv.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <system_error>
#include <utility>

namespace bendy::converter::md2 {
namespace {

struct Face {
    std::array<glm::dvec3, 3> corners;
    int cuts = 0;  ///< cuts left to make
};

/// A regular icosahedron, as in the OpenGL books.
std::vector<Face> icosahedron() {
    const double x = std::sqrt((5.0 - std::sqrt(5.0)) / 10.0);
    const double z = std::sqrt((5.0 + std::sqrt(5.0)) / 10.0);
    const std::array<glm::dvec3, 12> corners{{{-x, 0, z},
                                              {x, 0, z},
                                              {-x, 0, -z},
                                              {x, 0, -z},
                                              {0, z, x},
                                              {0, z, -x},
                                              {0, -z, x},
                                              {0, -z, -x},
                                              {z, x, 0},
                                              {-z, x, 0},
                                              {z, -x, 0},
                                              {-z, -x, 0}}};
    constexpr std::array<std::array<std::size_t, 3>, 20> kFaces{
        {{0, 4, 1}, {0, 9, 4},  {9, 5, 4},  {4, 5, 8},  {4, 8, 1},  {8, 10, 1}, {8, 3, 10},
         {5, 3, 8}, {5, 2, 3},  {2, 7, 3},  {7, 10, 3}, {7, 6, 10}, {7, 11, 6}, {11, 0, 6},
         {0, 1, 6}, {6, 1, 10}, {9, 0, 11}, {9, 11, 2}, {9, 2, 5},  {7, 2, 11}}};
    constexpr int kCuts = 2;
    std::vector<Face> faces;
    faces.reserve(kFaces.size());
    for (const auto& [a, b, c] : kFaces) faces.push_back({{corners[a], corners[b], corners[c]}, kCuts});
    return faces;
}

}  // namespace

std::vector<glm::vec3> quake_normals() {
    constexpr double kSame = 1e-9;
    std::vector<glm::dvec3> met;
    std::vector<Face> open = icosahedron();
    std::reverse(open.begin(), open.end());  // so that they are taken in order
    while (!open.empty()) {
        const Face face = open.back();
        open.pop_back();
        const auto& [a, b, c] = face.corners;
        if (face.cuts == 0) {
            for (const glm::dvec3& corner : face.corners) {
                const auto is_same = [&](const glm::dvec3& other) { return glm::distance(corner, other) < kSame; };
                if (std::none_of(met.begin(), met.end(), is_same)) met.push_back(corner);
            }
            continue;
        }
        const glm::dvec3 ab = (a + b) * 0.5;
        const glm::dvec3 bc = (b + c) * 0.5;
        const glm::dvec3 ca = (c + a) * 0.5;
        const int cuts = face.cuts - 1;
        open.push_back({{ab, bc, ca}, cuts});
        open.push_back({{c, ca, bc}, cuts});
        open.push_back({{b, ab, bc}, cuts});
        open.push_back({{a, ab, ca}, cuts});
    }
    std::vector<glm::vec3> normals;
    normals.reserve(met.size());
    for (const glm::dvec3& corner : met) normals.emplace_back(glm::normalize(corner));
    return normals;
}

namespace {

/// The name in lower case, with one spelling of what modellers spell in two: `crattack` becomes `crattak`.
std::string spelled(std::string_view name) {
    std::string spelled(name);
    std::transform(spelled.begin(), spelled.end(), spelled.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    for (const auto& [word, as] :
         {std::pair<std::string_view, std::string_view>("attack", "attak"), {"death", "deth"}}) {
        if (const std::size_t at = spelled.find(word); at != std::string::npos) spelled.replace(at, word.size(), as);
    }
    return spelled;
}

constexpr std::size_t kCountingDigits = 2;
constexpr std::uint64_t kNoNumber = std::numeric_limits<std::uint64_t>::max();

struct FrameName {
    std::string_view letters;
    std::string_view digits;
    std::uint64_t number = 0;  ///< or kNoNumber
    std::string spelled;       ///< the letters, for comparisons
};

FrameName take_apart(std::string_view name) {
    constexpr std::string_view kDigits = "0123456789";
    const std::size_t last = name.find_last_not_of(kDigits);
    FrameName parts;
    parts.letters = name.substr(0, last == std::string_view::npos ? 0 : last + 1);
    parts.digits = name.substr(parts.letters.size());
    const char* const end = parts.digits.data() + parts.digits.size();
    const auto read = from_chars(parts.digits.data(), end, parts.number);
    if (read.ec != std::errc()) parts.number = kNoNumber;
    parts.spelled = spelled(parts.letters);
    return parts;
}

std::string name_of(const FrameName& first) {
    std::string_view kept;
    if (first.digits.size() > kCountingDigits) kept = first.digits.substr(0, first.digits.size() - kCountingDigits);
    if (kept.find_first_not_of('0') == std::string_view::npos) kept = {};
    return std::string(first.letters) + std::string(kept);
}

/// Actions that Quake II's players have in several variants, each with its own frames.
struct StandardClip {
    std::string_view name;
    std::size_t first;
    std::size_t count;
};
constexpr std::size_t kStandardFrames = 198;
constexpr std::array<StandardClip, 6> kSeveralWays{
    {{"pain1", 54, 4}, {"pain2", 58, 4}, {"pain3", 62, 4}, {"death1", 178, 6}, {"death2", 184, 6}, {"death3", 190, 8}}};

/// Splits a run at the variants' first frames, if it has the standard's frames.
void add_ways(const FrameRun& run, std::vector<FrameRun>& runs) {
    std::vector<FrameRun> ways;
    std::size_t next = run.first;
    for (const auto& [name, first, count] : kSeveralWays) {
        if (first != next || spelled(name.substr(0, name.size() - 1)) != spelled(run.name)) continue;
        ways.push_back({std::string(name), first, count});
        next += count;
    }
    if (next != run.first + run.count) ways = {run};
    runs.insert(runs.end(), ways.begin(), ways.end());
}

}  // namespace

std::vector<FrameRun> find_runs(std::span<const std::string> names) {
    std::vector<FrameRun> runs;
    FrameName before;
    for (std::size_t frame = 0; frame < names.size(); ++frame) {
        FrameName name = take_apart(names[frame]);
        const bool goes_on = !runs.empty() && name.spelled == before.spelled && name.number != kNoNumber &&
                             before.number != kNoNumber && name.number == before.number + 1;
        if (!goes_on) runs.push_back({name_of(name), frame, 0});
        ++runs.back().count;
        before = std::move(name);
    }
    if (names.size() != kStandardFrames) return runs;
    std::vector<FrameRun> ways;
    for (const FrameRun& run : runs) add_ways(run, ways);
    return ways;
}

bool is_repeated(std::string_view name) {
    constexpr std::array<std::string_view, 9> kOnce{"attak", "pain", "jump",  "flip", "salute",
                                                    "taunt", "wave", "point", "deth"};
    const std::string lower = spelled(name);
    std::string_view deed = lower;
    if (deed.starts_with("cr")) deed.remove_prefix(2);  // crouched
    return std::none_of(kOnce.begin(), kOnce.end(), [&](std::string_view once) { return deed.starts_with(once); });
}

}  // namespace bendy::converter::md2
