#include "images/openimageio/source.hpp"

#include "core/messages/error.hpp"
#include "images/exr_header.hpp"
#include "images/pnm_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <span>
#include <utility>

namespace vkfv::images::openimageio {
namespace {

using OIIO::Filesystem::IOProxy;

// A file read by position. OpenImageIO's own file proxy passes its stream to some readers, which start wherever another
// reader, or an earlier attempt of their own, left it: with OpenImageIO 2.4 every JPEG began at byte 4096. This proxy
// has no stream, and a reader that needs one refuses a proxy of another type.
class FileProxy : public IOProxy {
  public:
    explicit FileProxy(const InputFile& file) : IOProxy("", Read), file_(file) {}

    const char* proxytype() const override { return "vkfv"; }
    std::size_t size() const override { return file_.bytes(); }
    std::size_t pread(void* to, std::size_t count, std::int64_t place) override {
        return place < 0 ? 0 : file_.read_at(static_cast<std::uint64_t>(place), {static_cast<char*>(to), count});
    }
    // Some readers request single bytes in sequence: these are served from a block.
    std::size_t read(void* to, std::size_t count) override {
        char* const into = static_cast<char*>(to);
        std::size_t done = 0;
        while (done < count) {
            const std::string_view ready = block_from(m_pos);
            const std::size_t some = std::min(ready.size(), count - done);
            if (some == 0) {
                break;
            }
            std::copy_n(ready.data(), some, into + done);
            done += some;
            m_pos += static_cast<std::int64_t>(some);
        }
        return done;
    }

  private:
    // The bytes of the block from this place on; empty at the end of the file.
    std::string_view block_from(std::int64_t place) {
        const auto inside = [&] {
            return place >= block_place_ && place < block_place_ + static_cast<std::int64_t>(block_.size());
        };
        if (!inside()) {
            block_.resize(block_bytes);
            block_place_ = place;
            block_.resize(pread(block_.data(), block_.size(), place));
        }
        return inside() ? std::string_view(block_).substr(static_cast<std::size_t>(place - block_place_))
                        : std::string_view();
    }

    static constexpr std::size_t block_bytes = std::size_t{1} << 16;
    const InputFile& file_;
    std::string block_{};
    std::int64_t block_place_ = 0;
};

struct Mark {
    std::string_view bytes;
    const char* format; // OpenImageIO's name of the reader
    std::size_t place = 0;
};
using namespace std::string_view_literals;
constexpr std::array marks = {Mark{"II*\0"sv, "tiff"},
                              Mark{"MM\0*"sv, "tiff"},
                              Mark{"II+\0"sv, "tiff"},
                              Mark{"MM\0+"sv, "tiff"},
                              Mark{"\x89PNG"sv, "png"},
                              Mark{"\xff\xd8\xff"sv, "jpeg"},
                              Mark{"BM"sv, "bmp"},
                              Mark{"#?RADIANCE"sv, "hdr"},
                              Mark{"#?RGBE"sv, "hdr"},
                              Mark{"P1"sv, "pnm"},
                              Mark{"P2"sv, "pnm"},
                              Mark{"P3"sv, "pnm"},
                              Mark{"P4"sv, "pnm"},
                              Mark{"P5"sv, "pnm"},
                              Mark{"P6"sv, "pnm"},
                              Mark{"Pf"sv, "pnm"},
                              Mark{"PF"sv, "pnm"},
                              Mark{"\x76\x2f\x31\x01"sv, "openexr"},
                              Mark{"WEBP"sv, "webp", 8},
                              Mark{"GIF8"sv, "gif"},
                              Mark{"\0\0\0\x0cjP  "sv, "jpeg2000"},
                              Mark{"\xff\x4f\xff\x51"sv, "jpeg2000"},
                              Mark{"SDPX"sv, "dpx"},
                              Mark{"XPDS"sv, "dpx"},
                              Mark{"8BPS"sv, "psd"}};
constexpr std::size_t mark_bytes = 16;

// Raw formats are recognized by their endings, since most of them begin like a TIFF, which would be read as a
// thumbnail.
constexpr std::array raw_endings = {".3fr", ".arw", ".cr2", ".cr3", ".crw", ".dng", ".erf", ".iiq",
                                    ".kdc", ".mef", ".mos", ".mrw", ".nef", ".nrw", ".orf", ".pef",
                                    ".raf", ".rw2", ".rwl", ".sr2", ".srf", ".srw", ".x3f"};

constexpr const char* kinds =
    "an image: TIFF, PNG, JPEG, JPEG 2000, WebP, BMP, PGM, OpenEXR, HDR, GIF, TGA, DPX or PSD";

// The limit of a JPEG, which is decoded from memory: it has at most 65535 x 65535 pixels of three bytes, and
// compression makes them fewer.
constexpr std::uint64_t largest_jpeg = std::uint64_t{1} << 30;

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& found, const std::string& expected,
                         const std::string& remedy) {
    refuse_file(path, "image", found, expected, remedy);
}

std::string format_of(std::string_view beginning, const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
    if (std::ranges::find(raw_endings, ending) != raw_endings.end()) {
        refuse(path, "a camera's raw file", kinds,
               "Develop all images of the stack with the same settings, without sharpening, and save them as TIFF of "
               "16 bits.");
    }
    for (const Mark& mark : marks) {
        if (beginning.size() >= mark.place && beginning.substr(mark.place).starts_with(mark.bytes)) {
            return mark.format;
        }
    }
    if (ending == ".tga") {
        return "targa";
    }
    refuse(path, "a file of unknown kind", kinds, "Convert it to PNG, TIFF or OpenEXR.");
}

void open_input(OpenImage& image, const std::string& format, const std::filesystem::path& path) {
    image.input = OIIO::ImageInput::create(format);
    (void)OIIO::geterror();
    if (!image.input || !image.input->supports("ioproxy")) {
        refuse(path, fmt::format("a file of the kind {}", format), "a kind that this OpenImageIO reads",
               "Convert it to PNG, TIFF or OpenEXR.");
    }
    OIIO::ImageSpec wish;
    wish.attribute("oiio:UnassociatedAlpha", 1); // grey values and colours must not be multiplied by opacity
    // The proxy is also named in the configuration, because OpenImageIO 2.4 then looks for it only there.
    IOProxy* proxy = image.proxy.get();
    wish.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    OIIO::ImageSpec spec;
    if (!image.input->set_ioproxy(proxy) || !image.input->open("image", spec, wish) || image.input->has_error()) {
        refuse(path, image.input->geterror(), "a readable image", "Write the file anew, as single-channel TIFF.");
    }
}

} // namespace

