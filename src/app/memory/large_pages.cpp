// Operators new and delete that ask the system (madvise) for pages of 2 MiB for large memory, as images and reliefs
// take. The system gives each page by a fault and fills it with zeros; with pages of 4 KiB this took half of the time
// of a specimen of ten million points. std::free may free all of this memory, as libraries do that do not know of these
// operators.
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

#include <sys/mman.h>

namespace {

constexpr std::size_t page = std::size_t{2} << 20;
constexpr std::size_t large = std::size_t{3} << 20; // bytes, less than an image of 1000 x 1000 floats

void* allocate(std::size_t size) {
    if (size < large || size > std::numeric_limits<std::size_t>::max() - page) {
        return std::malloc(size > 0 ? size : 1);
    }
    const std::size_t whole = (size + page - 1) / page * page;
    void* block = std::aligned_alloc(page, whole);
    if (block != nullptr) {
        madvise(block, whole, MADV_HUGEPAGE); // if refused, the pages stay small
    }
    return block;
}

} // namespace

void* operator new(std::size_t size) {
    for (;;) {
        if (void* block = allocate(size)) {
            return block;
        }
        const std::new_handler handler = std::get_new_handler();
        if (handler == nullptr) {
            throw std::bad_alloc();
        }
        handler();
    }
}

void operator delete(void* block) noexcept {
    std::free(block);
}

void operator delete(void* block, std::size_t /*size*/) noexcept {
    std::free(block);
}
