// Memory of images and reliefs in pages of 2 MiB, where the system gives them on request (madvise): it gives a page by
// a fault and fills it with zeros, and 4 KiB at a time this took half of the time of a specimen of ten million points.
// All of it may be freed by std::free, as libraries that do not know of these operators do.
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

#include <sys/mman.h>

namespace {

constexpr std::size_t page = std::size_t{2} << 20;
constexpr std::size_t large = std::size_t{3} << 20; // less than an image of 1000 x 1000 floats

void* allocate(std::size_t size) {
    if (size < large || size > std::numeric_limits<std::size_t>::max() - page) {
        return std::malloc(size > 0 ? size : 1);
    }
    const std::size_t whole = (size + page - 1) / page * page;
    void* block = std::aligned_alloc(page, whole);
    if (block != nullptr) {
        madvise(block, whole, MADV_HUGEPAGE); // where it is refused, pages are small
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
