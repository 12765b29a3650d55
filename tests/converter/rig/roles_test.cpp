#include "build_scene.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/export.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace bendy::converter::rig_roles_test {
namespace {

using namespace test;

/// "pelvis hips 0" for each role of the scene.
std::vector<std::string> roles_of(const Scene& scene) {
    std::vector<std::string> lines;
    for (const RoleRecord& record : scene.roles) {
        lines.push_back(scene.joints[record.joint].name + ' ' + std::string(kValueNames<Role>.at(record.role)) + ' ' +
                        std::to_string(record.place));
    }
    return lines;
}

void attach_to(Scene& scene, const std::string& roles) {
    Report report;
    const Rig rig = parse_rig(R"({"bendy_rig": 1, "roles": )" + roles + "}", report);
    attach_roles(scene, rig, JointIndex(scene));
}

/// The place and the message of the error.
std::string error_of(const std::string& roles) {
    Scene scene = make_row({"pelvis", "tail_a", "tail_b"});
    try {
        attach_to(scene, roles);
    } catch (const Failure& failure) {
        EXPECT_TRUE(scene.roles.empty());
        return failure.error.place + ": " + failure.error.message;
    }
    return {};
}

TEST(RigRoles, AreAttachedByName) {
    Scene scene = make_row({"pelvis", "tail_a", "tail_b", "#1"});
    attach_to(scene, R"({"tail": ["tail_b", "#1"], "hips": "pelvis", "jaw": "=#1"})");
    EXPECT_EQ(roles_of(scene),
              (std::vector<std::string>{"pelvis hips 0", "tail_a tail 1", "tail_b tail 0", "#1 jaw 0"}));
}

TEST(RigRoles, WinOverWhatWasFound) {
    Scene scene = make_row({"a", "b", "c", "d", "e"});
    attach_to(scene, R"({"hips": "a", "head": "b", "jaw": "c", "tail": ["d", "e"]})");
    attach_to(scene, R"({"hips": "b", "jaw": null, "tail": ["e"]})");
    EXPECT_EQ(roles_of(scene), (std::vector<std::string>{"b hips 0", "e tail 0"}));
    attach_to(scene, R"({"tail": []})");
    EXPECT_EQ(roles_of(scene), std::vector<std::string>{"b hips 0"});
    attach_to(scene, "{}");
    EXPECT_EQ(roles_of(scene), std::vector<std::string>{"b hips 0"});
}

TEST(RigRoles, SayWhatIsWrong) {
    EXPECT_EQ(error_of(R"({"hip": "pelvis"})"), "roles.hip: there is no role 'hip'");
    EXPECT_EQ(error_of(R"({"none": "pelvis"})"), "roles.none: there is no role 'none'");
    EXPECT_EQ(error_of(R"({"hips": "Pelvis"})"), "roles.hips: there is no joint 'Pelvis'; did you mean \"pelvis\"?");
    EXPECT_EQ(error_of(R"({"hips": 3})"), "roles.hips: expected the name of a joint, found 3");
    EXPECT_EQ(error_of(R"({"hips": ["pelvis"]})"), "roles.hips: expected the name of a joint, found array");
    EXPECT_EQ(error_of(R"({"tail": ["tail_a", "tail_c"]})").substr(0, 15), "roles.tail[1]: ");
    EXPECT_EQ(error_of(R"({"hips": "pelvis", "tail": ["pelvis"]})"),
              "roles.tail[0]: joint 'pelvis' has another role here");
    EXPECT_NE(error_of(R"({"tail": "tail_a"})"), "");
    EXPECT_NE(error_of(R"(["hips"])"), "");
}

TEST(RigRoles, AreWritten) {
    Scene scene = make_row({"pelvis", "tail_a", "tail_b", "twice", "twice"});
    attach_to(scene, R"({"tail": ["tail_b", "tail_a"], "hips": "pelvis", "head": "#4"})");
    Report report;
    const std::vector<std::byte> bytes = build_chunks(scene, "test", report);
    EXPECT_TRUE(validate(bytes).empty());
    const Result<ChunkTree> tree = read_chunk_tree(bytes);
    Faults faults;
    const Document document = read_document(*tree, faults);
    const std::string text = write_rig(document.objects.at(0));
    EXPECT_NE(text.find(R"("hips": "pelvis")"), std::string::npos) << text;
    Scene again = make_row({"pelvis", "tail_a", "tail_b", "twice", "twice"});
    attach_roles(again, parse_rig(text, report), JointIndex(again));
    EXPECT_EQ(roles_of(again), roles_of(scene));
}

}  // namespace
}  // namespace bendy::converter::rig_roles_test
