#include "mutation/allocations.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

#ifdef _WIN32
#include <malloc.h>
#endif

namespace bendy::test {
namespace {

// Atomic only for other threads' sake: the tests count on one.
std::atomic<std::uint64_t> count{0};
std::atomic<std::uint64_t> bytes{0};
std::atomic<std::uint64_t> largest{0};
std::atomic<std::int64_t> live{0};
std::atomic<std::uint64_t> until_failure{0};

#ifdef _WIN32
// There, what is aligned otherwise cannot be given to free(): all of it is taken as aligned.
void* take(std::size_t size, std::size_t alignment) {
    return ::_aligned_malloc(size, alignment);
}
void give_back(void* memory) {
    ::_aligned_free(memory);
}
#else
// As malloc gives it where that will do: a sanitizer then sees one byte too many.
void* take(std::size_t size, std::size_t alignment) {
    if (alignment <= alignof(std::max_align_t)) return std::malloc(size);
    return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}
void give_back(void* memory) {
    std::free(memory);
}
#endif

void* allocate(std::size_t size, std::size_t alignment) {
    if (until_failure != 0 && --until_failure == 0) return nullptr;
    ++count;
    bytes += size;
    largest = std::max(largest.load(), std::uint64_t{size});
    size = std::max(size, std::size_t{1});
    void* const memory = take(size, alignment);
    if (memory != nullptr) ++live;
    return memory;
}

void* allocate_or_throw(std::size_t size, std::size_t alignment) {
    void* const memory = allocate(size, alignment);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

/// Not inlined: the compiler would see free() take what operator new gave, and warn.
[[gnu::noinline]] void release(void* memory) noexcept {
    if (memory == nullptr) return;
    --live;
    give_back(memory);
}

}  // namespace

void restart_count() {
    count = bytes = largest = 0;
}

Allocations allocations() {
    return {count, bytes, largest, live};
}

void fail_allocation(std::uint64_t number) {
    until_failure = number;
}

bool is_failure_pending() {
    return until_failure != 0;
}

}  // namespace bendy::test

using bendy::test::allocate;
using bendy::test::allocate_or_throw;
using bendy::test::release;

void* operator new(std::size_t size) {
    return allocate_or_throw(size, alignof(std::max_align_t));
}
void* operator new[](std::size_t size) {
    return allocate_or_throw(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, alignof(std::max_align_t));
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate_or_throw(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return allocate_or_throw(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
    release(memory);
}
void operator delete[](void* memory) noexcept {
    release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    release(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    release(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
    release(memory);
}
void operator delete[](void* memory, const std::nothrow_t&) noexcept {
    release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    release(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
    release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    release(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
    release(memory);
}
