// Poses a file in several ways and prints what comes out, to the bit: pose_with_kernel KERNEL FILE. Compiled with the
// library, and with bendy_runtime.cpp alone: both must print the same.
#ifdef BENDY_AMALGAMATED
#include "bendy_runtime.h"
#else
#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>
#include <bendy/runtime/kernels.h>
#endif

#include <bit>
#include <cstdio>
#include <cstring>
#include <vector>

namespace {

void print(const bendy::Model& model, bendy::Pose& pose, const bendy::Lod& lod) {
    std::vector<glm::vec3> positions(model.vertex_count());
    std::vector<glm::vec3> normals(model.vertex_count());
    (void)bendy::skin(pose, {.lod = &lod, .out = {.positions = positions, .normals = normals}});
    for (std::size_t k = 0; k < positions.size(); ++k) {
        for (int c = 0; c < 3; ++c)
            std::printf("%08x %08x ", std::bit_cast<unsigned>(positions[k][c]), std::bit_cast<unsigned>(normals[k][c]));
        std::puts("");
    }
}

void pose_all(const bendy::Model& model) {
    bendy::Pose pose(model);
    bendy::Lod lod(model);
    print(model, pose, lod);
    for (const bendy::Clip& clip : model.clips()) {
        (void)bendy::sample(pose, &clip, clip.start + 0.3f * (clip.end - clip.start));
        print(model, pose, lod);
    }
    bendy::Pose rest(model);
    (void)bendy::blend(pose, rest, 0.4f);
    bendy::constrain(pose);
    for (const bendy::Chain& chain : model.chains()) (void)bendy::reach(pose, &chain, glm::vec3(0.2f, 0.5f, 0.1f));
    lod.set_share(0.5f);
    print(model, pose, lod);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    bool is_set = false;
    for (const bendy::Kernel kernel : bendy::kernels()) {
        if (bendy::kernel_name(kernel) == argv[1]) is_set = bendy::set_kernel(kernel).has_value();
    }
    if (!is_set) {
        std::printf("no kernel %s on this machine\n", argv[1]);
        return 0;
    }
    const auto model = bendy::Model::open(argv[2]);
    if (!model) {
        std::printf("%s: %s\n", bendy::code_name(model.error().code), bendy::describe(model.error()).c_str());
        return 1;
    }
    pose_all(*model);
    return 0;
}
