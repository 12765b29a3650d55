#include <bendy/runtime.h>

#include <cstdio>
#include <vector>

// The README's embedding example, as an outside project builds it.
int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const auto model = bendy::Model::open(argv[1]);
    if (!model) {
        std::fprintf(stderr, "%s\n", bendy::code_name(model.error().code));
        return 1;
    }
    bendy::Pose pose(*model);
    std::vector<glm::vec3> positions(model->vertex_count());
    if (!model->clips().empty()) (void)bendy::sample(pose, &model->clips()[0], 0.0f);
    if (!bendy::skin(pose, {.out = {.positions = positions}}) || positions.empty()) return 1;
    std::printf("%zu joints, first vertex at %g %g %g\n", model->joints().size(), double{positions[0].x},
                double{positions[0].y}, double{positions[0].z});
    return 0;
}
