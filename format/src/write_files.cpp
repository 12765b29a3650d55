#include "write_files.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <utility>

namespace bendy {

/// Slots are reused but never freed, so that a signal handler can walk the list of all of them at any time.
struct TemporaryName::Slot {
    std::atomic<const std::filesystem::path::value_type*> name{nullptr};  ///< null: free
    Slot* next = nullptr;
    Slot* next_free = nullptr;  ///< not for signal handlers
};

namespace {

std::atomic<TemporaryName::Slot*> slots{nullptr};
std::mutex free_slots_lock;  ///< never taken by a signal handler
TemporaryName::Slot* free_slots = nullptr;
std::atomic<int> replacing{0};       ///< threads that are replacing files together
std::atomic<bool> is_ending{false};  ///< from now on nothing must be replaced
static_assert(std::atomic<const void*>::is_always_lock_free && std::atomic<int>::is_always_lock_free &&
              std::atomic<bool>::is_always_lock_free);

/// Replaces a name that remove_temporary_files() has taken.
constexpr std::filesystem::path::value_type kTaken = 0;

/// Takes the same time however many names are listed.
TemporaryName::Slot* slot_for(const std::filesystem::path::value_type* name) {
    {
        const std::lock_guard lock(free_slots_lock);
        if (TemporaryName::Slot* const slot = free_slots; slot != nullptr) {
            free_slots = slot->next_free;
            slot->name = name;
            return slot;
        }
    }
    auto added = std::make_unique<TemporaryName::Slot>();
    added->name = name;
    added->next = slots;
    while (!slots.compare_exchange_weak(added->next, added.get())) {
    }
    return added.release();
}

/// During its lifetime, remove_temporary_files() waits, and does not run on this thread, where it would wait for ever.
class Replacing {
public:
    Replacing() {
        ++replacing;
        may_begin_ = !is_ending;
    }
    Replacing(const Replacing&) = delete;
    Replacing& operator=(const Replacing&) = delete;
    Replacing(Replacing&&) = delete;
    Replacing& operator=(Replacing&&) = delete;
    ~Replacing() { --replacing; }

    [[nodiscard]] bool may_begin() const { return may_begin_; }

private:
    SignalsBlocked blocked_;
    bool may_begin_ = false;
};

Error cannot_write(int number) {
    return {ErrorCode::kCannotWrite, 0, static_cast<std::uint64_t>(number)};
}

void remove(std::unique_ptr<TemporaryName>& file) {
    if (file) remove_at_once(file->path().c_str());
    file.reset();
}

void put_back(StagedFile& file) {
    if (file.kept) {
        static_cast<void>(replace(file.target, file.kept->path()));
        remove(file.kept);  // still exists if it is a second link to the target
    } else if (file.is_replaced) {
        remove_at_once(file.target.c_str());
    }
}

Result<void, WriteFailure> replace_all(std::deque<StagedFile>& files) {
    const Replacing now;
    if (!now.may_begin()) return WriteFailure{0, cannot_write(EINTR)};
    const auto together =
        std::count_if(files.begin(), files.end(), [](const StagedFile& file) { return file.beside != nullptr; });
    // Before the first rename, because allocation may fail.
    for (StagedFile& file : files) {
        if (file.beside && together > 1) file.kept = name_beside(file.target);
    }
    for (std::size_t k = 0; k < files.size(); ++k) {
        StagedFile& file = files[k];
        if (!file.beside) continue;
        file.is_replaced = (together == 1 || keep_old(file)) && replace(file.target, file.beside->path());
        if (file.is_replaced) continue;
        const Error error = last_error();
        for (std::size_t later = k + 1; later < files.size(); ++later) files[later].kept.reset();
        for (std::size_t done = k + 1; done > 0; --done) put_back(files[done - 1]);
        return WriteFailure{k, error};
    }
    for (StagedFile& file : files) remove(file.kept);
    return {};
}

}  // namespace

TemporaryName::TemporaryName(std::filesystem::path path)
    : path_(std::make_unique<const std::filesystem::path>(std::move(path))), slot_(slot_for(path_->c_str())) {}

TemporaryName::~TemporaryName() {
    const std::filesystem::path::value_type* name = path_->c_str();
    // A signal handler that has taken the name may still be reading it, so it stays until the program ends.
    if (!slot_->name.compare_exchange_strong(name, nullptr)) {
        static_cast<void>(path_.release());
        return;
    }
    const std::lock_guard lock(free_slots_lock);
    slot_->next_free = free_slots;
    free_slots = slot_;
}

StagedFile::~StagedFile() {
    if (beside && !is_replaced) remove_at_once(beside->path().c_str());
}

std::unique_ptr<TemporaryName> name_beside(const std::filesystem::path& target) {
    static std::atomic<unsigned> counter{0};
    const std::string name = ".bendy-" + std::to_string(process_number()) + '-' + std::to_string(counter++);
    return std::make_unique<TemporaryName>(target.parent_path() / name);
}

struct FileSet::Files {
    std::deque<StagedFile> staged;
};

FileSet::FileSet() : files_(std::make_unique<Files>()) {}
FileSet::~FileSet() = default;

Result<void> FileSet::write(const FileContents& file) {
    return stage(file, files_->staged.emplace_back());
}

Result<void, WriteFailure> FileSet::replace() {
    auto replaced = replace_all(files_->staged);
    files_->staged.clear();
    return replaced;
}

Result<void, WriteFailure> write_files(std::span<const FileContents> files) {
    FileSet set;
    for (std::size_t k = 0; k < files.size(); ++k) {
        if (const auto one = set.write(files[k]); !one) return WriteFailure{k, one.error()};
    }
    return set.replace();
}

Result<void> write_file(const std::filesystem::path& path, Bytes bytes) {
    const FileContents file{path, bytes};
    const auto written = write_files({&file, 1});
    if (!written) return written.error().error;
    return {};
}

void remove_temporary_files() noexcept {
    is_ending = true;
    while (replacing != 0) wait_briefly();
    for (TemporaryName::Slot* slot = slots; slot != nullptr; slot = slot->next) {
        const std::filesystem::path::value_type* name = slot->name;
        if (name != nullptr && name != &kTaken && slot->name.compare_exchange_strong(name, &kTaken))
            remove_at_once(name);
    }
}

}  // namespace bendy
