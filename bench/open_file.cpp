// bench_open FILE...: what it takes from a file in the page cache to its first pose, beside mapping it and touching
// every page. By turns in one process; the least, in microseconds.
#include <bendy/format/file.h>
#include <bendy/runtime.h>

#include "side_by_side.h"

#include <cstddef>
#include <cstdio>
#include <vector>

namespace {

constexpr std::size_t kPage = 4096;

/// Something of every page, so that none is left out.
unsigned touch(const char* path) {
    unsigned sum = 0;
    const auto file = bendy::MappedFile::open(path);
    for (std::size_t at = 0; file && at < file->bytes().size(); at += kPage)
        sum += std::to_integer<unsigned>(file->bytes()[at]);
    return sum;
}

void open(const char* path, bendy::Sums sums, bool poses) {
    bendy::OpenOptions options;
    options.sums = sums;
    const auto model = bendy::Model::open(path, options);
    if (!model || !poses) return;
    bendy::Pose pose(*model);
    if (!model->cycles().empty()) (void)bendy::sample(pose, &model->cycles().front(), model->cycles().front().start);
    (void)pose.model_space();
}

}  // namespace

int main(int count, char** arguments) {
    std::printf("| file | bytes | touch | open | sums later | first pose | sums later | over touch |\n");
    std::printf("|---|---|---|---|---|---|---|---|\n");
    for (int k = 1; k < count; ++k) {
        const char* const path = arguments[k];
        const auto model = bendy::Model::open(path);
        const auto file = bendy::MappedFile::open(path);
        if (!model || !file) return 1;
        [[maybe_unused]] static volatile unsigned seen = 0;
        const std::vector<bendy::cli::Contestant> contestants{
            {"touch", [path] { seen = touch(path); }},
            {"open", [path] { open(path, bendy::Sums::checked, false); }},
            {"open, later", [path] { open(path, bendy::Sums::later, false); }},
            {"pose", [path] { open(path, bendy::Sums::checked, true); }},
            {"pose, later", [path] { open(path, bendy::Sums::later, true); }}};
        constexpr double kNanoseconds = 1000.0;  // in a microsecond
        const auto timings = bendy::cli::side_by_side(contestants, kNanoseconds);
        std::printf("| %s | %zu |", path, file->bytes().size());
        for (const auto& timing : timings) std::printf(" %.0f |", timing.least);
        std::printf(" %.1f |\n", timings[3].ratio);
        std::fflush(stdout);
    }
    return 0;
}
