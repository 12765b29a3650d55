#include "commands.h"
#include "console.h"
#include "problem.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <vector>

namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongCommandLine = 2;

/// What is wrong with the command line.
std::string explain(const CLI::App* program, const CLI::Error& problem) {
    std::string what = problem.what();
    const auto unknown = program->remaining();
    if (program->get_subcommands().empty() && !unknown.empty()) {
        what = (unknown.front().starts_with('-') ? "there is no option " : "there is no command ") + unknown.front();
    }
    return "bendy: error: " + bendy::cli::printable(what) + "\nTry `bendy --help` or `bendy COMMAND --help`.\n";
}

int run(const std::vector<std::string>& words) {
    CLI::App program("Bendy: animated characters in one file of nested chunks.", "bendy");
    program.allow_windows_style_options(false);  // /folder/file is a file on all systems
    program.set_version_flag("--version", "bendy " BENDY_VERSION);
    program.require_subcommand(1);
    program.failure_message(explain);
    program.footer("Try `bendy COMMAND --help`, or: bendy convert fox.glb && bendy inspect fox.bendy");
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
        program.parse(std::vector(words.rbegin(), words.rend()));  // the last one first: CLI11 takes them so
    } catch (const CLI::ParseError& problem) {
        if (program.exit(problem) != 0) return kWrongCommandLine;  // else it was a call for help
    } catch (const bendy::cli::Failed& failed) {
        std::cout.flush();
        return failed.status;
    }
    std::cout.flush();
    if (std::cout) return kDone;
    std::cerr << "bendy: error: standard output cannot be written\n";
    return kFailed;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        bendy::cli::prepare_console();
        return run(bendy::cli::command_line(argc, argv));
    } catch (const std::bad_alloc&) {
        std::fputs("bendy: error: not enough memory\n", stderr);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bendy: error: %s\n", problem.what());
    } catch (...) {
        std::fputs("bendy: error: something that has no name went wrong\n", stderr);
    }
    return kFailed;
}
