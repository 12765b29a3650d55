#include "convert/convert_options.h"

#include <algorithm>

namespace bendy::cli {

std::string ConvertOption::flag() const {
    std::string flag = "--" + std::string(name);
    std::replace(flag.begin(), flag.end(), '_', '-');
    return flag;
}

std::string ConvertOption::full_help() const {
    constexpr std::string_view kPlace = "{key}";
    std::string text(help);
    if (const std::size_t place = text.find(kPlace); place != std::string::npos)
        text.replace(place, kPlace.size(), kByKey);
    return text;
}

ConvertOption option_named(std::string_view name) {
    ConvertOption found;
    const ConvertChoices choices;
    visit_options(choices, [&](const ConvertOption& option, const auto&) {
        if (option.name == name) found = option;
    });
    return found;
}

}  // namespace bendy::cli
