// The access of OpenImageIO to images of all formats, in files or in memory.
#pragma once

#include "core/files/file.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace vkfv::images::openimageio {

// An image that OpenImageIO reads, opened by the reader of its format only; other readers do not see the bytes.
struct OpenImage {
    // The input reads from one of these members, an open file or its bytes, so they must outlive it.
    std::unique_ptr<InputFile> file{};
    std::unique_ptr<std::string> owned{};
    std::unique_ptr<OIIO::Filesystem::IOProxy> proxy{};
    std::unique_ptr<OIIO::ImageInput> input{};
    std::uint64_t bytes = 0; // size of the whole file
};

// Opens an image. The format is that of the first bytes, or of the name's ending for formats without a mark. Values are
// as stored, not multiplied by their opacity. Throws InputError for a file that cannot be opened as an image.
OpenImage open_image(const std::filesystem::path& path);
// Opens an image in memory, a whole file, which must outlive the result; `path` names it in messages.
OpenImage open_image(std::string_view bytes, const std::filesystem::path& path);

// The index of the opacity channel; -1: none. For a GIF, OpenImageIO 2.4 gives an index behind the last channel.
int opacity_channel(const OIIO::ImageSpec& spec);

// True if the values of a TIFF are as stored and 0 is white: OpenImageIO turns values of 8 bits alone round.
bool counts_from_white(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec);

// True for values of 64 bits in a TIFF, which OpenImageIO 2.4 reads only by whole strips. For tiles and single rows it
// returns uninitialized memory and reports success.
inline bool whole_strips_only(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec) {
    return std::string_view(input.format_name()) == "tiff" && spec.format.size() == sizeof(double);
}
// Throws InputError for values that OpenImageIO would not read.
void refuse_lost_values(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const std::filesystem::path& path);

} // namespace vkfv::images::openimageio
