// Preloaded before tests that open devices (tests/CMakeLists.txt): what the Vulkan driver and its layers allocate comes
// from a heap here, all else from the address sanitizer. lavapipe compiles kernels by LLVM, millions of allocations a
// kernel: with the sanitizer's heap that takes five times as long. What vkfv does wrong with Vulkan's objects is for
// the validation layer to find. Built without sanitizers, since it is loaded before them.
//
// Which heap a piece is of follows from its address, so that it may be freed by anyone.
#include <dlfcn.h>
#include <link.h>
#include <malloc.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <string_view>
#include <type_traits>
#include <utility>

// A heap makes pointers of addresses, and the macros below make whole functions.
// NOLINTBEGIN(performance-no-int-to-ptr, bugprone-macro-parentheses)

namespace {

using Address = std::uintptr_t;

// ---- The heap: pieces of four sizes an octave, each size with its own list of freed pieces; nothing is given back.

constexpr std::size_t reserved_bytes = std::size_t{64} << 30, step_bytes = std::size_t{32} << 20;
constexpr std::size_t header_bytes = 16; // before a piece: its size's number; keeps 16 bytes of alignment
constexpr std::size_t sizes = 160;

constinit std::atomic<Address> heap_begin{0};

class Spin {
  public:
    void lock() {
        while (flag_.test_and_set(std::memory_order_acquire)) {
            flag_.wait(true, std::memory_order_relaxed);
        }
    }
    void unlock() {
        flag_.clear(std::memory_order_release);
        flag_.notify_one();
    }

