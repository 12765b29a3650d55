#include <bendy/format/file.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

namespace bendy {
namespace {

Error system_error(ErrorCode code) {
    return {code, 0, static_cast<std::uint64_t>(errno)};
}

/// A file descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    Descriptor(Descriptor&&) = delete;
    Descriptor& operator=(Descriptor&&) = delete;
    [[nodiscard]] int number() const { return number_; }
    [[nodiscard]] bool close() { return ::close(std::exchange(number_, -1)) == 0; }

private:
    int number_;
};

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

}  // namespace

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
    // O_NONBLOCK: otherwise open would block on a pipe without a writer, before it can be rejected.
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.number() < 0) return system_error(ErrorCode::kCannotOpen);
    struct stat status {};
    if (::fstat(file.number(), &status) != 0) return system_error(ErrorCode::kCannotRead);
    if (!S_ISREG(status.st_mode)) {
        errno = S_ISDIR(status.st_mode) ? EISDIR : EINVAL;
        return system_error(ErrorCode::kCannotRead);
    }
    MappedFile mapped;
    if (status.st_size == 0) return mapped;
    const auto size = static_cast<std::size_t>(status.st_size);
    void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number(), 0);
    if (data == MAP_FAILED) return system_error(ErrorCode::kCannotRead);
    mapped.data_ = static_cast<const std::byte*>(data);
    mapped.size_ = size;
    return mapped;
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
}

MappedFile::~MappedFile() {
    if (data_ != nullptr)
        ::munmap(const_cast<std::byte*>(data_), size_);  // NOLINT(*-const-cast): the signature of munmap
}

Result<void> write_file(const std::filesystem::path& path, Bytes bytes) {
    std::error_code not_there;
    std::filesystem::path target = std::filesystem::canonical(path, not_there);  // the target of a symbolic link, not
                                                                                 // the link
    if (not_there) target = path;
    struct stat status {};
    if (::stat(target.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode))
        return write_into(target, bytes);

    // The name is short, so that a target with the longest possible name can be written, and new, so that no existing
    // file is overwritten.
    static std::atomic<unsigned> counter{0};
    constexpr mode_t kAsTheUserHasIt = 0666;
    std::filesystem::path beside;
    int number = -1;
    do {
        beside = target.parent_path() / (".bendy-" + std::to_string(::getpid()) + '-' + std::to_string(counter++));
        number = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kAsTheUserHasIt);
    } while (number < 0 && errno == EEXIST);
    Descriptor file(number);
    if (file.number() < 0) return system_error(ErrorCode::kCannotWrite);
    const bool written = write_all(file.number(), bytes) && ::fsync(file.number()) == 0 && file.close() &&
                         ::rename(beside.c_str(), target.c_str()) == 0;
    if (written) return {};
    const Error error = system_error(ErrorCode::kCannotWrite);
    ::unlink(beside.c_str());
    return error;
}

}  // namespace bendy
