#include "descriptor_posix.h"

#include <bendy/format/file.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

namespace bendy {
namespace {

/// Reads until `size` bytes have arrived or the file ends.
bool read_all(int descriptor, std::byte* to, std::size_t size, std::size_t& got) {
    while (got < size) {
        constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
        const ssize_t count = ::read(descriptor, to + got, std::min(size - got, kMostAtOnce));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        if (count == 0) return true;
        got += static_cast<std::size_t>(count);
    }
    return true;
}

/// A mapped file in the list that mapped_file_at() reads. Entries are reused but never freed, so that a signal handler
/// can walk the list at any time.
struct Mapping {
    std::atomic<bool> is_used{true};
    std::atomic<const std::byte*> begin{nullptr};  ///< null: `size` and `name` may be changing
    std::size_t size = 0;
    std::string name;
    Mapping* next = nullptr;
};

std::atomic<Mapping*> mappings{nullptr};
static_assert(std::atomic<const void*>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

Mapping* unused_mapping() {
    for (Mapping* mapping = mappings; mapping != nullptr; mapping = mapping->next) {
        if (!mapping->is_used.exchange(true)) return mapping;
    }
    auto added = std::make_unique<Mapping>();
    added->next = mappings;
    while (!mappings.compare_exchange_weak(added->next, added.get())) {
    }
    return added.release();
}

/// Opens a regular file. \param size  receives its size
Result<int> open_to_read(const std::filesystem::path& path, std::size_t& size) {
    // O_NONBLOCK: otherwise open would block on a pipe without a writer, before it can be rejected.
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.number() < 0) return system_error(ErrorCode::kCannotOpen);
    struct stat status {};
    if (::fstat(file.number(), &status) != 0) return system_error(ErrorCode::kCannotRead);
    if (!S_ISREG(status.st_mode)) {
        errno = S_ISDIR(status.st_mode) ? EISDIR : EINVAL;
        return system_error(ErrorCode::kCannotRead);
    }
    size = static_cast<std::size_t>(status.st_size);
    return file.release();
}

}  // namespace

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
    MappedFile mapped;
    const auto opened = open_to_read(path, mapped.size_);
    if (!opened) return opened.error();
    const Descriptor file(*opened);
    if (mapped.size_ == 0) return mapped;
    void* data = ::mmap(nullptr, mapped.size_, PROT_READ, MAP_PRIVATE, file.number(), 0);
    if (data == MAP_FAILED) return system_error(ErrorCode::kCannotRead);
    mapped.data_ = static_cast<const std::byte*>(data);
    Mapping* const mapping = unused_mapping();
    mapped.file_ = mapping;
    mapping->size = mapped.size_;
    mapping->name = path.native();
    mapping->begin = mapped.data_;
    return mapped;
}

Result<MappedFile> MappedFile::read(const std::filesystem::path& path) {
    MappedFile copy;
    const auto opened = open_to_read(path, copy.size_);
    if (!opened) return opened.error();
    const Descriptor file(*opened);
    if (copy.size_ == 0) return copy;
    void* data = ::mmap(nullptr, copy.size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (data == MAP_FAILED) return system_error(ErrorCode::kCannotRead);
    auto* const bytes = static_cast<std::byte*>(data);
    copy.data_ = bytes;
    std::size_t got = 0;
    if (!read_all(file.number(), bytes, copy.size_, got)) return system_error(ErrorCode::kCannotRead);
    if (got == copy.size_) return copy;
    errno = EBUSY;  // another program has just made it shorter
    return system_error(ErrorCode::kCannotRead);
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      file_(std::exchange(other.file_, nullptr)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(file_, other.file_);
    return *this;
}

MappedFile::~MappedFile() {
    if (file_ != nullptr) {
        auto* const mapping = static_cast<Mapping*>(file_);
        mapping->begin = nullptr;
        mapping->is_used = false;
    }
    if (data_ != nullptr)
        ::munmap(const_cast<std::byte*>(data_), size_);  // NOLINT(*-const-cast): the signature of munmap
}

const char* mapped_file_at(const void* address) noexcept {
    const auto at = reinterpret_cast<std::uintptr_t>(address);  // NOLINT(*-reinterpret-cast): compared as numbers
    for (const Mapping* mapping = mappings; mapping != nullptr; mapping = mapping->next) {
        const std::byte* const first = mapping->begin;
        if (first == nullptr) continue;
        const auto begin = reinterpret_cast<std::uintptr_t>(first);  // NOLINT(*-reinterpret-cast)
        if (at >= begin && at - begin < mapping->size) return mapping->name.c_str();
    }
    return nullptr;
}

}  // namespace bendy
