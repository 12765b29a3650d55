#include "round_trip.h"

#include "format/edit_file.h"
#include "format/packed_samples.h"

#include <bendy/format/packed_clip.h>

namespace bendy::test::packed_test {
namespace {

Buffer file_with(Bytes packed) {
    return to_file(make_container(FourCC("HEAD"), {make_leaf(FourCC("PACK"), packed)}));
}

TEST(PackedText, TracksOfAllListsRoundTripAsNumbers) {
    for (const std::uint32_t joints : {1u, 7u, 8u, 9u, 40u}) {
        for (const std::uint32_t segment : {0u, 1u, 5u}) {
            PackedSamples samples = make_samples(joints, 12, segment);
            for (const bool is_even : {true, false}) {
                if (!is_even) {
                    samples.frame_rate = 0.0f;
                    for (std::uint32_t f = 0; f < samples.frames; ++f)
                        samples.times.push_back(0.5f + 0.1f * static_cast<float>(f));
                }
                const auto payload = write_packed(samples);
                ASSERT_TRUE(payload);
                const Buffer file = file_with(*payload);
                expect_same_bytes(file);
                const std::string text = dumped(file);
                EXPECT_NE(text.find("\"joints_0\": [0"), std::string::npos) << text;
                EXPECT_EQ(text.find("\"more\""), std::string::npos) << text;
                EXPECT_EQ(text.find("\"tracks\""), std::string::npos) << text;
            }
        }
    }
}

TEST(PackedText, BitsFlipped) {
    const auto payload = write_packed(make_samples(9, 5, 2));
    ASSERT_TRUE(payload);
    for (std::size_t bit = 0; bit < payload->size() * 8; bit += 3) {
        std::vector<std::byte> changed = *payload;
        changed[bit / 8] ^= std::byte{1} << (bit % 8);
        expect_same_bytes(file_with(changed));
        if (HasFailure()) FAIL() << "bit " << bit;
    }
}

TEST(PackedText, NumbersThatDoNotFitAreNamed) {
    PackedSamples samples;
    samples.frames = 3;
    samples.joints = 2;
    samples.tracks.push_back({TrackPath::rotation, 1, {112, 112, 112}, 3, true, {0, 1, 3, 0, 0, 0, 0, 0, 0}});
    const auto payload = write_packed(samples);
    ASSERT_TRUE(payload);
    const std::string text = dumped(file_with(*payload));
    EXPECT_EQ(fault_of(edited(text, "\"joints_1\": [1]", "\"joints_1\": [2]")),
              "4:16: \"joints_1\" ascends, and each number is below \"joints\"");
    const std::size_t frames = text.find("\"frames_0\"");
    ASSERT_NE(frames, std::string::npos) << text;
    std::string wide = text;
    wide.replace(wide.find("3", frames), 1, "4");
    EXPECT_NE(fault_of(wide).find(": \"frames_0\": the number needs more than its 2 bits"), std::string::npos)
        << fault_of(wide);
}

}  // namespace
}  // namespace bendy::test::packed_test
