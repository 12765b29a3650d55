#pragma once

#include <bendy/format/file.h>

#include <filesystem>
#include <memory>

// How files are written: what write_files.cpp, the same on all systems, asks of write_files_posix.cpp and _windows.cpp.
namespace bendy {

/// The name of a temporary file, in the list that remove_temporary_files() reads, while it lives. Does not make or
/// remove the file.
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

/// A name in the folder of `target` that this program has not used yet. Short, so that a target with the longest
/// possible name can be written.
std::unique_ptr<TemporaryName> name_beside(const std::filesystem::path& target);

/// A file that is written, but not yet where it belongs.
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

/// Writes a new file beside the one to be written, flushed to disk, with the owner and the mode that it shall have. On
/// failure the new file is removed.
Result<void> stage(const FileContents& contents, StagedFile& staged);

/// Keeps the old file beside the target, under another name. True also if there is none; on failure the system's error
/// is set.
bool keep_old(StagedFile& staged);

/// Replaces a file by another, completely or not at all; on failure the system's error is set.
bool replace(const std::filesystem::path& target, const std::filesystem::path& by);

/// The error of what failed above.
Error last_error();
/// What no other program that runs has.
unsigned long process_number();

// These two may be called from signal handlers.
void remove_at_once(const std::filesystem::path::value_type* name) noexcept;
/// Sleeps for about a millisecond.
void wait_briefly() noexcept;

/// While it lives, no signal handler that may end the program runs on this thread.
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
