// To be preloaded (LD_PRELOAD): lets one call of the system or of malloc fail, where a test asks for it.
//   BENDY_FAIL=write|open|fsync|close|rename|malloc|link|read|map   which call; of files, those that are opened for
//   writing
//                              count, with read those that are opened for reading; map: a file was mapped
//   BENDY_FAIL_AT=n            which of them, 1 the first; it and all later ones of its kind, but of malloc only it
//   BENDY_FAIL_HOW=error|once|short|kill|stop   say that the disk is full, or of reading that too many files are open;
//   only of
//                              this one call; write half of it first; end the program at once; stop it until it is
//                              continued
//   BENDY_FAIL_LINK=1          besides, no hard link can be made
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace {

constexpr int kMostFiles = 1024;
std::atomic<bool> is_output[kMostFiles];  // by descriptor: opened for writing
std::atomic<long> calls{0};
std::atomic<bool> is_in_main{false};  // what libraries take before it can be answered by nobody
int (*program_main)(int, char**, char**) = nullptr;
thread_local bool is_looking = false;  // dlsym may allocate

template <class Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool is_wanted(const char* kind) {
    const char* const wanted = std::getenv("BENDY_FAIL");
    return wanted != nullptr && std::strcmp(wanted, kind) == 0;
}

bool is_how(const char* how) {
    const char* const wanted = std::getenv("BENDY_FAIL_HOW");
    return wanted != nullptr && std::strcmp(wanted, how) == 0;
}

/// Whether this call of that kind is to fail; does not come back if it is to end the program.
bool fails(const char* kind) {
    if (!is_wanted(kind)) return false;
    const char* const text = std::getenv("BENDY_FAIL_AT");
    const long at = text == nullptr ? 1 : std::atol(text);
    const long call = ++calls;
    if (call < at || (call > at && (is_how("once") || is_how("stop")))) return false;
    if (is_how("kill")) raise(SIGKILL);
    if (is_how("stop")) {
        raise(SIGSTOP);
        return false;
    }
    errno = is_wanted("read") ? EMFILE : ENOSPC;
    return true;
}

/// Whether a path is one of the test's files, which have no folder before them.
bool is_plain_name(const char* path) {
    return is_in_main && std::strchr(path, '/') == nullptr;
}

bool is_output_file(int file) {
    return file >= 0 && file < kMostFiles && is_output[file];
}

int note_open(int file, int flags) {
    if (file >= 0 && file < kMostFiles) is_output[file] = (flags & O_ACCMODE) != O_RDONLY;
    return file;
}

mode_t mode_of(int flags, va_list list) {
    return (flags & O_CREAT) != 0 ? static_cast<mode_t>(va_arg(list, int)) : 0;
}

int counted_main(int count, char** arguments, char** environment) {
    is_in_main = true;
    return program_main(count, arguments, environment);
}

}  // namespace

extern "C" {

// NOLINTNEXTLINE(*-reserved-identifier): the C library's own
int __libc_start_main(int (*main)(int, char**, char**), int count, char** arguments, void (*begin)(), void (*end)(),
                      void (*unload)(), void* stack) {
    program_main = main;
    const auto real = next<decltype(&__libc_start_main)>("__libc_start_main");
    return real(counted_main, count, arguments, begin, end, unload, stack);
}

int open(const char* path, int flags, ...) {
    va_list list;
    va_start(list, flags);
    const mode_t mode = mode_of(flags, list);
    va_end(list);
    if ((flags & O_ACCMODE) != O_RDONLY && fails("open")) return -1;
    if ((flags & O_ACCMODE) == O_RDONLY && is_plain_name(path) && fails("read")) return -1;
    return note_open(next<int (*)(const char*, int, mode_t)>("open")(path, flags, mode), flags);
}

int open64(const char* path, int flags, ...) {
    va_list list;
    va_start(list, flags);
    const mode_t mode = mode_of(flags, list);
    va_end(list);
    if ((flags & O_ACCMODE) != O_RDONLY && fails("open")) return -1;
    if ((flags & O_ACCMODE) == O_RDONLY && is_plain_name(path) && fails("read")) return -1;
    return note_open(next<int (*)(const char*, int, mode_t)>("open64")(path, flags, mode), flags);
}

ssize_t write(int file, const void* data, size_t size) {
    const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
    if (is_output_file(file) && fails("write")) {
        static bool is_first = true;
        if (!is_how("short") || !std::exchange(is_first, false)) return -1;
        return real(file, data, size / 2);
    }
    return real(file, data, size);
}

int fsync(int file) {
    if (is_output_file(file) && fails("fsync")) return -1;
    return next<int (*)(int)>("fsync")(file);
}

int close(int file) {
    const bool is_watched = is_output_file(file);
    if (is_watched) is_output[file] = false;
    const bool is_failing = is_watched && fails("close");
    const int result = next<int (*)(int)>("close")(file);
    if (!is_failing) return result;
    errno = EIO;
    return -1;
}

int rename(const char* from, const char* to) {
    if (fails("rename")) return -1;
    return next<int (*)(const char*, const char*)>("rename")(from, to);
}

int link(const char* from, const char* to) {
    if (fails("link") || std::getenv("BENDY_FAIL_LINK") != nullptr) {
        errno = EPERM;  // as a file system without hard links says
        return -1;
    }
    return next<int (*)(const char*, const char*)>("link")(from, to);
}

FILE* fopen(const char* path, const char* mode) {
    if (mode[0] == 'r' && is_plain_name(path) && fails("read")) return nullptr;
    return next<FILE* (*)(const char*, const char*)>("fopen")(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
    if (mode[0] == 'r' && is_plain_name(path) && fails("read")) return nullptr;
    return next<FILE* (*)(const char*, const char*)>("fopen64")(path, mode);
}

void* mmap(void* at, size_t size, int protection, int flags, int file, off_t offset) {
    void* const mapped =
        next<void* (*)(void*, size_t, int, int, int, off_t)>("mmap")(at, size, protection, flags, file, offset);
    if (is_in_main && file >= 0 && protection == PROT_READ) (void)fails("map");
    return mapped;
}

void* malloc(size_t size) {
    static void* (*real)(size_t) = nullptr;
    if (real == nullptr) {
        if (is_looking) return nullptr;
        is_looking = true;
        real = next<void* (*)(size_t)>("malloc");
        is_looking = false;
    }
    if (is_in_main && is_wanted("malloc")) {
        const char* const at = std::getenv("BENDY_FAIL_AT");
        if (++calls == (at == nullptr ? 1 : std::atol(at))) {
            errno = ENOMEM;
            return nullptr;
        }
    }
    return real(size);
}

}  // extern "C"
