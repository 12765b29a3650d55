// What examples/draw.c prints, computed with the C++ API: draw_numbers FILE.bendy CLIP CLIP CHAIN X Y Z
#include <bendy/runtime.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

int main(int argc, char** argv) {
    if (argc != 8) return 2;
    const auto model = bendy::Model::open(argv[1]);
    if (!model) return 1;
    const bendy::Clip* const from = model->clip(argv[2]);
    const bendy::Clip* const to = model->clip(argv[3]);
    if (from == nullptr || to == nullptr) return 1;
    bendy::Pose pose(*model);
    bendy::Pose scratch(*model);
    bendy::Crossfade fade;
    fade.play(*from, 0.0f);
    fade.advance(0.5);
    fade.play(*to, 0.4f);
    fade.advance(0.2);
    if (!bendy::sample(pose, fade, scratch)) return 1;
    const auto number = [&](int k) { return static_cast<float>(std::atof(argv[k])); };
    const auto result = bendy::reach(pose, model->chain(argv[4]), glm::vec3(number(5), number(6), number(7)));
    if (!result) return 1;
    for (const bendy::Playing& playing : fade.playing())
        std::printf("%s at %.9g s: %.9g of the pose\n", std::string(playing.clip->name).c_str(),
                    double{playing.playback.seconds()}, double{playing.share});
    std::printf("%s: %.9g m from the target\n", argv[4], double{result->distance});
    std::vector<glm::vec3> positions(model->vertex_count());
    std::vector<glm::vec3> normals(model->vertex_count());
    if (!bendy::skin(pose, {.out = {.positions = positions, .normals = normals}})) return 1;
    double sums[2]{};
    for (std::size_t k = 0; k < positions.size() * 3; ++k) {
        const auto axis = static_cast<int>(k % 3);
        sums[0] += static_cast<double>(k % 7 + 1) * double{positions[k / 3][axis]};
        sums[1] += static_cast<double>(k % 7 + 1) * double{normals[k / 3][axis]};
    }
    std::printf("weighted sums of positions and normals: %.17g %.17g\n", sums[0], sums[1]);
}
