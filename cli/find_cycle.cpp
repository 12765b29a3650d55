#include "find_cycle.h"

#include "problem.h"

#include <bendy/format/names.h>

#include <charconv>
#include <string_view>
#include <system_error>
#include <vector>

namespace bendy::cli {

const Cycle& find_cycle(const std::string& clip, const std::filesystem::path& file, const Model& model) {
    std::size_t number = 0;
    const auto [end, problem] = std::from_chars(clip.data(), clip.data() + clip.size(), number);
    const bool is_number = problem == std::errc() && end == clip.data() + clip.size();
    if (is_number && number < model.cycles().size()) return model.cycles()[number];
    if (const Cycle* cycle = model.cycle(clip)) return *cycle;

    std::vector<std::string_view> names;
    for (const Cycle& cycle : model.cycles()) names.push_back(cycle.name);
    fail(file, printable(no_such_name("clip", clip, names)));
}

}  // namespace bendy::cli
