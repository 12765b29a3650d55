#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>

#include <cstdio>
#include <vector>

int main(int argc, char** argv) {
    const auto model = bendy::Model::open(argc > 1 ? argv[1] : "");
    if (!model)
        return std::printf("%s: %s\n", bendy::code_name(model.error().code), bendy::describe(model.error()).c_str()), 1;
    bendy::Pose pose(*model);
    std::vector<glm::vec3> positions(model->vertex_count());
    if (!bendy::skin(pose, {.out = {.positions = positions}})) return 1;
    std::printf("%zu joints, %zu vertices\n", model->joints().size(), positions.size());
}
