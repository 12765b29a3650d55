#include "files/signals.h"
#include "reports/messages.h"

#include <bendy/format/file.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace bendy::tools {
namespace {

std::atomic<bool> is_noting{false};
std::atomic<int> noted{0};
std::atomic<int> failure_status{1};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);  // for the handlers

constexpr std::array kRequests{SIGINT, SIGTERM, SIGHUP};
constexpr std::array kOtherEnds{SIGQUIT, SIGPIPE, SIGALRM, SIGXCPU, SIGXFSZ};

void print_at_once(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
        if (written <= 0) return;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

extern "C" void end(int signal) {
    const bool is_request = std::find(kRequests.begin(), kRequests.end(), signal) != kRequests.end();
    int none = 0;
    if (is_request && is_noting && noted.compare_exchange_strong(none, signal)) return;
    remove_temporary_files();
    std::signal(signal, SIG_DFL);
    std::raise(signal);  // delivered when this handler returns
}

extern "C" void end_for_shorter_file(int signal, siginfo_t* info, void* /*context*/) {
    const char* const name = info->si_code == BUS_ADRERR ? mapped_file_at(info->si_addr) : nullptr;
    if (name == nullptr) {
        std::signal(signal, SIG_DFL);  // then the instruction faults again
        return;
    }
    remove_temporary_files();
    print_at_once("bendy: error: ");
    std::array<char, kMostEscaped> letter{};
    const char* const last = name + std::strlen(name);
    for (const char* at = name; at != last;) {
        const std::size_t size = escape_letter(at, last, letter.data());
        print_at_once({letter.data(), size});
    }
    print_at_once(": became shorter while it was read\n");
    std::_Exit(failure_status);
}

/// Leaves a signal ignored if the parent process ignored it, as nohup does.
void watch(int signal, const struct sigaction& action) {
    struct sigaction before {};
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
        ::sigaction(signal, &action, nullptr);
}

}  // namespace

void watch_signals() {
    struct sigaction action {};
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    action.sa_handler = end;
    for (const int signal : kRequests) watch(signal, action);
    for (const int signal : kOtherEnds) watch(signal, action);
    action.sa_flags = SA_SIGINFO;
    action.sa_sigaction = end_for_shorter_file;
    watch(SIGBUS, action);
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
    std::_Exit(EXIT_FAILURE);
}

}  // namespace bendy::tools
