#include "warnings.h"

#include "problem.h"

#include <iostream>
#include <string>

namespace bendy::cli {

void print_warnings(const std::filesystem::path& file, const converter::Report& report) {
    for (const converter::Warning& warning : report.warnings()) {
        std::string line;
        if (!warning.first_place.empty()) line = warning.first_place + ": ";
        line += warning.message;
        if (warning.count > 1) line += " (" + grouped(warning.count) + " times)";
        warn(file, printable(line));
    }
    for (const std::string& line : report.suggestions())
        std::cerr << "bendy: note: " << printable(file.string()) << ": " << printable(line) << '\n';
}

void print_proposals(const converter::Report& report) {
    for (const std::string& line : report.proposals()) std::cerr << "bendy: proposed: " << printable(line) << '\n';
}

}  // namespace bendy::cli
