// bench_open FILE...: what opening a bendy file costs, beside a plain read of its bytes. Best of many runs, in
// microseconds.
#include <bendy/runtime.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <limits>
#include <vector>

namespace {

template <class Work>
double best_of(int runs, const Work& work) {
    double best = std::numeric_limits<double>::max();
    for (int run = 0; run < runs; ++run) {
        const auto start = std::chrono::steady_clock::now();
        work();
        const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
        best = std::min(best, took.count());
    }
    return best;
}

}  // namespace

int main(int count, char** arguments) {
    constexpr int kRuns = 200;
    std::printf("| file | bytes | read, us | open, us | over 1.5 x read, us |\n|---|---|---|---|---|\n");
    for (int k = 1; k < count; ++k) {
        std::vector<char> bytes;
        const double read = best_of(kRuns, [&] {
            std::ifstream file(arguments[k], std::ios::binary | std::ios::ate);
            bytes.resize(static_cast<std::size_t>(file.tellg()));
            file.seekg(0);
            file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        });
        bool is_good = true;
        const double open = best_of(kRuns, [&] { is_good = bendy::Model::open(arguments[k]).has_value(); });
        if (!is_good) return 1;
        std::printf("| %s | %zu | %.0f | %.0f | %.0f |\n", arguments[k], bytes.size(), read, open, open - 1.5 * read);
    }
    return 0;
}
