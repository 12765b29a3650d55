#include "commands/commands.h"
#include "files/signals.h"
#include "terminal/console.h"
#include "terminal/messages.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <bendy/format/names.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongCommandLine = 2;

/// "a, b and c"
std::string enumerate(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t k = 0; k < words.size(); ++k) {
        if (k != 0) text += k + 1 == words.size() ? " and " : ", ";
        text += words[k];
    }
    return text;
}

std::string suggest(const std::vector<std::string>& words, const std::string& wanted) {
    return bendy::did_you_mean(std::vector<std::string_view>(words.begin(), words.end()), wanted);
}

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
    return "there is no option " + name + suggest(options_of(command), name);
}

/// The words that no option and no argument took, in the order in which they were given.
std::string unexpected(const CLI::App& command, const std::vector<std::string>& words) {
    if (command.get_parent() == nullptr) {
        const std::string& word = words.front();
        return word.starts_with('-') ? unknown_option(command, word)
                                     : "there is no command " + word + suggest(commands_of(command), word);
    }
    return (words.size() == 1 ? "one argument too many: " : "too many arguments: ") + enumerate(words);
}

/// The arguments that the command cannot do without, as its usage has them: first what stands at a place, in order.
std::string missing(const CLI::App& command) {
    if (command.get_parent() == nullptr) return "a command is missing; there are " + enumerate(commands_of(command));
    std::vector<std::string> places;
    std::vector<std::string> options;
    for (const CLI::Option* option : command.get_options()) {
        if (!option->get_required() || option->count() != 0) continue;
        (option->get_positional() ? places : options).push_back(option->get_name(option->get_positional()));
    }
    places.insert(places.end(), options.begin(), options.end());
    return enumerate(places) + (places.size() == 1 ? " is missing" : " are missing");
}

/// The words of a set such as "{png,gif,webp}" at the end of what CLI11 says of a value outside it.
std::string wrong_word(const std::string& what) {
    constexpr std::string_view kBefore = " not in {";
    const std::size_t at = what.rfind(kBefore);
    const std::size_t colon = what.find(": ");
    if (at == std::string::npos || colon == std::string::npos || colon > at || !what.ends_with('}')) return what;
    std::vector<std::string> words;
    std::istringstream list(what.substr(at + kBefore.size(), what.size() - 1 - at - kBefore.size()));
    for (std::string word; std::getline(list, word, ',');) words.push_back(word);
    const std::string given = what.substr(colon + 2, at - colon - 2);
    const std::string suggestion = suggest(words, given);
    return what.substr(0, colon) + ": \"" + given + "\" is not a choice" +
           (suggestion.empty() ? "; " : suggestion + ' ') + "choose one of " + enumerate(words);
}

/// What CLI11 says, in the words of this program.
std::string in_own_words(const CLI::App& command, const CLI::Error& problem) {
    const std::vector<std::string> left = command.remaining();
    const auto option = std::find_if(left.begin(), left.end(),
                                     [](const std::string& word) { return word.size() > 1 && word.starts_with('-'); });
    // A mistyped option first: what followed it is a value, or is missing, because of it.
    if (option != left.end() && command.get_parent() != nullptr) return unknown_option(command, *option);
    if (!left.empty()) return unexpected(command, left);
    const std::string what = problem.what();
    if (problem.get_name() == "RequiredError") return missing(command);
    const std::size_t colon = what.find(": ");
    if (problem.get_name() == "ArgumentMismatch" && colon != std::string::npos && what.ends_with(" missing"))
        return what.substr(0, colon) + " needs a value";
    return wrong_word(what);
}

/// What is wrong with the command line.
std::string explain(const CLI::App* program, const CLI::Error& problem) {
    const auto commands = program->get_subcommands();
    const CLI::App& command = commands.empty() ? *program : *commands.front();
    return bendy::cli::error_label() + bendy::cli::printable(in_own_words(command, problem)) + "\nTry `bendy " +
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

int run(std::vector<std::string> words) {
    CLI::App program("Bendy: animated characters in one file of nested chunks.", "bendy");
    program.allow_windows_style_options(false);  // /folder/file is a file on all systems
    program.set_version_flag("--version", "bendy " BENDY_VERSION);
    program.require_subcommand(1);
    program.failure_message(explain);
    program.footer("Try `bendy help convert`, or: bendy convert fox.glb && bendy inspect fox.bendy");
    bendy::cli::add_convert(program);
    bendy::cli::add_inspect(program);
    bendy::cli::add_validate(program);
    bendy::cli::add_pose(program);
    bendy::cli::add_render(program);
    bendy::cli::add_rig(program);
    bendy::cli::add_diff(program);
    bendy::cli::add_dump(program);
    bendy::cli::add_assemble(program);
    bendy::cli::add_edit(program);
    bendy::cli::add_export(program);
    bendy::cli::add_view(program);
    bendy::cli::add_bench(program);
    try {
        words = with_help_as_option(std::move(words));
        const bool asks_for_help = words.size() > 1 && words[1] == "--help";
        const auto commands = commands_of(program);
        if (asks_for_help && std::find(commands.begin(), commands.end(), words.front()) == commands.end())
            words.pop_back();  // there is no such command: that is said, not the program's help
        program.parse(std::vector(words.rbegin(), words.rend()));  // the last one first: CLI11 takes them so
    } catch (const CLI::ParseError& problem) {
        if (program.exit(problem) != 0) return kWrongCommandLine;  // else it was a call for help
    } catch (const bendy::cli::Failed& failed) {
        std::cout.flush();
        return failed.status;
    }
    std::cout.flush();
    if (std::cout) return kDone;
    std::cerr << bendy::cli::error_label() << "standard output cannot be written\n";
    return kFailed;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        bendy::cli::prepare_console();
        bendy::cli::watch_signals();
        return run(bendy::cli::command_line(argc, argv));
    } catch (const std::bad_alloc&) {
        std::fputs("bendy: error: not enough memory\n", stderr);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bendy: error: %s\n", bendy::cli::printable(problem.what()).c_str());
    } catch (...) {
        std::fputs("bendy: error: something that has no name went wrong\n", stderr);
    }
    return kFailed;
}
