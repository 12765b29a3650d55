#include "reports/console.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace bendy::tools {
namespace {

int number_of(Stream stream) {
    return stream == Stream::output ? STDOUT_FILENO : STDERR_FILENO;
}

}  // namespace

std::vector<std::string> command_line(int argc, const char* const* argv) {
    return {argv + std::min(argc, 1), argv + argc};
}

void prepare_console() {}

bool is_terminal(Stream stream) {
    const char* const kind = std::getenv("TERM");  // NOLINT(concurrency-mt-unsafe): nothing here changes it
    return ::isatty(number_of(stream)) == 1 && (kind == nullptr || std::string_view(kind) != "dumb");
}

std::size_t columns_of(Stream stream) {
    winsize size{};
    if (::isatty(number_of(stream)) != 1 || ::ioctl(number_of(stream), TIOCGWINSZ, &size) != 0) return 0;
    return size.ws_col;
}

}  // namespace bendy::tools
