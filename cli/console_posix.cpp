#include "console.h"

#include <unistd.h>

#include <algorithm>

namespace bendy::cli {

std::vector<std::string> command_line(int argc, const char* const* argv) {
    return {argv + std::min(argc, 1), argv + argc};
}

void prepare_console() {}

bool is_terminal() {
    return ::isatty(STDERR_FILENO) == 1;
}

bool output_is_terminal() {
    return ::isatty(STDOUT_FILENO) == 1;
}

}  // namespace bendy::cli
