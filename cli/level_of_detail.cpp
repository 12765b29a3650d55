#include "level_of_detail.h"

#include "problem.h"

namespace bendy::cli {

void add_lod(CLI::App& command, float& share) {
    command
        .add_option("--lod", share,
                    "one level of detail: about this share of the triangles, 0 to 1, and only their vertices")
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
