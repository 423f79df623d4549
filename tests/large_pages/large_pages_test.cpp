// Exits with 1 and says where memory is not what the language promises, or large blocks are not asked for in large
// pages.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <vector>

namespace {

int failures = 0;

void expect(bool holds, const char* what, std::size_t size) {
    if (!holds) {
        std::printf("%s: %zu bytes\n", what, size);
        ++failures;
    }
}

bool is_aligned(const void* block, std::size_t alignment) {
    return reinterpret_cast<std::uintptr_t>(block) % alignment == 0;
}

// Whether the system's list of mappings has the flag of large pages on request, hg, for a block.
bool is_in_large_pages(const void* block) {
    const auto place = reinterpret_cast<std::uintptr_t>(block);
    std::ifstream mappings("/proc/self/smaps");
    std::string line;
    bool inside = false;
    while (std::getline(mappings, line)) {
        std::uintptr_t first = 0, end = 0;
        char dash = 0;
        if (std::istringstream(line) >> std::hex >> first >> dash >> end && dash == '-') {
            inside = place >= first && place < end;
        } else if (inside && line.starts_with("VmFlags:")) {
            return line.find(" hg") != std::string::npos;
        }
    }
    return false;
}

} // namespace

int main() {
    constexpr std::size_t large = std::size_t{3} << 20;
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, large - 1, large, large + 1, 20 * large}) {
        auto* block = static_cast<char*>(::operator new(size));
        expect(block != nullptr && is_aligned(block, alignof(std::max_align_t)), "not aligned", size);
        std::memset(block, 7, size);
        expect(is_in_large_pages(block) == (size >= large), "pages of another size than expected", size);
        ::operator delete(block);
    }
    // Two blocks at a time do not share a byte, whichever is freed first.
    for (const bool first : {true, false}) {
        auto a = std::make_unique<std::vector<int>>(large, 1), b = std::make_unique<std::vector<int>>(large, 2);
        (first ? a : b).reset();
        const auto& left = first ? *b : *a;
        std::size_t same = 0;
        for (const int value : left) {
            same += value == (first ? 2 : 1) ? 1 : 0;
        }
        expect(same == large, "bytes of another block", large);
    }
    const std::size_t everything = std::numeric_limits<std::size_t>::max();
    for (const std::size_t size : {everything, everything - large, everything / 2}) {
        bool thrown = false;
        try {
            ::operator delete(::operator new(size));
        } catch (const std::bad_alloc&) {
            thrown = true;
        }
        expect(thrown, "no std::bad_alloc", size);
        expect(::operator new(size, std::nothrow) == nullptr, "memory there is not", size);
    }
    auto* aligned = new (std::align_val_t{4096}) char[2 * large];
    expect(is_aligned(aligned, 4096), "not aligned as asked", 2 * large);
    ::operator delete[](aligned, std::align_val_t{4096});
    return failures > 0 ? 1 : 0;
}
