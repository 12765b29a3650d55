#include "scene/source/importers.h"

#include <bendy/converter/source_format.h>

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace bendy::converter::importers_test {
namespace {

Bytes bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text));
}

TEST(Importers, AreFoundByTheirSignatures) {
    std::set<std::string_view> seen;
    for (const Importer& importer : importers()) {
        if (importer.signature.empty()) continue;
        EXPECT_TRUE(seen.insert(importer.signature).second) << importer.name;
        const std::string text = std::string(importer.signature) + " and more";
        const auto kind = find_file_kind(bytes_of(text), "file.without.meaning");
        ASSERT_TRUE(kind) << importer.name;
        EXPECT_EQ(kind->name, importer.name);
        EXPECT_EQ(kind->format, importer.format);
    }
    EXPECT_GE(seen.size(), 4u);
}

TEST(Importers, AreFoundByTheirSuffixesWhereTheContentSaysNothing) {
    std::set<std::string_view> seen;
    for (const Importer& importer : importers()) {
        for (const std::string_view suffix : importer.suffixes) {
            if (suffix.empty()) continue;
            EXPECT_TRUE(seen.insert(suffix).second) << suffix;
            const bool is_bendy = importer.format == SourceFormat::bendy;  // whose content always tells
            EXPECT_EQ(find_source_format(bytes_of("nothing known"), "fox" + std::string(suffix)),
                      is_bendy ? SourceFormat::gltf : importer.format)
                << suffix;
            EXPECT_EQ(has_readable_suffix("fox" + std::string(suffix)), !is_bendy) << suffix;
        }
    }
    EXPECT_TRUE(has_readable_suffix("FOX.GLB"));
    EXPECT_FALSE(has_readable_suffix("fox"));
    EXPECT_FALSE(has_readable_suffix("fox.fbx"));
}

TEST(Importers, AreListedForPeople) {
    EXPECT_EQ(list_readable_suffixes(), ".gltf, .glb, .vrm, .vrma, .x, .md2, .bvh");
}

TEST(Importers, SuggestedCommandsNameAFileAndNothingElse) {
    const auto kind = find_file_kind(bytes_of("glTF"), "fox.glb");
    ASSERT_TRUE(kind);
    EXPECT_TRUE(why_not_bendy(*kind, "a/fox.glb").ends_with(" bendy convert a/fox.glb"));
    EXPECT_TRUE(why_not_bendy(*kind, "$(touch x) it's.glb").ends_with(R"( bendy convert '$(touch x) it'\''s.glb')"));
    EXPECT_EQ(quoted_for_shell(""), "''");
}

TEST(Importers, EveryFormatHasOne) {
    for (const SourceFormat format :
         {SourceFormat::gltf, SourceFormat::bendy, SourceFormat::x, SourceFormat::md2, SourceFormat::bvh})
        EXPECT_EQ(importer_of(format).format, format);
}

}  // namespace
}  // namespace bendy::converter::importers_test
