// Replaces functions that format errors of the C++ library which cannot occur here, so that printf is not linked.
#include <cstddef>

extern "C" {

[[noreturn]] void abort_message(const char* format, ...) {
    (void)format;
    __builtin_trap();
}

int snprintf(char* text, std::size_t size, const char* format, ...) {
    (void)format;
    if (size > 0) *text = '\0';
    return 0;
}
}