  private:
    std::atomic_flag flag_;
};

struct Freed {
    Freed* next;
};

struct SizeList {
    Spin spin;
    Freed* first = nullptr;
};

constinit std::array<SizeList, sizes> lists{};
constinit Spin growing{};
constinit Address unused = 0, usable_end = 0;

constexpr std::size_t number_of(std::size_t bytes) {
    const std::size_t quanta = (bytes + 15) / 16;
    if (quanta <= 4) {
        return quanta == 0 ? 1 : quanta;
    }
    const auto octave = static_cast<std::size_t>(std::bit_width(quanta - 1)); // 2^(octave-1) < quanta <= 2^octave
    const std::size_t quarter = std::size_t{1} << (octave - 3);
    return 4 * octave - 8 + (quanta - (std::size_t{1} << (octave - 1)) + quarter - 1) / quarter;
}

constexpr std::size_t bytes_of(std::size_t number) {
    if (number <= 4) {
        return number * 16;
    }
    const std::size_t octave = (number + 7) / 4, part = number + 8 - 4 * octave;
    return 16 * ((std::size_t{1} << (octave - 1)) + part * (std::size_t{1} << (octave - 3)));
}

constexpr bool every_number_is_the_smallest_that_holds(std::size_t bytes) {
    for (std::size_t k = 0; k <= bytes; k += k < 1024 ? 1 : k / 64) {
        if (bytes_of(number_of(k)) < k || (number_of(k) > 1 && bytes_of(number_of(k) - 1) >= k)) {
            return false;
        }
    }
    return true;
}
static_assert(every_number_is_the_smallest_that_holds(reserved_bytes) && number_of(reserved_bytes) < sizes);

bool is_own(const void* piece) {
    const Address begin = heap_begin.load(std::memory_order_relaxed);
    return begin != 0 && reinterpret_cast<Address>(piece) - begin < reserved_bytes;
}

std::size_t& number_before(void* piece) {
    return *reinterpret_cast<std::size_t*>(static_cast<char*>(piece) - header_bytes);
}

// Objects of the sanitizer's heap that only the driver knows are no leaks. Freed pieces count too: they are not
// cleared.
void tell_the_leak_check(Address begin) {
    using Register = void(const void*, std::size_t);
    if (auto* const tell = reinterpret_cast<Register*>(dlsym(RTLD_DEFAULT, "__lsan_register_root_region"))) {
        tell(reinterpret_cast<const void*>(begin), reserved_bytes);
    }
}

void* fresh(std::size_t number) {
    const std::size_t bytes = bytes_of(number) + header_bytes;
    growing.lock();
    bool first = false;
    if (unused == 0) {
        void* const all = mmap(nullptr, reserved_bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (all != MAP_FAILED) {
            unused = usable_end = reinterpret_cast<Address>(all);
            heap_begin = unused;
            first = true;
        }
    }
    void* piece = nullptr;
    const Address begin = heap_begin;
    if (begin != 0 && unused + bytes <= begin + reserved_bytes) {
        bool usable = true;
        while (usable && unused + bytes > usable_end) {
            usable = usable_end + step_bytes <= begin + reserved_bytes &&
                     mprotect(reinterpret_cast<void*>(usable_end), step_bytes, PROT_READ | PROT_WRITE) == 0;
            usable_end += usable ? step_bytes : 0;
        }
        if (usable) {
            piece = reinterpret_cast<char*>(unused) + header_bytes;
            unused += bytes;
        }
    }
    growing.unlock();
    if (first) {
        tell_the_leak_check(begin);
    }
    return piece;
}

void* own_allocate(std::size_t bytes) {
    if (bytes > reserved_bytes / 2) {
        errno = ENOMEM;
        return nullptr;
    }
    const std::size_t number = number_of(bytes);
    SizeList& list = lists[number];
    list.spin.lock();
    Freed* piece = list.first;
    if (piece != nullptr) {
        list.first = piece->next;
    }
    list.spin.unlock();
    void* const result = piece != nullptr ? piece : fresh(number);
    if (result == nullptr) {
        errno = ENOMEM;
        return nullptr;
    }
    number_before(result) = number;
    return result;
}

// The bits of a piece's header. For alignments above 16 bytes the piece lies within a larger one, and the header tells
// how far in.
constexpr std::size_t is_within = std::size_t{1} << 63, is_free = std::size_t{1} << 62;

void* own_allocate_aligned(std::size_t alignment, std::size_t bytes) {
    if (alignment <= 16 || bytes > reserved_bytes / 2) { // the latter fails there
        return own_allocate(bytes);
    }
    auto* const whole = static_cast<char*>(own_allocate(bytes + alignment));
    if (whole == nullptr) {
        return nullptr;
    }
    const std::size_t in = alignment - reinterpret_cast<Address>(whole) % alignment; // 16 at least
    number_before(whole + in) = is_within | in;
    return whole + in;
}

// The piece that was allocated, and how far into it the known address lies.
void* whole_of(void* piece, std::size_t& in) {
    const std::size_t number = number_before(piece);
    in = (number & is_within) != 0 ? number & ~is_within : 0;
    return static_cast<char*>(piece) - in;
}

std::size_t own_usable(void* piece) {
    std::size_t in = 0;
    void* const whole = whole_of(piece, in);
    return bytes_of(number_before(whole)) - in;
}

void own_free(void* piece) {
    std::size_t in = 0;
    auto* const whole = static_cast<Freed*>(whole_of(piece, in));
    std::size_t& number = number_before(whole);
    if ((number & is_free) != 0) {
        __builtin_trap(); // freed twice
    }
    SizeList& list = lists[number];
    number |= is_free;
    list.spin.lock();
    whole->next = list.first;
    list.first = whole;
    list.spin.unlock();
}

void* own_reallocate(void* piece, std::size_t bytes) {
    if (piece != nullptr && bytes > 0 && bytes <= own_usable(piece)) {
        return piece;
    }
    void* const larger = own_allocate(bytes);
    if (larger != nullptr && piece != nullptr) {
        std::memcpy(larger, piece, std::min(bytes, own_usable(piece)));
        own_free(piece);
    }
    return larger;
}

// ---- Who calls: the code of the driver, of LLVM and of the validation layer, known once they are loaded.

struct Code {
    std::atomic<Address> begin{0}, bytes{0};
};
constinit std::array<Code, 4> drivers{};
constexpr std::array<std::string_view, 4> driver_files = {"/libLLVM-", "/libLLVM.so", "/libvulkan_lvp.",
                                                          "/libVkLayer_khronos_validation."};

bool is_driver(const void* caller) {
    const auto at = reinterpret_cast<Address>(caller);
    bool found = false;
    for (const Code& code : drivers) {
        found = found || at - code.begin.load(std::memory_order_relaxed) < code.bytes.load(std::memory_order_relaxed);
    }
    return found;
}

using Ranges = std::array<std::pair<Address, Address>, 4>; // begin and bytes

int find_driver(dl_phdr_info* library, std::size_t, void* ranges) {
    for (std::size_t k = 0; k < driver_files.size(); ++k) {
        if (std::string_view(library->dlpi_name).find(driver_files[k]) == std::string_view::npos) {
            continue;
        }
        for (int segment = 0; segment < library->dlpi_phnum; ++segment) {
            const auto& part = library->dlpi_phdr[segment];
            if (part.p_type == PT_LOAD && (part.p_flags & PF_X) != 0) {
                (*static_cast<Ranges*>(ranges))[k] = {library->dlpi_addr + part.p_vaddr, part.p_memsz};
            }
        }
    }
    return 0;
}

// Finds the drivers that are loaded now, and forgets those that are no longer there.
void find_drivers() {
    Ranges ranges{};
    dl_iterate_phdr(find_driver, &ranges);
    for (std::size_t k = 0; k < drivers.size(); ++k) {
        if (drivers[k].begin != ranges[k].first) {
            drivers[k].bytes = 0; // no half-told range meanwhile
            drivers[k].begin = ranges[k].first;
        }
        drivers[k].bytes = ranges[k].second;
    }
}

// ---- The functions that are called in place of the sanitizer's.

thread_local bool looking __attribute__((tls_model("initial-exec"))) = false;

// The next library's function of this name; none while it is being looked for, which itself may allocate.
template <class Function>
Function* next(std::atomic<Function*>& known, const char* name) {
    Function* function = known.load(std::memory_order_relaxed);
    if (function == nullptr && !looking) {
        looking = true;
        function = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
        known.store(function, std::memory_order_relaxed);
        looking = false;
    }
    return function;
}

#define VKFV_NEXT(name, ...)                                                                                           \
    static constinit std::atomic<std::add_pointer_t<__VA_ARGS__>> known{nullptr};                                      \
    auto* const onward = next(known, name)
#define VKFV_EXPORT __attribute__((visibility("default"), noinline))
#define VKFV_CALLER __builtin_return_address(0)

} // namespace

extern "C" {

// The number of bytes that the heap has had in use, so that a test sees that it serves.
VKFV_EXPORT std::size_t vkfv_driver_heap_bytes() {
    return unused - heap_begin;
}

VKFV_EXPORT void* dlopen(const char* file, int mode) {
    VKFV_NEXT("dlopen", void*(const char*, int));
    void* const library = onward(file, mode);
    find_drivers();
    return library;
}

VKFV_EXPORT void* malloc(std::size_t bytes) {
    VKFV_NEXT("malloc", void*(std::size_t));
    return onward == nullptr || is_driver(VKFV_CALLER) ? own_allocate(bytes) : onward(bytes);
}

VKFV_EXPORT void* calloc(std::size_t count, std::size_t bytes) {
    VKFV_NEXT("calloc", void*(std::size_t, std::size_t));
    if (onward != nullptr && !is_driver(VKFV_CALLER)) {
        return onward(count, bytes);
    }
    std::size_t all = 0;
    if (__builtin_mul_overflow(count, bytes, &all)) {
        errno = ENOMEM;
        return nullptr;
    }
    void* const piece = own_allocate(all);
    return piece == nullptr ? nullptr : std::memset(piece, 0, all);
}

VKFV_EXPORT void* realloc(void* piece, std::size_t bytes) {
    VKFV_NEXT("realloc", void*(void*, std::size_t));
    const bool own = piece == nullptr ? onward == nullptr || is_driver(VKFV_CALLER) : is_own(piece);
    return own ? own_reallocate(piece, bytes) : onward(piece, bytes);
}

VKFV_EXPORT void* reallocarray(void* piece, std::size_t count, std::size_t bytes) {
    VKFV_NEXT("reallocarray", void*(void*, std::size_t, std::size_t));
    const bool own = piece == nullptr ? onward == nullptr || is_driver(VKFV_CALLER) : is_own(piece);
    if (!own) {
        return onward(piece, count, bytes);
    }
    std::size_t all = 0;
    if (__builtin_mul_overflow(count, bytes, &all)) {
        errno = ENOMEM;
        return nullptr;
    }
    return own_reallocate(piece, all);
}

VKFV_EXPORT void free(void* piece) {
    if (piece != nullptr && is_own(piece)) {
        own_free(piece);
        return;
    }
    VKFV_NEXT("free", void(void*));
    if (onward != nullptr) {
        onward(piece);
    }
}

VKFV_EXPORT int posix_memalign(void** result, std::size_t alignment, std::size_t bytes) {
    VKFV_NEXT("posix_memalign", int(void**, std::size_t, std::size_t));
    if (!is_driver(VKFV_CALLER)) {
        return onward(result, alignment, bytes);
    }
    *result = own_allocate_aligned(alignment, bytes);
    return *result == nullptr ? ENOMEM : 0;
}

VKFV_EXPORT void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
    VKFV_NEXT("aligned_alloc", void*(std::size_t, std::size_t));
    return is_driver(VKFV_CALLER) ? own_allocate_aligned(alignment, bytes) : onward(alignment, bytes);
}

VKFV_EXPORT void* memalign(std::size_t alignment, std::size_t bytes) {
    VKFV_NEXT("memalign", void*(std::size_t, std::size_t));
    return is_driver(VKFV_CALLER) ? own_allocate_aligned(alignment, bytes) : onward(alignment, bytes);
}

VKFV_EXPORT std::size_t malloc_usable_size(void* piece) {
    VKFV_NEXT("malloc_usable_size", std::size_t(void*));
    return piece != nullptr && is_own(piece) ? own_usable(piece) : onward(piece);
}

} // extern "C"

