#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

// The options of `convert` that determine the output's bytes: convert_options.def, for all interfaces.
namespace bendy::tools {

/// How an option selects one of several named things, see find_by_key.
constexpr std::string_view kByKey = "by name or number (#0 is always a number, =0 always a name)";

namespace option {
using flag = bool;
using word = std::string;
using path = std::filesystem::path;
using number = double;
}  // namespace option

/// An option of convert_options.def.
struct ConvertOption {
    std::string_view name;      ///< as in Python: `merge_clips`
    std::string_view values;    ///< the words that it accepts, separated by spaces; empty: any
    std::string_view excludes;  ///< names of options that exclude it, separated by spaces
    std::string_view group;     ///< its heading in the program's help; empty: among the common ones
    std::string_view help;      ///< for the program; {key} stands for kByKey

    /// The name in the program: `--merge-clips`.
    [[nodiscard]] std::string flag() const;
    /// The help with kByKey filled in.
    [[nodiscard]] std::string full_help() const;
    /// Returns why the value is not one of the option's words, `images must be embed or link`; empty if it is.
    [[nodiscard]] std::string why_not(std::string_view value) const;
};

/// Splits a text at spaces.
std::vector<std::string> words_of(std::string_view text);

/// The values of those options.
struct ConvertChoices {
#define BENDY_CONVERT_OPTION(kind, name, standard, values, excludes, group, help) option::kind name = standard;
#include "reports/convert_options.def"
};

/// Calls visit(option, value) for each option of convert_options.def.
template <class Choices, class Visit>
void visit_options(Choices& choices, const Visit& visit) {
#define BENDY_CONVERT_OPTION(kind, name, standard, values, excludes, group, help) \
    visit(ConvertOption{#name, values, excludes, group, help}, choices.name);
#include "reports/convert_options.def"
}

/// Returns the option of that name, which must exist.
ConvertOption option_named(std::string_view name);

}  // namespace bendy::tools
