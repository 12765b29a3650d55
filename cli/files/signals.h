#pragma once

// Handles signals: requests to end the program, and a mapped file that becomes shorter.
namespace bendy::cli {

/// From now on, a signal that ends the program first removes the files that are being written beside outputs, and
/// reading a mapped file past its new end is an error that names the file. To be called once, at the start.
void watch_signals();

/// Sets the exit status after such an error, which is 1 by default.
void set_status_of_failures(int status);

/// While it lives, the first request to end the program (INT, TERM, HUP) is only noted; a second one ends it at once.
class Interrupt {
public:
    Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;
    Interrupt(Interrupt&&) = delete;
    Interrupt& operator=(Interrupt&&) = delete;
    ~Interrupt();

    /// True after such a signal.
    [[nodiscard]] static bool has_come();
    /// Ends the program by that signal, as the shell expects it.
    [[noreturn]] static void obey();
};

}  // namespace bendy::cli
