#include "files/signals.h"

#include <bendy/format/file.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>

namespace bendy::tools {
namespace {

std::atomic<bool> is_noting{false};
std::atomic<int> noted{0};
std::atomic<int> failure_status{1};

extern "C" void end(int signal) {
    int none = 0;
    if (is_noting && noted.compare_exchange_strong(none, signal)) {
        std::signal(signal, end);  // Windows resets the handler when it calls it
        return;
    }
    remove_temporary_files();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

}  // namespace

void watch_signals() {
    for (const int signal : std::array{SIGINT, SIGTERM, SIGBREAK}) std::signal(signal, end);
}

void set_status_of_failures(int status) {
    failure_status = status;
}

int status_of_failures() {
    return failure_status;
}

Interrupt::Interrupt() {
    is_noting = true;
}

Interrupt::~Interrupt() {
    is_noting = false;
}

bool Interrupt::has_come() {
    return noted != 0;
}

void Interrupt::obey() {
    std::signal(noted, SIG_DFL);
    std::raise(noted);
    std::_Exit(EXIT_FAILURE);  // if the signal does not end the program
}

}  // namespace bendy::tools
