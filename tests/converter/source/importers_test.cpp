#include "convert/importers.h"
#include "formats/gltf/further_members.h"
#include "scene/source/readable_formats.h"

#include <bendy/converter/source_format.h>

#include <gtest/gtest.h>

#include <set>
#include <sstream>
#include <string>

namespace bendy::converter::importers_test {
namespace {

Bytes bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text));
}

TEST(Importers, AreFoundByTheirSignatures) {
    std::set<std::string_view> seen;
    for (const ReadableFormat& row : readable_formats()) {
        if (row.signature.empty()) continue;
        EXPECT_TRUE(seen.insert(row.signature).second) << row.name;
        const std::string text = std::string(row.signature) + " and more";
        const auto kind = find_file_kind(bytes_of(text), "file.without.meaning");
        ASSERT_TRUE(kind) << row.name;
        EXPECT_EQ(kind->name, row.name);
        EXPECT_EQ(kind->format, row.format);
    }
    EXPECT_GE(seen.size(), 4u);
}

TEST(Importers, AreFoundByTheirSuffixesWhereTheContentSaysNothing) {
    std::set<std::string_view> seen;
    for (const ReadableFormat& row : readable_formats()) {
        for (const std::string_view suffix : row.suffixes) {
            if (suffix.empty()) continue;
            EXPECT_TRUE(seen.insert(suffix).second) << suffix;
            const bool is_bendy = row.format == SourceFormat::bendy;  // whose content always tells
            EXPECT_EQ(find_source_format(bytes_of("nothing known"), "fox" + std::string(suffix)),
                      is_bendy ? SourceFormat::gltf : row.format)
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

/// What a file of that content is called, whatever its name.
std::string kind_of(std::string_view text) {
    std::set<std::string_view> names;
    for (const char* name : {"fox.glb", "fox.vrm", "fox.bvh", "fox.x", "fox.md2", "fox.bendy", "fox"}) {
        const auto kind = find_file_kind(bytes_of(text), name);
        names.insert(kind ? kind->name : "nothing");
        if (kind && !kind->format) {
            EXPECT_EQ(why_not_convertible(bytes_of(text), name).starts_with("is " + std::string(kind->name)), true);
            EXPECT_FALSE(why_not_bendy(*kind, name).empty());
        }
    }
    EXPECT_EQ(names.size(), 1u) << text;
    return std::string(*names.begin());
}

TEST(Importers, AnyMemberOfGltfTellsIt) {
    std::istringstream names{std::string(gltf::known_members(gltf::Element::root))};
    for (std::string name; names >> name;) EXPECT_EQ(kind_of("{\"" + name + "\": []}"), "a glTF file") << name;
}

TEST(Importers, WhatIsNoModelIsNamed) {
    using std::string_view_literals::operator""sv;
    for (const std::string_view page :
         {"<!DOCTYPE html>\n"sv, "\xef\xbb\xbf\r\n <HTML lang='en'>"sv, "<!-- saved -->\n<html>"sv,
          "<?xml version='1.0'?>\n<!DOCTYPE html PUBLIC '-'><html><body><svg/>"sv, "<head><title>502</title>"sv})
        EXPECT_EQ(kind_of(page), "an HTML page") << page;
    EXPECT_EQ(kind_of("version https://git-lfs.github.com/spec/v1\noid sha256:aa\nsize 1\n"), "a Git LFS pointer");
    EXPECT_EQ(kind_of("/annex/objects/SHA256E-s1--aa.glb\n"), "a git-annex pointer");
    EXPECT_EQ(kind_of("404: Not Found"), "a server's error message");
    for (const std::string_view picture :
         {"\x89PNG\r\n\x1a\n\0\0"sv, "\xff\xd8\xff\xe0"sv, "GIF89a"sv, "RIFF\0\0\0\0WEBPVP8 "sv, "DDS "sv, "8BPS\0\1"sv,
          "II*\0"sv, "MM\0*"sv, "v/1\1"sv, "<svg/>"sv, "<?xml version='1.0'?><svg><title>a</title></svg>"sv})
        EXPECT_EQ(kind_of(picture), "a picture") << picture;
    EXPECT_EQ(kind_of("<?xml version='1.0'?><Error/>"), "an XML file");
    EXPECT_EQ(kind_of(R"({"bendy_rig": 1, "joints": {}})"), "a rig file");
    EXPECT_EQ(kind_of(R"( {"$schema": "a \" {", "complete": true, "bendy_rig": 1})"), "a rig file");
    EXPECT_EQ(kind_of(R"({"name": {"asset": 1}})"), "a JSON file without a member of glTF");
    EXPECT_EQ(kind_of("[1]"), "a JSON file without a member of glTF");
    EXPECT_EQ(kind_of(R"({"accessors": [{"name": "bendy_rig"}]})"), "a glTF file");
    EXPECT_EQ(kind_of(R"({"scenes": [{"extras": {"bendy_rig": 1}}], "asset": {}})"), "a glTF file");
    EXPECT_EQ(why_not_convertible(Bytes(), "fox.bvh"), "is empty: copy or download it again");
    EXPECT_EQ(kind_of("PK\3\4"), "a ZIP archive");
    EXPECT_EQ(kind_of("\x1f\x8b\x08"), "a gzip archive");
    EXPECT_EQ(kind_of("# made by hand\nmtllib a.mtl\nv 1 2 3\n"), "an OBJ file");
    EXPECT_EQ(kind_of("solid a\nfacet normal 0 0 1\n"), "an STL file");
    EXPECT_EQ(kind_of("# notes of the verse\n"), "nothing");
    EXPECT_EQ(find_file_kind(bytes_of("anything"), "skin.TGA")->name, "a picture");
    EXPECT_FALSE(find_file_kind(std::filesystem::path("there/is/no.glb")));
}

TEST(Importers, ARigFileIsToldFromOtherFiles) {
    EXPECT_EQ(why_not_a_rig(bytes_of(R"({"bendy_rig": 1})")), "");
    EXPECT_EQ(why_not_a_rig(bytes_of(R"({"joints": {}})")), "") << "which the reader judges";
    EXPECT_EQ(why_not_a_rig(bytes_of("hinge")), "");
    EXPECT_EQ(why_not_a_rig(bytes_of("glTF")), "is a glTF binary file, not a rig file");
    EXPECT_EQ(why_not_a_rig(bytes_of("version https://git-lfs.github.com/spec/v1\n")),
              "is a Git LFS pointer, not a rig file: fetch the file that it stands for: git lfs pull");
}

TEST(Importers, SuggestedCommandsNameAFileAndNothingElse) {
    const auto kind = find_file_kind(bytes_of("glTF"), "fox.glb");
    ASSERT_TRUE(kind);
    EXPECT_TRUE(why_not_bendy(*kind, "a/fox.glb").ends_with(" bendy convert a/fox.glb"));
    EXPECT_TRUE(why_not_bendy(*kind, "$(touch x) it's.glb").ends_with(R"( bendy convert '$(touch x) it'\''s.glb')"));
    EXPECT_EQ(quoted_for_shell(""), "''");
}

TEST(Importers, EveryFormatHasOne) {
    std::set<SourceFormat> formats;
    for (const ReadableFormat& row : readable_formats()) formats.insert(row.format);
    EXPECT_EQ(formats.size(), 5u);
    for (const SourceFormat format : formats) EXPECT_EQ(importer_of(format).format, format);
}

}  // namespace
}  // namespace bendy::converter::importers_test
