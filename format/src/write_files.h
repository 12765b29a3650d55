#pragma once

#include <bendy/format/file.h>

#include <filesystem>
#include <memory>

// How files are written: the functions that the portable write_files.cpp needs from write_files_posix.cpp and
// _windows.cpp.
namespace bendy {

/// The name of a temporary file, listed for remove_temporary_files() during its lifetime. Does not make or remove the
/// file.
class TemporaryName {
public:
    explicit TemporaryName(std::filesystem::path path);
    TemporaryName(const TemporaryName&) = delete;
    TemporaryName& operator=(const TemporaryName&) = delete;
    TemporaryName(TemporaryName&&) = delete;
    TemporaryName& operator=(TemporaryName&&) = delete;
    ~TemporaryName();

    [[nodiscard]] const std::filesystem::path& path() const { return *path_; }

    struct Slot;

private:
    std::unique_ptr<const std::filesystem::path> path_;
    Slot* slot_;
};

/// Returns an unused name in the folder of `target`. Short, so that a target with the longest possible name can be
/// written.
std::unique_ptr<TemporaryName> name_beside(const std::filesystem::path& target);

/// A file that has been written, but is not yet in place.
struct StagedFile {
    std::filesystem::path target;
    std::unique_ptr<TemporaryName> beside;  ///< the new bytes; null: they went directly to a pipe or a device
    std::unique_ptr<TemporaryName> kept;    ///< the old file, while others are replaced; null: there was none
    bool is_replaced = false;

    StagedFile() = default;
    StagedFile(const StagedFile&) = delete;
    StagedFile& operator=(const StagedFile&) = delete;
    StagedFile(StagedFile&&) = delete;
    StagedFile& operator=(StagedFile&&) = delete;
    /// Removes the new bytes if they are still beside the target.
    ~StagedFile();
};

/// Writes a new file beside its target, flushed to disk, with its final owner and mode. On failure the new file is
/// removed.
Result<void> stage(const FileContents& contents, StagedFile& staged);

/// Keeps the old file beside the target, under another name. Returns true also if there is none; on failure the
/// system's error is set.
bool keep_old(StagedFile& staged);

/// Replaces a file by another, atomically; on failure the system's error is set.
bool replace(const std::filesystem::path& target, const std::filesystem::path& by);

/// Returns the error of a failed call above.
Error last_error();
/// Returns a number that no other running program has.
unsigned long process_number();

// These two are safe in signal handlers.
void remove_at_once(const std::filesystem::path::value_type* name) noexcept;
/// Sleeps for about a millisecond.
void wait_briefly() noexcept;

/// During its lifetime, no signal handler that may end the program runs on this thread.
class SignalsBlocked {
public:
    SignalsBlocked();
    SignalsBlocked(const SignalsBlocked&) = delete;
    SignalsBlocked& operator=(const SignalsBlocked&) = delete;
    SignalsBlocked(SignalsBlocked&&) = delete;
    SignalsBlocked& operator=(SignalsBlocked&&) = delete;
    ~SignalsBlocked();

private:
    struct State;
    std::unique_ptr<State> before_;
};

}  // namespace bendy
