#include "commands/choices.h"
#include "commands/commands.h"
#include "files/signals.h"
#include "reports/console.h"
#include "reports/messages.h"

#include <bendy/format/file.h>
#include <bendy/format/names.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace {

using bendy::tools::enumerate;
using bendy::tools::suggest;

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongCommandLine = 2;

std::vector<std::string> commands_of(const CLI::App& program) {
    std::vector<std::string> names;
    for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
    return names;
}

std::vector<std::string> options_of(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_group().empty()) continue;  // for tests
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

std::string unknown_option(const CLI::App& command, const std::string& word) {
    const std::string name = word.substr(0, word.find('='));
    const std::vector<std::string> options = options_of(command);
    std::vector<std::string_view> bare;  // the dashes, which all have, would make short ones alike
    bare.reserve(options.size());
    for (const std::string& option : options) bare.push_back(std::string_view(option).substr(2));
    const std::string meant(bendy::nearest_name(bare, name.substr(std::min(name.find_first_not_of('-'), name.size()))));
    return "there is no option " + name + (meant.empty() ? "" : "; did you mean \"--" + meant + "\"?");
}

/// The words that no option or argument consumed, in order.
std::string unexpected(const CLI::App& command, const std::vector<std::string>& words) {
    if (command.get_parent() == nullptr) {
        const std::string& word = words.front();
        if (word.starts_with('-')) return unknown_option(command, word);
        std::error_code ignored;
        if (std::filesystem::exists(std::u8string(word.begin(), word.end()), ignored))
            return "a command is missing before " + word + ": inspect, view or another";
        return "there is no command " + word + suggest(commands_of(command), word);
    }
    return (words.size() == 1 ? "one argument too many: " : "too many arguments: ") + enumerate(words);
}

/// The arguments that the command requires, as in its usage: positional ones first, in order.
std::string missing(const CLI::App& command) {
    std::vector<std::string> places;
    std::vector<std::string> options;
    for (const CLI::Option* option : command.get_options()) {
        if (!option->get_required() || option->count() != 0) continue;
        (option->get_positional() ? places : options).push_back(option->get_name(option->get_positional()));
    }
    places.insert(places.end(), options.begin(), options.end());
    return enumerate(places) + (places.size() == 1 ? " is missing" : " are missing");
}

/// Rewrites CLI11's message in the style of this program.
std::string in_own_words(const CLI::App& command, const CLI::Error& problem) {
    const std::vector<std::string> left = command.remaining();
    const auto option = std::find_if(left.begin(), left.end(),
                                     [](const std::string& word) { return word.size() > 1 && word.starts_with('-'); });
    // A mistyped option comes first: it is the reason that the value after it is left over or missing.
    if (option != left.end() && command.get_parent() != nullptr) return unknown_option(command, *option);
    if (!left.empty()) return unexpected(command, left);
    if (problem.get_name() == "RequiredError") return missing(command);
    std::string what = problem.what();
    const std::string name = what.substr(0, what.find(": "));
    const CLI::Option* const named = command.get_option_no_throw(name);
    if (problem.get_name() == "ArgumentMismatch" && named != nullptr && named->get_items_expected_min() > 0 &&
        named->count() <= static_cast<std::size_t>(named->get_items_expected_max()))
        return name + " needs a value";
    return what;
}

/// Returns why the command line is wrong.
std::string explain(const CLI::App* program, const CLI::Error& problem) {
    const auto commands = program->get_subcommands();
    const CLI::App& command = commands.empty() ? *program : *commands.front();
    return bendy::tools::error_label() + bendy::tools::printable(in_own_words(command, problem)) + "\nTry `bendy " +
           (commands.empty() ? "" : command.get_name() + ' ') + "--help`.\n";
}

/// `bendy help convert` is `bendy convert --help`.
std::vector<std::string> with_help_as_option(std::vector<std::string> words) {
    if (words.empty() || words.front() != "help") return words;
    words.erase(words.begin());
    if (!words.empty() && (words.front() == "help" || words.front().starts_with('-'))) words.clear();
    words.insert(words.begin() + (words.empty() ? 0 : 1), "--help");
    return words;
}

/// CLI11's help, with one empty line between groups of options in place of two.
class HelpFormatter : public CLI::Formatter {
public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
        return CLI::detail::find_and_replace(CLI::Formatter::make_help(app, std::move(name), mode), "\n\n\n", "\n\n");
    }
};

int run(std::vector<std::string> words) {
    if (words.empty()) words = {"--help"};
    CLI::App program("Bendy: animated characters in one file of nested chunks.", "bendy");
    program.formatter(std::make_shared<HelpFormatter>());
    program.allow_windows_style_options(false);  // /folder/file is a file on all systems
    program.set_version_flag("--version", "bendy " BENDY_VERSION);
    program.require_subcommand(1);
    program.failure_message(explain);
    program.footer("Try `bendy help convert`, or: bendy convert fox.glb && bendy inspect fox.bendy");
    bendy::tools::add_convert(program);
    bendy::tools::add_inspect(program);
    bendy::tools::add_validate(program);
    bendy::tools::add_pose(program);
    bendy::tools::add_render(program);
    bendy::tools::add_rig(program);
    bendy::tools::add_diff(program);
    bendy::tools::add_dump(program);
    bendy::tools::add_assemble(program);
    bendy::tools::add_edit(program);
    bendy::tools::add_export(program);
    bendy::tools::add_view(program);
    bendy::tools::add_bench(program);
    try {
        words = with_help_as_option(std::move(words));
        const bool asks_for_help = words.size() > 1 && words[1] == "--help";
        const auto commands = commands_of(program);
        if (asks_for_help && std::find(commands.begin(), commands.end(), words.front()) == commands.end())
            words.pop_back();  // an unknown command is reported as such, without the program's help
        program.parse(std::vector(words.rbegin(), words.rend()));  // CLI11 takes the last one first
    } catch (const CLI::ParseError& problem) {
        if (program.exit(problem) != 0) return kWrongCommandLine;  // otherwise it was a request for help
    } catch (const bendy::tools::Failed& failed) {
        std::cout.flush();
        return failed.status;
    }
    std::cout.flush();
    if (std::cout) return kDone;
    std::cerr << bendy::tools::error_label() << "standard output cannot be written\n";
    return kFailed;
}

void say_that_memory_is_out() {
    std::fputs("bendy: error: not enough memory\n", stderr);
}

/// A destructor that finds no memory, such as that of JSON, ends the program.
[[noreturn]] void end_for_lack_of_memory() {
    try {
        if (const std::exception_ptr problem = std::current_exception()) std::rethrow_exception(problem);
    } catch (const std::bad_alloc&) {
        bendy::remove_temporary_files();
        say_that_memory_is_out();
        std::_Exit(bendy::tools::status_of_failures());
    } catch (...) {  // a fault of this program
    }
    std::abort();
}

}  // namespace

int main(int argc, char** argv) {
    std::set_terminate(end_for_lack_of_memory);
    try {
        bendy::tools::prepare_console();
        bendy::tools::watch_signals();
        return run(bendy::tools::command_line(argc, argv));
    } catch (const std::bad_alloc&) {
        say_that_memory_is_out();
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bendy: error: %s\n", bendy::tools::printable(problem.what()).c_str());
    } catch (...) {
        std::fputs("bendy: error: an unknown error occurred\n", stderr);
    }
    return kFailed;
}