// The sanitizer knows which of new's forms a piece came from, so each goes on to its own. A driver that finds no memory
// ends: it never does here.
#define VKFV_NEW(symbol, own, parameters, types, arguments)                                                            \
    extern "C" VKFV_EXPORT void* symbol parameters {                                                                   \
        VKFV_NEXT(#symbol, void* types);                                                                               \
        return is_driver(VKFV_CALLER) ? own : onward arguments;                                                        \
    }
#define VKFV_DELETE(symbol, parameters, types, arguments)                                                              \
    extern "C" VKFV_EXPORT void symbol parameters {                                                                    \
        if (piece != nullptr && is_own(piece)) {                                                                       \
            own_free(piece);                                                                                           \
            return;                                                                                                    \
        }                                                                                                              \
        VKFV_NEXT(#symbol, void types);                                                                                \
        onward arguments;                                                                                              \
    }
#define VKFV_NEWS(kind)                                                                                                \
    VKFV_NEW(_Zn##kind##m, own_allocate(n), (std::size_t n), (std::size_t), (n))                                       \
    VKFV_NEW(_Zn##kind##mRKSt9nothrow_t, own_allocate(n), (std::size_t n, const void* t), (std::size_t, const void*),  \
             (n, t))                                                                                                   \
    VKFV_NEW(_Zn##kind##mSt11align_val_t, own_allocate_aligned(a, n), (std::size_t n, std::size_t a),                  \
             (std::size_t, std::size_t), (n, a))                                                                       \
    VKFV_NEW(_Zn##kind##mSt11align_val_tRKSt9nothrow_t, own_allocate_aligned(a, n),                                    \
             (std::size_t n, std::size_t a, const void* t), (std::size_t, std::size_t, const void*), (n, a, t))
#define VKFV_DELETES(kind)                                                                                             \
    VKFV_DELETE(_Zd##kind##Pv, (void* piece), (void*), (piece))                                                        \
    VKFV_DELETE(_Zd##kind##Pvm, (void* piece, std::size_t n), (void*, std::size_t), (piece, n))                        \
    VKFV_DELETE(_Zd##kind##PvRKSt9nothrow_t, (void* piece, const void* t), (void*, const void*), (piece, t))           \
    VKFV_DELETE(_Zd##kind##PvSt11align_val_t, (void* piece, std::size_t a), (void*, std::size_t), (piece, a))          \
    VKFV_DELETE(_Zd##kind##PvmSt11align_val_t, (void* piece, std::size_t n, std::size_t a),                            \
                (void*, std::size_t, std::size_t), (piece, n, a))                                                      \
    VKFV_DELETE(_Zd##kind##PvSt11align_val_tRKSt9nothrow_t, (void* piece, std::size_t a, const void* t),               \
                (void*, std::size_t, const void*), (piece, a, t))
VKFV_NEWS(w)
VKFV_NEWS(a)
VKFV_DELETES(l)
VKFV_DELETES(a)

// NOLINTEND(performance-no-int-to-ptr, bugprone-macro-parentheses)
