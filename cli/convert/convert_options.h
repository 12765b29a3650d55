#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

// The options of `convert` that decide which bytes come out: convert_options.def, for all interfaces.
namespace bendy::cli {

/// How options take one of several named things, see find_by_key.
constexpr std::string_view kByKey = "by name or number (#0 is always a number, =0 always a name)";

namespace option {
using flag = bool;
using word = std::string;
using path = std::filesystem::path;
using number = double;
}  // namespace option

/// An option of convert_options.def.
struct ConvertOption {
    std::string_view name;      ///< as of Python: `merge_clips`
    std::string_view values;    ///< of a word, with spaces between them; empty: any
    std::string_view excludes;  ///< names of options that it does not go with, with spaces between them
    std::string_view help;      ///< of the program; {key} stands for kByKey

    /// As of the program: `--merge-clips`.
    [[nodiscard]] std::string flag() const;
    /// With kByKey in it.
    [[nodiscard]] std::string full_help() const;
    /// Returns why the value is not one of the option's words, `images must be embed or link`; empty if it is.
    [[nodiscard]] std::string why_not(std::string_view value) const;
};

/// Splits a text at spaces.
std::vector<std::string> words_of(std::string_view text);

/// The values of those options.
struct ConvertChoices {
#define BENDY_CONVERT_OPTION(kind, name, standard, values, excludes, help) option::kind name = standard;
#include "convert/convert_options.def"
};

/// Calls visit(option, value) for each option of convert_options.def.
template <class Choices, class Visit>
void visit_options(Choices& choices, const Visit& visit) {
#define BENDY_CONVERT_OPTION(kind, name, standard, values, excludes, help) \
    visit(ConvertOption{#name, values, excludes, help}, choices.name);
#include "convert/convert_options.def"
}

/// The option of that name, which is there.
ConvertOption option_named(std::string_view name);

}  // namespace bendy::cli
