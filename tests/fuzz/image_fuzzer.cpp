// Any bytes are an image or an InputError: as a specimen, as a mask, and as a file of a stack, of which RunError may
// say that the library cannot read such a kind at all. The number of a file's pages and its statements are read as
// well.
#include "core/messages/error.hpp"
#include "images/image_file.hpp"
#include "images/tiff.hpp"
#include "specimen/files.hpp"

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace {

// A path with the ending that belongs to the bytes.
std::filesystem::path file_for(std::string_view bytes) {
    const char* ending = bytes.starts_with("\x89PNG")            ? ".png"
                         : bytes.starts_with("\xff\xd8")         ? ".jpg"
                         : bytes.starts_with("BM")               ? ".bmp"
                         : bytes.starts_with("P")                ? ".pgm"
                         : bytes.starts_with("\x76\x2f\x31\x01") ? ".exr"
                                                                 : ".tif";
    return std::filesystem::temp_directory_path() / ("vkfv-fuzzed-" + std::to_string(getpid()) + ending);
}

} // namespace

// The library's reader of PNG jumps over its own destructors at an error, and loses a few bytes.
extern "C" const char* __asan_default_options() {
    return "detect_leaks=0";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    constexpr std::uint64_t most_pixels = 1 << 20;
    constexpr std::uint32_t gdal_nodata = 42113; // a tag of texts
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const auto refused_or_read = [](const auto& read) {
        try {
            (void)read();
        } catch (const InputError&) {
        } catch (const RunError&) {
        }
    };
    try {
        (void)specimen::parse_image(bytes, "fuzzed");
    } catch (const InputError&) {
    }
    refused_or_read([&] { return images::parse_grey(bytes, most_pixels, "fuzzed"); });
    refused_or_read([&] { return images::tiff_text(bytes, gdal_nodata); });
    const auto file = file_for(bytes);
    std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
    refused_or_read([&] { return images::page_count(file); });
    refused_or_read([&] { return images::image_statement(file); });
    refused_or_read([&] { return images::read_channels(file); });
    std::filesystem::remove(file);
    return 0;
}
