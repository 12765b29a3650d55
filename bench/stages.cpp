// What each stage costs with each kernel: bendy_bench_stages [FILE.bendy...]

#include <bendy/runtime.h>
#include <bendy/runtime/kernels.h>

#include "side_by_side.h"
#include "skin_kernel.h"
#include "skin_plan.h"

#include <cmath>
#include <cstdio>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace {

using bendy::Kernel;
using bendy::bench::Contestant;
using bendy::bench::Timing;

void print_head(const char* what) {
    std::printf("\n%s\n\n| stage |", what);
    for (const Kernel kernel : bendy::kernels()) std::printf(" %s |", std::string(bendy::kernel_name(kernel)).c_str());
    std::printf("\n|---|");
    for (std::size_t k = 0; k < bendy::kernels().size(); ++k) std::printf("---|");
    std::printf("\n");
}

/// A row: median (least) of each kernel, in ns per item.
template <class Run>
void print_row(const std::string& stage, double items, const Run& run) {
    std::vector<Contestant> contestants;
    for (const Kernel kernel : bendy::kernels()) {
        contestants.push_back({"", [&run, kernel] {
                                   bendy::set_kernel(kernel);
                                   run();
                               }});
    }
    std::printf("| %s |", stage.c_str());
    for (const Timing& timing : bendy::bench::side_by_side(contestants, items))
        std::printf(" %.2f (%.2f) |", timing.median, timing.least);
    std::printf("\n");
    std::fflush(stdout);
    bendy::set_kernel(bendy::kernels().front());
}

struct Memory {
    explicit Memory(std::size_t vertices) : positions(vertices), normals(vertices), tangents(vertices) {}
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> tangents;
};

void measure_file(const char* path) {
    const auto model = bendy::Model::open(path);
    if (!model) {
        std::fprintf(stderr, "bendy_bench_stages: %s cannot be opened\n", path);
        return;
    }
    bendy::Pose pose(*model);
    const auto joints = static_cast<double>(model->joints().size());
    const auto vertices = static_cast<double>(model->vertex_count());
    Memory out(model->vertex_count());
    print_head((std::string(path) + ": " + std::to_string(model->joints().size()) + " joints, " +
                std::to_string(model->vertex_count()) + " vertices; ns per joint or vertex, median (least)")
                   .c_str());
    print_row("open, us", 1000.0, [&] { (void)bendy::Model::open(path); });
    if (!model->cycles().empty()) {
        const bendy::Cycle& cycle = model->cycles().front();
        float seconds = cycle.start;
        print_row("sample, next frame", joints, [&] {
            seconds += 1.0f / 60.0f;
            if (seconds > cycle.end) seconds = cycle.start;
            bendy::sample(&cycle, seconds, pose);
        });
        std::mt19937 random(1);
        std::uniform_real_distribution<float> anywhere(cycle.start, cycle.end);
        print_row("sample, random time", joints, [&] { bendy::sample(&cycle, anywhere(random), pose); });
    }
    print_row("local to model", joints, [&] { bendy::local_to_model(pose); });
    print_row("skin positions", vertices, [&] { bendy::skin(*model, pose, bendy::Vertices{out.positions, {}, {}}); });
    print_row("skin positions and normals", vertices, [&] {
        bendy::skin(*model, pose, bendy::Vertices{out.positions, out.normals, {}});
    });
    print_row("skin positions, normals and tangents", vertices, [&] {
        bendy::skin(*model, pose, bendy::Vertices{out.positions, out.normals, out.tangents});
    });
}

/// Vertices of four influences among 64 joints, near ones together, as characters have them.
void measure_synthetic(std::size_t vertices) {
    constexpr std::size_t kJoints = 64;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    std::vector<bendy::PaletteMatrix> palette(kJoints);
    for (bendy::PaletteMatrix& entry : palette) {
        const glm::mat3 m = glm::mat3_cast(
            glm::normalize(glm::quat(1.0f, 0.3f * number(random), 0.3f * number(random), 0.3f * number(random))));
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) entry.rows[row][column] = m[column][row];
            entry.rows[row][3] = number(random);
        }
    }
    std::vector<float> positions(3 * vertices), normals(3 * vertices), tangents(4 * vertices), weights(4 * vertices);
    std::vector<std::uint8_t> bones(4 * vertices);
    for (float& p : positions) p = number(random);
    for (float& n : normals) n = number(random);
    for (float& t : tangents) t = number(random);
    for (std::size_t v = 0; v < vertices; ++v) {
        for (std::size_t k = 0; k < 4; ++k) {
            bones[4 * v + k] = static_cast<std::uint8_t>((v * kJoints / vertices + random() % 6) % kJoints);
            weights[4 * v + k] = 0.25f;
        }
    }
    Memory out(vertices);
    bendy::SkinBlock block{};
    block.vertices = vertices;
    block.palette = palette.data();
    block.bones8 = bones.data();
    block.weights = weights.data();
    block.influences = 4;
    block.positions = positions.data();
    block.normals = normals.data();
    block.tangents = tangents.data();
    block.streams = vertices >= bendy::kManyVertices;
    bendy::Pool pool;
    pool.vertices = static_cast<std::uint32_t>(vertices);
    bendy::StreamView stream;
    stream.type = bendy::ComponentType::u8;
    stream.components = 4;
    stream.elements = pool.vertices;
    stream.data = std::as_bytes(std::span(bones));
    pool.bones = stream;
    stream.type = bendy::ComponentType::f32;
    stream.data = std::as_bytes(std::span(weights));
    pool.weights = stream;
    const bendy::SkinPlan plan = bendy::make_skin_plan(pool);
    block.plan_first = plan.first.data();
    block.plan_bones = plan.bones.data();
    block.plan_weights = plan.weights.front().of;
    print_head((std::to_string(vertices) + " vertices of 4 influences; ns per vertex, median (least)").c_str());
    const auto run = [&] { bendy::skin_kernel(bendy::kernel())(block); };
    block.out_positions = {&out.positions.front().x, 3};
    print_row("positions", static_cast<double>(vertices), run);
    block.out_normals = {&out.normals.front().x, 3};
    print_row("positions and normals", static_cast<double>(vertices), run);
    block.out_tangents = {&out.tangents.front().x, 4};
    print_row("positions, normals and tangents", static_cast<double>(vertices), run);
}

}  // namespace

int main(int count, char** arguments) {
    for (int k = 1; k < count; ++k) measure_file(arguments[k]);
    if (count > 1) return 0;
    for (const std::size_t vertices : {1'000u, 100'000u, 1'000'000u}) measure_synthetic(vertices);
    return 0;
}
