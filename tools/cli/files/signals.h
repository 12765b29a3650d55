#pragma once

// Handles signals: requests to end the program, and a mapped file that becomes shorter.
namespace bendy::tools {

/// From now on, a signal that ends the program first removes unfinished files beside outputs, and reading a mapped file
/// past its new end is reported as an error that names the file. Call it once, at the start.
void watch_signals();

/// Sets the exit status after such an error, and after a lack of memory that nothing else handles; 1 by default.
void set_status_of_failures(int status);
int status_of_failures();

/// During its lifetime, the first request to end the program (INT, TERM, HUP) is only noted; a second one ends it at
/// once.
class Interrupt {
public:
    Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;
    Interrupt(Interrupt&&) = delete;
    Interrupt& operator=(Interrupt&&) = delete;
    ~Interrupt();

    /// Returns true after such a signal.
    [[nodiscard]] static bool has_come();
    /// Ends the program by that signal, as the shell expects.
    [[noreturn]] static void obey();
};

}  // namespace bendy::tools
