// How every image gets to OpenImageIO, whatever its format and whether it is a file or in memory.
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

// An image that OpenImageIO reads, opened by the reader of its format alone: other readers are not offered the bytes.
struct OpenImage {
    // The input reads from one of these, an open file or its bytes, so they must outlive it.
    std::unique_ptr<InputFile> file{};
    std::unique_ptr<std::string> owned{};
    std::unique_ptr<OIIO::Filesystem::IOProxy> proxy{};
    std::unique_ptr<OIIO::ImageInput> input{};
    std::uint64_t bytes = 0; // of the whole file
};

// The format is that of the first bytes, or of the name's ending where a format has no mark. Values come as they are
// stored, not multiplied by their opacity. Throws InputError for a file that cannot be opened as an image.
OpenImage open_image(const std::filesystem::path& path);
// The same of a whole file in memory, which must outlive the image; `path` names it in messages.
OpenImage open_image(std::string_view bytes, const std::filesystem::path& path);

// Which channel is opacity; -1: none. OpenImageIO 2.4 says of a GIF that its opacity is behind the last channel.
int opacity_channel(const OIIO::ImageSpec& spec);

// OpenImageIO 2.4 reads values of 64 bits of a TIFF by whole strips alone. Of tiles and of single rows it returns what
// was in the memory before, and says that it read them.
inline bool whole_strips_only(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec) {
    return std::string_view(input.format_name()) == "tiff" && spec.format.size() == sizeof(double);
}
// Throws InputError where it would not read them.
void refuse_lost_values(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const std::filesystem::path& path);

} // namespace vkfv::images::openimageio
