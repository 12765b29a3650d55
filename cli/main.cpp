#include "commands.h"
#include "problem.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <exception>
#include <iostream>

int main(int argc, char** argv) {
    constexpr int kDone = 0;
    constexpr int kFailed = 1;
    constexpr int kWrongCommandLine = 2;

    CLI::App program("Bendy: animated characters in one file of nested chunks.", "bendy");
    program.set_version_flag("--version", "bendy " BENDY_VERSION);
    program.require_subcommand(1);
    program.footer("Try `bendy COMMAND --help`, or: bendy convert fox.glb && bendy inspect fox.bendy");
    bendy::cli::add_convert(program);
    bendy::cli::add_inspect(program);
    bendy::cli::add_validate(program);
    bendy::cli::add_pose(program);
    try {
        program.parse(argc, argv);
        std::cout.flush();
        if (!std::cout) {
            std::cerr << "bendy: error: standard output cannot be written\n";
            return kFailed;
        }
        return kDone;
    } catch (const CLI::ParseError& problem) {
        return program.exit(problem) == 0 ? kDone : kWrongCommandLine;
    } catch (const bendy::cli::Failed&) {
        std::cout.flush();
        return kFailed;
    } catch (const std::exception& problem) {
        std::cerr << "bendy: error: " << problem.what() << '\n';
        return kFailed;
    }
}
