#include "cases.h"
#include "fuzz/use_model.h"
#include "source_folder.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>
#include <bendy/runtime.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

// The library on the cases of tests/conformance; check_reports.py is the same for the program.
namespace bendy::conformance_test {
namespace {

using conformance::Case;
using conformance::Fault;

const std::vector<Case>& cases() {
    static const std::vector<Case> kCases = conformance::read_cases(source_folder() / "tests/conformance");
    return kCases;
}

std::string shown(const std::set<Fault>& faults) {
    std::string text;
    for (const auto& [offset, code, path] : faults) text += code + " at " + std::to_string(offset) + ", " + path + '\n';
    return text;
}

ErrorClass class_of(std::string_view code) {
#define BENDY_ERROR(enumerator, kind, name, text) \
    if (code == name) return ErrorClass::kind;
#include <bendy/format/error_codes.def>
#undef BENDY_ERROR
    return ErrorClass::io;
}

/// A valid file may hold no object; a model has one.
bool has_object(Bytes bytes) {
    const Result<ChunkTree> tree = read_chunk_tree(bytes);
    return tree && tree->find(0, FourCC("OBJE")) != kNone;
}

TEST(Conformance, EveryFileHasTheFaultsThatItsReportStates) {
    for (const Case& one : cases()) {
        std::set<Fault> found;
        const Faults faults = validate(one.bytes);
        for (const Error& fault : faults.list())
            found.emplace(fault.offset, code_name(fault.code), whole_chunk_path(one.bytes, fault.offset));
        EXPECT_EQ(shown(found), shown(one.faults)) << one.name;
    }
}

TEST(Conformance, AReaderTakesWhatIsValidAndRefusesWhatIsMalformedOrUnsupported) {
    unsigned choice = 0;
    for (const Case& one : cases()) {
        const Result<Model> model = Model::from_memory(one.bytes);
        if (model) fuzz::use_model(*model, choice++);
        const bool must_refuse = std::any_of(one.faults.begin(), one.faults.end(), [](const Fault& fault) {
            return class_of(std::get<1>(fault)) != ErrorClass::invalid;
        });
        EXPECT_FALSE(one.valid && has_object(one.bytes) && !model.has_value()) << one.name;
        EXPECT_FALSE(must_refuse && model.has_value()) << one.name;
    }
}

TEST(Conformance, EveryCodeHasAFile) {
    const std::map<std::string, const char*> elsewhere{
        {"CANNOT_OPEN", "the system's: file_test.cpp, tests/cli"},
        {"CANNOT_READ", "the system's: file_test.cpp"},
        {"CANNOT_WRITE", "the system's: file_test.cpp, tests/cli"},
        {"UNALIGNED_BUFFER", "the caller's: chunk_reader_test.cpp"},
        {"TOO_DEEP", "its file takes a MiB: made by make_files.py --large"},
        {"TOO_MANY_JOINTS", "its file takes a MiB: made by make_files.py --large"},
        {"TOO_MANY_CHUNKS", "the smallest file with so many takes 32 GiB"},
    };
    std::map<std::string, int> files;
    for (const Case& one : cases()) {
        for (const auto& [offset, code, path] : one.faults) ++files[code];
    }
#define BENDY_ERROR(enumerator, kind, code, text) EXPECT_NE(files.count(code), elsewhere.count(code)) << code;
#undef BENDY_ERROR
}

TEST(Conformance, EveryChunkStandsInAValidFile) {
    std::set<std::string> found;
    std::size_t valid = 0;
    for (const Case& one : cases()) {
        if (!one.valid) continue;
        ++valid;
        const Result<ChunkTree> tree = read_chunk_tree(one.bytes);
        ASSERT_TRUE(tree.has_value()) << one.name;
        for (const Chunk& chunk : tree->chunks()) found.emplace(chunk.id.letters().data());
    }
#define BENDY_CHUNK(id, shape, parents, times, what) EXPECT_TRUE(found.contains(#id)) << #id;
#include <bendy/format/chunk_ids.def>
#undef BENDY_CHUNK
    EXPECT_GE(valid, 200u);
    EXPECT_GE(cases().size() - valid, 200u);
}

}  // namespace
}  // namespace bendy::conformance_test
