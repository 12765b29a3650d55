#include "descriptor_posix.h"
#include "write_files.h"

#include <bendy/format/file.h>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace bendy {
namespace {

bool write_all(int descriptor, Bytes bytes) {
    while (!bytes.empty()) {
        constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
        const ssize_t written = ::write(descriptor, bytes.data(), std::min(bytes.size(), kMostAtOnce));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
}

/// Writes directly: a pipe or a device cannot be replaced.
Result<void> write_into(const std::filesystem::path& path, Bytes bytes) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (file.number() < 0 || !write_all(file.number(), bytes) || !file.close())
        return system_error(ErrorCode::kCannotWrite);
    return {};
}

/// Gives a new file the owner and the mode of the one that it replaces, as far as the user may.
void take_owner_and_mode(int descriptor, const struct stat& old) {
    constexpr mode_t kAll = 07777;
    constexpr mode_t kRights = 0777;
    constexpr mode_t kOfGroup = 0070;
    struct stat status {};
    mode_t mode = old.st_mode & kAll;
    const bool is_known = ::fstat(descriptor, &status) == 0;
    if (!is_known || status.st_uid != old.st_uid || status.st_gid != old.st_gid) {
        constexpr auto kSame = static_cast<uid_t>(-1);
        if (::fchown(descriptor, old.st_uid, old.st_gid) != 0) {
            mode &= kRights;
            // The new group must not get the old group's rights, unless everyone has them.
            if (::fchown(descriptor, kSame, old.st_gid) != 0) mode &= ~kOfGroup | (mode << 3U & kOfGroup);
        }
    }
    static_cast<void>(::fchmod(descriptor, mode));
}

}  // namespace

Result<void> stage(const FileContents& contents, StagedFile& staged) {
    std::error_code not_there;
    staged.target =
        std::filesystem::canonical(contents.path, not_there);  // the target of a symbolic link, not the link
    if (not_there) staged.target = contents.path;
    struct stat old {};
    const bool is_there = ::stat(staged.target.c_str(), &old) == 0;
    if (is_there && !S_ISREG(old.st_mode) && !S_ISDIR(old.st_mode)) return write_into(staged.target, contents.bytes);

    constexpr mode_t kAsTheUserHasIt = 0666;
    constexpr mode_t kUntilItHasItsOwn = 0600;
    int number = -1;
    do {
        staged.beside = name_beside(staged.target);
        number = ::open(staged.beside->path().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                        is_there ? kUntilItHasItsOwn : kAsTheUserHasIt);
    } while (number < 0 && errno == EEXIST);
    Descriptor file(number);
    if (file.number() < 0) {
        const Error error = last_error();
        staged.beside.reset();
        return error;
    }
    if (is_there) take_owner_and_mode(file.number(), old);
    if (write_all(file.number(), contents.bytes) && ::fsync(file.number()) == 0 && file.close()) return {};
    const Error error = last_error();
    ::unlink(staged.beside->path().c_str());
    staged.beside.reset();
    return error;
}

bool keep_old(StagedFile& staged) {
    if (::link(staged.target.c_str(), staged.kept->path().c_str()) == 0) return true;
    // Some file systems have no hard links. A folder must not be moved: replacing it is refused.
    struct stat status {};
    const bool is_file = errno != ENOENT && ::lstat(staged.target.c_str(), &status) == 0 && S_ISREG(status.st_mode);
    const bool is_lost = is_file && ::rename(staged.target.c_str(), staged.kept->path().c_str()) != 0;
    if (!is_file || is_lost) staged.kept.reset();
    return !is_lost;
}

bool replace(const std::filesystem::path& target, const std::filesystem::path& by) {
    return ::rename(by.c_str(), target.c_str()) == 0;
}

Error last_error() {
    return system_error(ErrorCode::kCannotWrite);
}

unsigned long process_number() {
    return static_cast<unsigned long>(::getpid());
}

void remove_at_once(const char* name) noexcept {
    ::unlink(name);
}

void wait_briefly() noexcept {
    ::poll(nullptr, 0, 1);
}

struct SignalsBlocked::State {
    sigset_t signals{};
};

SignalsBlocked::SignalsBlocked() : before_(std::make_unique<State>()) {
    sigset_t signals;
    ::sigfillset(&signals);
    for (const int own_fault : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) ::sigdelset(&signals, own_fault);
    ::pthread_sigmask(SIG_BLOCK, &signals, &before_->signals);
}

SignalsBlocked::~SignalsBlocked() {
    ::pthread_sigmask(SIG_SETMASK, &before_->signals, nullptr);
}

}  // namespace bendy
