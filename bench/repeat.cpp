// Repeats one stage of a file, for tools that count instructions. bendy_bench_repeat FILE lists the stages;
// bendy_bench_repeat FILE STAGE TIMES runs the stage of that number and prints its items. See instructions.sh.
#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>
#include <bendy/stages/stages.h>

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    if (argc != 2 && argc != 4) {
        std::fprintf(stderr, "usage: bendy_bench_repeat FILE [STAGE TIMES]\n");
        return 2;
    }
    const auto model = bendy::Model::open(argv[1]);
    if (!model) {
        std::fprintf(stderr, "bendy_bench_repeat: %s: %s\n", argv[1], bendy::describe(model.error()).c_str());
        return 1;
    }
    const auto open = [&](const bendy::OpenOptions& options) { return bendy::Model::open(argv[1], options); };
    const bendy::stages::Stages stages(open, *model, model->clips().empty() ? nullptr : model->clips().data());
    for (std::size_t k = 0; argc == 2 && k < stages.list().size(); ++k) {
        const bendy::stages::Stage& stage = stages.list()[k];
        std::printf("%zu\t%.0f\t%s\t%s\n", k, stage.items, stage.item, stage.name.c_str());
    }
    if (argc == 2) return 0;
    const std::size_t number = std::strtoul(argv[2], nullptr, 10);
    if (number >= stages.list().size()) return 1;
    for (unsigned long times = std::strtoul(argv[3], nullptr, 10); times > 0; --times) stages.list()[number].run();
    return 0;
}
