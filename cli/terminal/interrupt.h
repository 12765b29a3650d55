#pragma once

namespace bendy::cli {

/// While it lives, the first SIGINT or SIGTERM is only noted; a second one ends the program at once.
class Interrupt {
public:
    Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;
    Interrupt(Interrupt&&) = delete;
    Interrupt& operator=(Interrupt&&) = delete;
    ~Interrupt();

    /// True after a signal.
    [[nodiscard]] static bool has_come();
    /// Ends the program by that signal, as the shell expects it.
    [[noreturn]] static void obey();
};

}  // namespace bendy::cli
