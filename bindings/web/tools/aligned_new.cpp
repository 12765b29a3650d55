// The tools rely on malloc for the 16-byte alignment of a bendy file's bytes; emscripten's malloc aligns to 8.
#include <algorithm>
#include <cstdlib>
#include <new>

void* operator new(std::size_t size) {
    constexpr std::size_t kAlignment = 16;
    void* memory = nullptr;
    if (posix_memalign(&memory, kAlignment, std::max<std::size_t>(size, 1)) != 0) throw std::bad_alloc();
    return memory;
}

void operator delete(void* memory) noexcept {
    std::free(memory);
}

void operator delete(void* memory, std::size_t /*size*/) noexcept {
    std::free(memory);
}
