#include "core/files/installation.hpp"

#include "core/messages/error.hpp"

#include <dlfcn.h>
#include <elf.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <link.h>
#include <sys/auxv.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <span>
#include <system_error>

namespace vkfv {

namespace fs = std::filesystem;

namespace {

// The file that contains this code: a program, or a module that another program has loaded.
fs::path own_file() {
    Dl_info info{};
    link_map* map = nullptr;
    std::error_code none;
    // The loader's name is empty for the program itself, and only for it.
    if (dladdr1(reinterpret_cast<const void*>(&own_file), &info, reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) !=
            0 &&
        map != nullptr && map->l_name != nullptr && *map->l_name != '\0') {
        return fs::canonical(map->l_name, none);
    }
    if (fs::path program = fs::read_symlink("/proc/self/exe", none); !program.empty()) {
        return program;
    }
    // Without /proc, as in a bare chroot, the name by which the program was started serves.
    const auto* started = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
    return started == nullptr ? fs::path() : fs::canonical(started, none);
}

} // namespace

std::vector<fs::path> with_parents(const fs::path& folder) {
    std::vector<fs::path> all;
    for (auto one = folder; !one.empty(); one = one.parent_path()) {
        all.push_back(one);
        if (one == one.parent_path()) {
            break;
        }
    }
    return all;
}

std::optional<fs::path> find_installed(const fs::path& relative) {
    fs::path refused;
    for (const auto& folder : with_parents(own_file().parent_path())) {
        std::error_code error;
        if (fs::exists(folder / relative, error)) {
            return folder / relative;
        }
        refused = refused.empty() && error == std::errc::permission_denied ? folder / relative : refused;
    }
    if (!refused.empty()) {
        throw RunError(fmt::format("{}: {}. Give yourself the permission to read it, and the folders above it",
                                   refused.string(), std::generic_category().message(EACCES)));
    }
    return std::nullopt;
}

std::string build_id() {
    std::string id;
    // The callback looks for the file that contains this function in one of its segments.
    const auto look = [](dl_phdr_info* info, std::size_t, void* result) {
        const auto headers = std::span(info->dlpi_phdr, info->dlpi_phnum);
        const auto here = reinterpret_cast<std::uintptr_t>(&build_id);
        const bool own = std::ranges::any_of(headers, [&](const ElfW(Phdr) & header) {
            const std::uintptr_t begin = info->dlpi_addr + header.p_vaddr;
            return header.p_type == PT_LOAD && here >= begin && here < begin + header.p_memsz;
        });
        if (!own) {
            return 0;
        }
        for (const auto& header : headers) {
            if (header.p_type != PT_NOTE) {
                continue;
            }
            const auto notes =
                std::span(std::bit_cast<const unsigned char*>(info->dlpi_addr + header.p_vaddr), header.p_memsz);
            const auto padded = [](std::size_t bytes) { return (bytes + 3) / 4 * 4; };
            for (std::size_t at = 0; at + sizeof(ElfW(Nhdr)) <= notes.size();) {
                ElfW(Nhdr) note;
                std::memcpy(&note, notes.data() + at, sizeof note);
                const std::size_t text = at + sizeof note + padded(note.n_namesz);
                if (note.n_type == NT_GNU_BUILD_ID && text + note.n_descsz <= notes.size()) {
                    *static_cast<std::string*>(result) =
                        fmt::format("{:02x}", fmt::join(notes.subspan(text, note.n_descsz), ""));
                }
                at = text + padded(note.n_descsz);
            }
        }
        return 1;
    };
    dl_iterate_phdr(look, &id);
    return id;
}

} // namespace vkfv
