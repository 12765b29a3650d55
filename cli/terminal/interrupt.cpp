#include "terminal/interrupt.h"

#include <atomic>
#include <csignal>
#include <cstdlib>

namespace bendy::cli {
namespace {

std::atomic<int> noted{0};
static_assert(std::atomic<int>::is_always_lock_free);  // or a handler must not touch it

extern "C" void note(int signal) {
    noted = signal;
    std::signal(signal, SIG_DFL);
}

/// Leaves a signal alone that whoever started the program has switched off, as nohup does.
void watch(int signal) {
    if (std::signal(signal, note) == SIG_IGN) std::signal(signal, SIG_IGN);
}

void forget(int signal) {
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
}

}  // namespace

Interrupt::Interrupt() {
    watch(SIGINT);
    watch(SIGTERM);
}

Interrupt::~Interrupt() {
    forget(SIGINT);
    forget(SIGTERM);
}

bool Interrupt::has_come() {
    return noted != 0;
}

void Interrupt::obey() {
    std::signal(noted, SIG_DFL);
    std::raise(noted);
    std::_Exit(EXIT_FAILURE);  // where signals end nothing
}

}  // namespace bendy::cli
