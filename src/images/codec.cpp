#include "images/codec.hpp"

#include "core/error.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#ifdef __SANITIZE_ADDRESS__
// The leak sanitizer stumbles over the thread-local storage of libraries that are loaded late (g++ 12).
extern "C" __attribute__((weak)) const char* __asan_default_options(); // a test has its own
extern "C" __attribute__((weak)) const char* __asan_default_options() {
    return "intercept_tls_get_addr=0";
}
#endif

namespace vkfv::images {

namespace {

// Beside the program, or where it was installed; else wherever the loader looks. By a path of its own, since sanitizers
// hide the program's run path from dlopen(). Never unloaded.
void* open_module() {
    const std::filesystem::path name = VKFV_IMAGE_MODULE;
    std::error_code none;
    const auto folder = std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
    for (const auto& path : {folder / name, folder.parent_path() / "lib/vkfv" / name}) {
        if (std::filesystem::exists(path, none)) {
            return dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        }
    }
    return dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
}

const Codec& loaded() {
    void* const module = open_module();
    const void* const found = module != nullptr ? dlsym(module, "vkfv_image_codec") : nullptr;
    if (found == nullptr) {
        throw RunError(
            fmt::format("The module that reads and writes images cannot be loaded: {}. Install vkfv again, or "
                        "what is missing of OpenImageIO",
                        dlerror()));
    }
    return *static_cast<const Codec*>(found);
}

} // namespace

const Codec& codec() {
    static const Codec& once = loaded();
    return once;
}

std::string tiff_bytes(const Grid<float>& image, const ImageTags& tags) {
    return codec().tiff_of_floats(std::span(&image, 1), tags);
}

std::string tiff_bytes(const std::vector<Grid<float>>& channels, const ImageTags& tags) {
    return codec().tiff_of_floats(channels, tags);
}

std::string tiff_bytes(const Grid<std::uint16_t>& image, const ImageTags& tags) {
    return codec().tiff_of_integers(image, tags);
}

int page_count(const std::filesystem::path& path) {
    return codec().page_count(path);
}

Grid<float> read_image(const std::filesystem::path& path, int page) {
    return codec().read_image(path, page);
}

std::vector<Grid<float>> read_channels(const std::filesystem::path& path, int page) {
    return codec().read_channels(path, page);
}

std::string image_description(const std::filesystem::path& path) {
    return codec().image_description(path);
}

StoredImage parse_tiff(std::string_view bytes, const std::filesystem::path& path) {
    return codec().parse_tiff(bytes, path);
}

DescribedImage parse_image(std::string_view bytes, ImageFormat format, const std::filesystem::path& path) {
    return codec().parse_image(bytes, format, path);
}

Grid<float> parse_grey(std::string_view bytes, std::uint64_t most_pixels, const std::filesystem::path& path) {
    return codec().parse_grey(bytes, most_pixels, path);
}

std::string png_bytes(int columns, int rows, std::span<const std::uint8_t> rgb) {
    return codec().png(columns, rows, rgb);
}

Ink ink_of(const std::string& letter, int size, const std::string& font) {
    return codec().ink_of(letter, size, font);
}

Grid<float> drawn(const DrawnLetter& letter, int columns, int rows) {
    return codec().drawn(letter, columns, rows);
}

} // namespace vkfv::images
