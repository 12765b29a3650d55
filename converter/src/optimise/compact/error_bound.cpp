#include <bendy/converter/error_bound.h>
#include <bendy/format/charconv.h>
#include <bendy/format/names.h>

#include <array>
#include <cmath>
#include <system_error>

namespace bendy::converter {
namespace {

struct Unit {
    std::string_view name;
    double factor;
    bool is_share;
};
constexpr std::array<Unit, 5> kUnits{
    {{"mm", 1e-3, false}, {"cm", 1e-2, false}, {"um", 1e-6, false}, {"m", 1.0, false}, {"%", 1e-2, true}}};

}  // namespace

Result<ErrorBound, std::string> parse_error_bound(std::string_view text) {
    double value = 0.0;
    const auto [end, failure] = from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc())
        return in_quotes(text) + " is not an error bound; write a length, as 0.1mm, or a share, as 0.005%";
    std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
    while (unit.starts_with(' ')) unit.remove_prefix(1);
    if (unit.empty()) {
        const std::string number(text);
        return in_quotes(text) + " has no unit; write " + number + "mm, " + number + "cm, " + number + "m, " + number +
               "um, or " + number + "% of the character's height";
    }
    for (const Unit& known : kUnits) {
        if (unit != known.name) continue;
        if (!(value > 0.0) || !std::isfinite(value)) return in_quotes(text) + " is not above zero";
        return ErrorBound{value * known.factor, known.is_share};
    }
    return "unknown unit " + in_quotes(unit) + " in " + in_quotes(text) + "; the units are mm, cm, m, um and %";
}

}  // namespace bendy::converter
