#include "import_problem.h"

#include "problem.h"

namespace bendy::cli {

std::filesystem::path file_of(const converter::ImportError& error, const std::filesystem::path& input) {
    return error.file.empty() ? input : error.file;
}

std::string describe(const converter::ImportError& error) {
    return printable(error.place.empty() ? error.message : error.place + ": " + error.message);
}

}  // namespace bendy::cli
