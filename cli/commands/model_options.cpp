#include "model_options.h"

#include "terminal/problem.h"

#include <bendy/format/names.h>

#include <charconv>
#include <string_view>
#include <system_error>
#include <vector>

namespace bendy::cli {

const Clip& find_clip(const std::string& clip, const std::filesystem::path& file, const Model& model) {
    std::size_t number = 0;
    const auto [end, problem] = std::from_chars(clip.data(), clip.data() + clip.size(), number);
    const bool is_number = problem == std::errc() && end == clip.data() + clip.size();
    if (is_number && number < model.clips().size()) return model.clips()[number];
    if (const Clip* found = model.clip(clip)) return *found;

    std::vector<std::string_view> names;
    for (const Clip& found : model.clips()) names.push_back(found.name);
    fail(file, printable(no_such_name("clip", clip, names)));
}

void add_lod(CLI::App& command, float& share) {
    command
        .add_option("--lod", share,
                    "one level of detail: about this fraction of the triangles, 0 to 1, and only their vertices")
        ->check([](const std::string& text) {
            float number = 0.0f;
            const bool is_good = CLI::detail::lexical_cast(text, number) && number >= 0.0f && number <= 1.0f;
            return is_good ? std::string() : std::string("must be a number from 0 to 1");
        })
        ->capture_default_str();
}

void warn_without_levels(const std::filesystem::path& file, const Model& model, float share) {
    if (share < 1.0f && model.collapse() == nullptr)
        warn(file, "there are no levels of detail in it: it stays whole (bendy convert --lod makes them)");
}

Lod level_of(const std::filesystem::path& file, const Model& model, float share) {
    warn_without_levels(file, model, share);
    Lod lod(model);
    lod.set_share(share);
    return lod;
}

}  // namespace bendy::cli
