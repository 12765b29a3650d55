// bendy_bench_open FILE... [--benchmark_...]: the time from a file in the page cache to its first pose, and the time
// for mapping it and reading from every page. bench/ratios.py prints the ratio.
#include <bendy/format/file.h>
#include <bendy/runtime.h>

#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>

namespace {

using namespace bendy;

constexpr std::size_t kPage = 4096;

/// Reads a byte of every page.
unsigned touch(const std::string& path) {
    unsigned sum = 0;
    const auto file = MappedFile::open(path);
    for (std::size_t at = 0; file && at < file->bytes().size(); at += kPage)
        sum += std::to_integer<unsigned>(file->bytes()[at]);
    return sum;
}

void open(const std::string& path, Sums sums, bool poses) {
    OpenOptions options;
    options.sums = sums;
    const auto model = Model::open(path, options);
    if (!model || !poses) return;
    Pose pose(*model);
    if (!model->clips().empty()) (void)sample(pose, &model->clips().front(), model->clips().front().start);
    (void)pose.model_space();
}

void add(const std::string& name, const std::function<void()>& run) {
#ifndef __clang_analyzer__  // reports a leak, although the library's list frees the benchmarks
    benchmark::RegisterBenchmark(name.c_str(), [run](benchmark::State& state) {
        while (state.KeepRunning()) run();
    })->Unit(benchmark::kMicrosecond);
#endif
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    for (int k = 1; k < argc; ++k) {
        const std::string path = argv[k];
        if (!Model::open(path)) {
            std::fprintf(stderr, "bendy_bench_open: %s: expected a bendy file\n", argv[k]);
            return 1;
        }
        const std::string name = std::filesystem::path(path).stem().string();
        add(name + "/touch", [path] { benchmark::DoNotOptimize(touch(path)); });
        add(name + "/open", [path] { open(path, Sums::checked, false); });
        add(name + "/open, sums later", [path] { open(path, Sums::later, false); });
        add(name + "/first pose", [path] { open(path, Sums::checked, true); });
        add(name + "/first pose, sums later", [path] { open(path, Sums::later, true); });
    }
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