OpenImage open_image(std::string_view bytes, const std::filesystem::path& path) {
    if (looks_like_exr(bytes)) {
        check_exr_attributes(bytes, path);
    }
    if (looks_like_pnm(bytes)) {
        check_pnm(bytes, path);
    }
    const std::string format = format_of(bytes.substr(0, mark_bytes), path);
    OpenImage image{.proxy = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes.data(), bytes.size()),
                    .bytes = bytes.size()};
    open_input(image, format, path);
    return image;
}

OpenImage open_image(const std::filesystem::path& path) {
    auto file = std::make_unique<InputFile>(path, FileRequest{.expected = "an image file"});
    const std::string beginning = file->read(mark_bytes);
    const std::string format = format_of(beginning, path);
    const bool jpeg = format == "jpeg";
    if (jpeg && file->bytes() > largest_jpeg) {
        refuse(path, fmt::format("a JPEG of {} bytes", file->bytes()), fmt::format("at most {} bytes", largest_jpeg),
               "Save it as TIFF.");
    }
    // These formats are read whole: JPEG is decoded from memory, and the headers of the others are checked before the
    // library allocates the sizes that they claim.
    if (jpeg || looks_like_exr(beginning) || looks_like_pnm(beginning)) {
        auto owned = std::make_unique<std::string>(file->read());
        OpenImage image = open_image(*owned, path);
        image.owned = std::move(owned);
        return image;
    }
    OpenImage image{.proxy = std::make_unique<FileProxy>(*file), .bytes = file->bytes()};
    image.file = std::move(file);
    open_input(image, format, path);
    return image;
}

int opacity_channel(const OIIO::ImageSpec& spec) {
    if (spec.alpha_channel < spec.nchannels) {
        return spec.alpha_channel;
    }
    const auto named = std::ranges::find(spec.channelnames, "A");
    return named == spec.channelnames.end() ? -1 : static_cast<int>(named - spec.channelnames.begin());
}

bool counts_from_white(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec) {
    constexpr int white_is_zero = 0, unknown = -1; // TIFF 6.0, tag 262
    return std::string_view(input.format_name()) == "tiff" &&
           (spec.format.basetype == OIIO::TypeDesc::UINT16 || spec.format.basetype == OIIO::TypeDesc::UINT32) &&
           spec.get_int_attribute("tiff:PhotometricInterpretation", unknown) == white_is_zero;
}

void refuse_lost_values(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const std::filesystem::path& path) {
    if (whole_strips_only(input, spec) && (spec.tile_width > 0 || spec.height == 1)) {
        refuse(path, spec.tile_width > 0 ? "values of 64 bits in tiles" : "a single row of values of 64 bits",
               "values of 32 bits, or several rows in strips", "Save the image with 32 bits a value.");
    }
}

} // namespace vkfv::images::openimageio
