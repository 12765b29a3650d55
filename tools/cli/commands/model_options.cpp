#include "commands/model_options.h"

#include "reports/messages.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <span>
#include <sstream>
#include <system_error>

namespace bendy::tools {

CLI::Option* add_character(CLI::App& command, std::filesystem::path& file) {
    return command.add_option("FILE", file,
                              "a bendy file, or one that `bendy convert` reads, which is converted on the fly");
}

CLI::Option* add_root(CLI::App& command, std::filesystem::path& root) {
    return command.add_option("--root", root, option_named("root").full_help())
        ->type_name("FOLDER")
        ->check(CLI::Validator(CLI::ExistingDirectory).description(""));
}

CLI::Option* add_clip(CLI::App& command, std::string& clip) {
    return command.add_option("--clip", clip, "the clip, " + std::string(kByKey) + "; the rest pose if not given");
}

const Clip& find_clip(const std::string& clip, const std::filesystem::path& file, const Model& model) {
    std::vector<std::string_view> names;
    for (const Clip& one : model.clips()) names.push_back(one.name);
    const auto found = find_by_key(names, clip, "clip");
    if (!found) {
        fail(file, printable(found.error().message) +
                       (names.empty() ? " (`bendy edit --retarget` or `--merge` brings some in)" : ""));
    }
    return model.clips()[*found];
}

std::pair<std::filesystem::path, std::string> split_clip(const std::string& text) {
    std::error_code ignored;
    std::size_t colon = text.rfind(':');
    if (std::filesystem::exists(text, ignored)) colon = std::string::npos;
    for (; colon != std::string::npos && colon > 0; colon = text.rfind(':', colon - 1)) {
        if (std::filesystem::exists(text.substr(0, colon), ignored))
            return {text.substr(0, colon), text.substr(colon + 1)};
    }
    return {text, ""};
}

void add_format(CLI::App& command, std::string& format, const std::vector<std::string>& formats) {
    command
        .add_option("--format", format,
                    "the format, if the output's name does not determine it; " + formats.front() +
                        " by default on standard output")
        ->check(one_of(formats));
}

std::vector<float> read_numbers(std::string_view text) {
    std::vector<float> numbers;
    while (true) {
        float number = 0.0f;
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (problem != std::errc() || !std::isfinite(number)) return {};
        numbers.push_back(number);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        if (text.empty()) return numbers;
        if (text.front() != ',') return {};
        text.remove_prefix(1);
    }
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
        warn(file, "the file has no levels of detail: full detail is used (bendy convert --lod makes them)");
}

Lod level_of(const std::filesystem::path& file, const Model& model, float share) {
    warn_without_levels(file, model, share);
    Lod lod(model);
    lod.set_share(share);
    return lod;
}

}  // namespace bendy::tools
