#include <bendy/viewer/render.h>

#include "viewer/example_model.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace bendy::viewer::picture_maker_test {
namespace {

std::unique_ptr<PictureMaker> make(const Model& model, const RenderOptions& options) {
    return std::make_unique<PictureMaker>(model, options, [](const std::string& what) { ADD_FAILURE() << what; });
}

TEST(PictureMaker, ChangedOptionsGiveThePicturesOfANewOne) {
    const test::ExampleModel model(test::example("mannequin.glb"));
    RenderOptions first;
    first.width = 64;
    first.height = 48;
    first.draw.background = glm::vec4(0.0f);
    RenderOptions second;
    second.width = second.height = 96;
    second.clip = &model->clips().front();
    second.camera.distance = 1.5f;
    second.draw.bones = second.draw.axes = second.draw.constraints = true;

    std::vector<Picture> expected;  // first, since a thread has one context
    try {
        for (const RenderOptions* options : {&first, &second}) expected.push_back(make(*model, *options)->draw(0.4f));
    } catch (const ViewerError& problem) {
        GTEST_SKIP() << problem.what();
    }
    const auto maker = make(*model, first);
    for (const std::size_t which : {0u, 1u, 0u}) {
        maker->change(which == 0 ? first : second);
        const Picture picture = maker->draw(0.4f);
        EXPECT_EQ(picture.width, expected[which].width);
        EXPECT_EQ(picture.pixels, expected[which].pixels);
    }
    EXPECT_NE(expected[0].pixels, std::vector<std::uint8_t>(expected[0].pixels.size()));
}

}  // namespace
}  // namespace bendy::viewer::picture_maker_test
