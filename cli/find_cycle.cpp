#include "find_cycle.h"

#include "problem.h"

#include <charconv>
#include <system_error>

namespace bendy::cli {

const Cycle& find_cycle(const std::string& clip, const std::filesystem::path& file, const Model& model) {
    std::size_t number = 0;
    const auto [end, problem] = std::from_chars(clip.data(), clip.data() + clip.size(), number);
    const bool is_number = problem == std::errc() && end == clip.data() + clip.size();
    if (is_number && number < model.cycles().size()) return model.cycles()[number];
    if (const Cycle* cycle = model.cycle(clip)) return *cycle;

    std::string known;
    for (std::size_t i = 0; i < model.cycles().size(); ++i) {
        const std::string_view name = model.cycles()[i].name;
        known += (i == 0 ? "" : ", ") + (name.empty() ? "number " + std::to_string(i) : printable(name));
    }
    fail(file,
         "there is no cycle \"" + printable(clip) + "\"; there " +
             (model.cycles().empty() ? "are none" : "are " + std::to_string(model.cycles().size()) + ": " + known));
}

}  // namespace bendy::cli
