#include "fuzz/use_model.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>
#include <bendy/format/validate.h>
#include <bendy/runtime.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

// The library on the files of tests/conformance; check_reports.py is the same for the program.
namespace bendy {
namespace {

const std::filesystem::path kFolder = std::filesystem::path(BENDY_SOURCE_DIR) / "tests" / "conformance" / "files";

/// Offset, code and path.
using Fault = std::tuple<std::uint64_t, std::string, std::string>;

struct Case {
    std::filesystem::path file;
    bool valid = false;
    std::set<Fault> faults;
};

std::vector<Case> read_cases() {
    std::vector<Case> cases;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kFolder)) {
        if (entry.path().extension() != ".bendy") continue;
        Case one;
        one.file = entry.path();
        std::ifstream stream(std::filesystem::path(entry.path()).replace_extension(".json"));
        const nlohmann::json report = nlohmann::json::parse(stream);
        one.valid = report.at("valid").get<bool>();
        for (const auto& fault : report.at("faults"))
            one.faults.emplace(fault.at("offset"), fault.at("code"), fault.at("path"));
        cases.push_back(std::move(one));
    }
    std::sort(cases.begin(), cases.end(), [](const Case& a, const Case& b) { return a.file < b.file; });
    return cases;
}

const std::vector<Case>& cases() {
    static const std::vector<Case> kCases = read_cases();
    return kCases;
}

MappedFile open(const Case& one) {
    Result<MappedFile> file = MappedFile::open(one.file);
    EXPECT_TRUE(file.has_value()) << one.file;
    return std::move(*file);
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
        const MappedFile file = open(one);
        std::set<Fault> found;
        const Faults faults = validate(file.bytes());
        for (const Error& fault : faults.list())
            found.emplace(fault.offset, code_name(fault.code), whole_chunk_path(file.bytes(), fault.offset));
        EXPECT_EQ(shown(found), shown(one.faults)) << one.file;
    }
}

TEST(Conformance, AReaderTakesWhatIsValidAndRefusesWhatIsMalformedOrUnsupported) {
    unsigned choice = 0;
    for (const Case& one : cases()) {
        const MappedFile file = open(one);
        const Result<Model> model = Model::from_memory(file.bytes());
        if (model) fuzz::use_model(*model, choice++);
        const bool must_refuse = std::any_of(one.faults.begin(), one.faults.end(), [](const Fault& fault) {
            return class_of(std::get<1>(fault)) != ErrorClass::invalid;
        });
        EXPECT_FALSE(one.valid && has_object(file.bytes()) && !model.has_value()) << one.file;
        EXPECT_FALSE(must_refuse && model.has_value()) << one.file;
    }
}

TEST(Conformance, EveryCodeHasAFile) {
    const std::map<std::string, const char*> elsewhere{
        {"CANNOT_OPEN", "the system's: file_test.cpp, cli_test.py"},
        {"CANNOT_READ", "the system's: file_test.cpp"},
        {"CANNOT_WRITE", "the system's: file_test.cpp, cli_test.py"},
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
#include <bendy/format/error_codes.def>
#undef BENDY_ERROR
}

TEST(Conformance, EveryChunkStandsInAValidFile) {
    std::set<std::string> found;
    std::size_t valid = 0;
    for (const Case& one : cases()) {
        if (!one.valid) continue;
        ++valid;
        const MappedFile file = open(one);
        const Result<ChunkTree> tree = read_chunk_tree(file.bytes());
        ASSERT_TRUE(tree.has_value()) << one.file;
        for (const Chunk& chunk : tree->chunks()) found.emplace(chunk.id.letters().data());
    }
#define BENDY_CHUNK(id, shape, parents, times, what) EXPECT_TRUE(found.contains(#id)) << #id;
#include <bendy/format/chunk_ids.def>
#undef BENDY_CHUNK
    EXPECT_GE(valid, 200u);
    EXPECT_GE(cases().size() - valid, 200u);
}

}  // namespace
}  // namespace bendy
