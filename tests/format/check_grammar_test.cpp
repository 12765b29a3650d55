#include <bendy/format/chunk_reader.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace bendy::check_grammar_test {
namespace {

using namespace test;

struct Row {
    std::string id, shape;
    std::set<std::string> parents;
    std::string times;
};

/// The table.
const std::vector<Row>& rows() {
    static const std::vector<Row> kRows = [] {
        std::vector<Row> list;
        const auto add = [&](const char* id, const char* shape, const char* parents, const char* times) {
            std::istringstream words(parents);
            list.push_back({id, shape, {std::istream_iterator<std::string>(words), {}}, times});
        };
#define BENDY_CHUNK(id, shape, parents, times, what) add(#id, #shape, parents, #times);
#include <bendy/format/chunk_ids.def>
#undef BENDY_CHUNK
        return list;
    }();
    return kRows;
}

FourCC id_of(const std::string& letters) {
    std::uint32_t raw = 0;
    std::memcpy(&raw, letters.data(), sizeof raw);
    return FourCC(raw);
}

/// An empty chunk as the row has it.
Node empty_chunk(const Row& row) {
    return row.shape == "leaf" ? make_leaf(id_of(row.id)) : make_container(id_of(row.id));
}

Lines grammar_faults(const Node& root) {
    const Buffer file = to_file(root);
    const auto tree = read_chunk_tree(file);
    if (!tree) return {describe(tree.error())};
    Faults faults;
    check_grammar(*tree, faults);
    return lines_of(faults, file);
}

bool contains(const Lines& lines, const std::string& line) {
    return std::find(lines.begin(), lines.end(), line) != lines.end();
}

/// Calls `visit` with every container of the file and its path.
void for_each_container(Node& root, const std::function<void(Node&, const std::string&)>& visit,
                        const std::string& path = "HEAD") {
    if (!root.is_container()) return;
    visit(root, path);
    std::map<std::string, int> places;
    for (Node& node : root.children) {
        const std::string id = node.id.letters().data();
        const int place = places[id]++;
        for_each_container(node, visit, path + "/" + id + (place != 0 ? "[" + std::to_string(place) + "]" : ""));
    }
}

TEST(CheckGrammar, FindsNothingInTheSample) {
    EXPECT_EQ(grammar_faults(sample()), Lines{});
}

TEST(CheckGrammar, TheSampleHoldsEveryChunkOfExactFiles) {
    std::set<std::string> ids;
    const Loaded loaded(sample_file());
    for (const Chunk& chunk : loaded.tree.chunks()) ids.insert(chunk.id.letters().data());
    // Only compact files hold these: joint_table_test.cpp and packed_clip_test.cpp have them. MARK: marker_test.cpp,
    // CURV: curve_test.cpp, ROLE: role_test.cpp, STND: standing_pose_test.cpp.
    // Frames and what they are played by, and MORE: tests/conformance and every_chunk.bendy.
    for (const char* id : {"BNDS", "JNTS", "JNAM", "ROLE", "STND", "PACK", "MARK", "CURV", "MORE", "FRMS", "FNAM",
                           "GRID", "NLST", "PLAY"})
        EXPECT_TRUE(ids.insert(id).second) << id;
    for (const Row& row : rows()) EXPECT_EQ(ids.count(row.id), 1u) << row.id;
}

TEST(CheckGrammar, TakesAKnownChunkExactlyWhereTheTableHasIt) {
    for (const Row& container : rows()) {
        if (container.shape != "container") continue;
        for (const Row& row : rows()) {
            Node root = make_container(FourCC("HEAD"));
            std::string path = "HEAD";
            if (container.id != "HEAD") {
                root.children.push_back(make_container(id_of(container.id)));
                path += "/" + container.id;
            }
            at(root, path).children.push_back(empty_chunk(row));
            EXPECT_EQ(contains(grammar_faults(root), "CHUNK_MISPLACED " + path + "/" + row.id),
                      row.parents.count(container.id) == 0)
                << row.id << " in " << container.id;
        }
    }
}

TEST(CheckGrammar, RefusesAKnownChunkOfTheWrongShape) {
    for (const Row& row : rows()) {
        if (row.id == "HEAD") continue;  // the reader's business
        const bool is_leaf = row.shape == "leaf";
        Node root =
            make_container(FourCC("HEAD"), {is_leaf ? make_container(id_of(row.id)) : make_leaf(id_of(row.id))});
        EXPECT_TRUE(contains(grammar_faults(root), (is_leaf ? "NOT_A_LEAF HEAD/" : "NOT_A_CONTAINER HEAD/") + row.id));
        root.children[0] = empty_chunk(row);
        EXPECT_FALSE(contains(grammar_faults(root), (is_leaf ? "NOT_A_LEAF HEAD/" : "NOT_A_CONTAINER HEAD/") + row.id));
    }
}

TEST(CheckGrammar, CountsHowOftenAChunkStands) {
    for (const Row& row : rows()) {
        for (const std::string& parent : row.parents) {
            if (parent == "-") continue;
            Node root = make_container(FourCC("HEAD"));
            std::string path = "HEAD";
            if (parent != "HEAD") {
                root.children.push_back(make_container(id_of(parent)));
                path += "/" + parent;
            }
            Node& container = at(root, path);
            container.children.push_back(empty_chunk(row));
            container.children.push_back(empty_chunk(row));
            const std::string repeated = "CHUNK_REPEATED " + path + "/" + row.id + "[1]";
            EXPECT_EQ(contains(grammar_faults(root), repeated), row.times != "many") << row.id << " in " << parent;
        }
    }
}

TEST(CheckGrammar, NamesTheChunkThatIsMissing) {
    for (const Row& row : rows()) {
        if (row.times != "one" || row.id == "HEAD" || row.id == "GRID") continue;  // the sample has no frames
        Node root = sample();
        std::string expected;
        for_each_container(root, [&](Node& container, const std::string& path) {
            if (!expected.empty() || row.parents.count(container.id.letters().data()) == 0) return;
            remove(container, row.id);
            expected = path;
        });
        const Buffer file = to_file(root);
        Faults faults;
        check_grammar(*read_chunk_tree(file), faults);
        ASSERT_EQ(faults.list().size(), 1u) << row.id;
        EXPECT_EQ(faults.list()[0].code, ErrorCode::kChunkMissing);
        EXPECT_EQ(chunk_path(file, faults.list()[0].offset), expected);
        EXPECT_EQ(describe(faults.list()[0]), "the container lacks a required chunk: " + row.id);
    }
}

/// Puts an unknown chunk into each container of the sample in turn, first and last, and hands on the faults.
void with_unknown_chunk_everywhere(const Node& unknown,
                                   const std::function<void(const Lines&, const std::string&)>& check) {
    std::set<std::string> tried;
    Lines paths;
    Node root = sample();
    for_each_container(root, [&](Node& container, const std::string& path) {
        tried.insert(container.id.letters().data());
        paths.push_back(path);
    });
    for (const std::string& path : paths) {
        for (const bool first : {true, false}) {
            Node changed = sample();
            auto& children = at(changed, path).children;
            children.insert(first ? children.begin() : children.end(), unknown);
            check(faults_in(changed), path + "/" + unknown.id.letters().data());
        }
    }
    EXPECT_EQ(tried.count("FRMS"), 0u) << "the sample has frames now: nothing need be left out below";
    for (const Row& row : rows()) {
        if (row.id == "FRMS") continue;
        EXPECT_EQ(tried.count(row.id), row.shape == "container" ? 1u : 0u) << row.id;
    }
}

TEST(CheckGrammar, SkipsAnUnknownLeafInEveryContainer) {
    with_unknown_chunk_everywhere(
        make_leaf(FourCC("ZZZZ"), as_byte_span("later"), 0x0700),
        [](const Lines& faults, const std::string& path) { EXPECT_EQ(faults, Lines{}) << path; });
}

TEST(CheckGrammar, SkipsAnUnknownContainerWithAllInsideItInEveryContainer) {
    const Node unknown = make_container(
        FourCC("ZZZZ"), {make_leaf(FourCC("YYYY"), {}, kRequiredFlag), make_leaf(FourCC("NAME"), as_byte_span("\xff")),
                         make_container(FourCC("SKIN")), make_container(FourCC("MATE")), make_leaf(FourCC("POLY"))});
    with_unknown_chunk_everywhere(
        unknown, [](const Lines& faults, const std::string& path) { EXPECT_EQ(faults, Lines{}) << path; });
}

TEST(CheckGrammar, RefusesAnUnknownRequiredChunkInEveryContainer) {
    for (const Node& unknown :
         {make_leaf(FourCC("ZZZZ"), {}, kRequiredFlag), make_container(FourCC("ZZZZ"), {}, kRequiredFlag)}) {
        with_unknown_chunk_everywhere(unknown, [](const Lines& faults, const std::string& path) {
            EXPECT_EQ(faults, Lines{"REQUIRED_CHUNK_UNKNOWN " + path});
        });
    }
}

TEST(CheckGrammar, TakesKnownChunksThatAreMarkedRequired) {
    Node root = sample();
    for_each_container(root, [](Node& container, const std::string&) {
        container.flags |= kRequiredFlag;
        for (Node& node : container.children) node.flags |= kRequiredFlag;
    });
    EXPECT_EQ(faults_in(root), Lines{});
}

TEST(CheckGrammar, RefusesConstraintsAndChainsInTheWrongPlaceOrShape) {
    Node root = sample();
    at(root, "HEAD/OBJE/SKIN").children.push_back(make_leaf(FourCC("LIMT")));
    at(root, "HEAD/OBJE").children.push_back(make_leaf(FourCC("PULL")));
    at(root, "HEAD/OBJE").children.push_back(make_leaf(FourCC("IKCH")));
    at(root, "HEAD/OBJE/SKIN/PIVO").children.push_back(make_container(FourCC("LIMT")));
    at(root, "HEAD/OBJE/IKCH").children.push_back(make_leaf(FourCC("REST")));
    Lines faults = faults_in(root);
    std::sort(faults.begin(), faults.end());
    EXPECT_EQ(faults, (Lines{"CHUNK_MISPLACED HEAD/OBJE/IKCH/REST", "CHUNK_MISPLACED HEAD/OBJE/PULL",
                             "CHUNK_MISPLACED HEAD/OBJE/SKIN/LIMT", "NOT_A_CONTAINER HEAD/OBJE/IKCH[2]",
                             "NOT_A_LEAF HEAD/OBJE/SKIN/PIVO/LIMT"}));
}

}  // namespace
}  // namespace bendy::check_grammar_test
