#include "images/tiff.hpp"

#include "core/files/file.hpp"
#include "core/messages/error.hpp"

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <type_traits>

namespace vkfv::images {
namespace {

constexpr double mm_per_cm = 10.0;
constexpr int colours = 3;

// The bytes that libtiff reads or writes, and its message.
struct TiffBytes {
    std::string written{};
    std::string_view there{};
    const InputFile* file = nullptr; // used instead of `there`
    std::uint64_t size = 0;
    std::uint64_t place = 0;
    std::string message{}; // the last error or warning
};

TiffBytes& of(thandle_t handle) {
    return *static_cast<TiffBytes*>(handle);
}

tmsize_t read_some(thandle_t handle, void* to, tmsize_t count) {
    TiffBytes& bytes = of(handle);
    const std::uint64_t left = bytes.size - std::min(bytes.place, bytes.size);
    const auto wanted = static_cast<std::size_t>(std::min(left, static_cast<std::uint64_t>(count)));
    char* const into = static_cast<char*>(to);
    if (bytes.file == nullptr) {
        std::copy_n(bytes.there.data() + (bytes.size - left), wanted, into);
        bytes.place += wanted;
        return static_cast<tmsize_t>(wanted);
    }
    const std::size_t got = bytes.file->read_at(bytes.place, {into, wanted});
    bytes.place += got;
    return static_cast<tmsize_t>(got);
}

tmsize_t write_some(thandle_t handle, void* from, tmsize_t count) {
    TiffBytes& bytes = of(handle);
    const std::uint64_t end = bytes.place + static_cast<std::uint64_t>(count);
    if (end > bytes.written.size()) {
        bytes.written.resize(end);
    }
    std::copy_n(static_cast<const char*>(from), count,
                bytes.written.begin() + static_cast<std::ptrdiff_t>(bytes.place));
    bytes.place = end;
    bytes.size = bytes.written.size();
    return count;
}

toff_t seek(thandle_t handle, toff_t offset, int from) {
    TiffBytes& bytes = of(handle);
    return bytes.place = offset + (from == SEEK_CUR ? bytes.place : from == SEEK_END ? bytes.size : 0);
}

int keep_message(TIFF*, void* user, const char*, const char* format, va_list arguments) {
    std::array<char, 500> text{};
    (void)std::vsnprintf(text.data(), text.size(), format, arguments);
    of(user).message = text.data();
    return 1; // leaves libtiff's own handlers, which are global, unchanged
}

struct CloseTiff {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using OpenTiff = std::unique_ptr<TIFF, CloseTiff>;

OpenTiff open_tiff(TiffBytes& bytes, const char* mode) {
    const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                   TIFFOpenOptionsFree);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_message, &bytes);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), keep_message, &bytes);
    return OpenTiff(TIFFClientOpenExt(
        "image", mode, &bytes, read_some, write_some, seek, [](thandle_t) { return 0; },
        [](thandle_t handle) -> toff_t { return of(handle).size; }, nullptr, nullptr, options.get()));
}

// --- Writing ---

// Three channels are colours, a fourth is opacity; fewer are grey.
int photometric(int channels) {
    return channels >= colours ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK;
}

std::vector<std::uint16_t> extra_samples(int channels) {
    std::vector<std::uint16_t> extra(static_cast<std::size_t>(std::max(channels - colours, 0)),
                                     EXTRASAMPLE_UNSPECIFIED);
    if (!extra.empty()) {
        extra[0] = EXTRASAMPLE_ASSOCALPHA;
    }
    return extra;
}

void set_resolution(TIFF* tiff, const ImageTags& tags) {
    float x = static_cast<float>(mm_per_cm / tags.pitch_x);
    const bool coarse = x < 1 || static_cast<float>(mm_per_cm / tags.pitch_y) < 1;
    if (coarse) { // more than a cm per pixel: only the ratio is written
        x = 1;
    }
    TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, coarse ? RESUNIT_NONE : RESUNIT_CENTIMETER);
    TIFFSetField(tiff, TIFFTAG_XRESOLUTION, x);
    TIFFSetField(tiff, TIFFTAG_YRESOLUTION, x * static_cast<float>(tags.pitch_x / tags.pitch_y));
}

template <class Value>
std::vector<Value> interleaved_from_top(std::span<const Grid<Value>> channels) {
    const Grid<Value>& first = channels.front();
    std::vector<Value> values(channels.size() * first.values.size());
    for (std::size_t channel = 0; channel < channels.size(); ++channel) {
        std::size_t place = channel;
        for (int row = first.rows - 1; row >= 0; --row) {
            for (int column = 0; column < first.columns; ++column, place += channels.size()) {
                values[place] = channels[channel](column, row);
            }
        }
    }
    return values;
}

template <class Value>
std::string single_page(std::span<const Grid<Value>> channels, const ImageTags& tags) {
    const Grid<Value>& image = channels.front();
    const int count = static_cast<int>(channels.size());
    std::vector<Value> values = interleaved_from_top(channels);
    const std::size_t value_bytes = values.size() * sizeof(Value);
    TiffBytes bytes;
    const auto failed = [&] { return RunError(fmt::format("libtiff cannot encode a TIFF image: {}", bytes.message)); };
    if (values.empty()) {
        bytes.message = fmt::format("it has {} x {} pixels", image.columns, image.rows);
        throw failed();
    }
    constexpr std::size_t directory_bytes = 4096; // with room to spare
    bytes.written.reserve(value_bytes + tags.description.size() + directory_bytes);
    // 4-byte offsets reach up to 4 GiB.
    constexpr std::size_t most_for_short_offsets = std::size_t{4000} << 20;
    OpenTiff tiff = open_tiff(bytes, value_bytes > most_for_short_offsets ? "w8" : "w");
    if (!tiff) {
        throw failed();
    }
    const auto set = [&](std::uint32_t tag, auto... value) { TIFFSetField(tiff.get(), tag, value...); };
    set(TIFFTAG_IMAGEWIDTH, image.columns);
    set(TIFFTAG_IMAGELENGTH, image.rows);
    set(TIFFTAG_ROWSPERSTRIP, image.rows); // one strip: Gwyddion 2.62 crashes on float images of several
    set(TIFFTAG_SAMPLESPERPIXEL, count);
    set(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    set(TIFFTAG_BITSPERSAMPLE, static_cast<int>(8 * sizeof(Value)));
    set(TIFFTAG_SAMPLEFORMAT, std::is_same_v<Value, float> ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
    set(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    set(TIFFTAG_PHOTOMETRIC, photometric(count));
    if (const auto extra = extra_samples(count); !extra.empty()) {
        set(TIFFTAG_EXTRASAMPLES, static_cast<int>(extra.size()), extra.data());
    }
    set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    // Constant tags without meaning, kept for byte-identical files.
    set(TIFFTAG_SOFTWARE, "vkfv");
    set(TIFFTAG_DATETIME, "1970:01:01 00:00:00");
    if (!tags.description.empty()) {
        set(TIFFTAG_IMAGEDESCRIPTION, tags.description.c_str());
    }
    if (tags.pitch_x > 0 && tags.pitch_y > 0) {
        set_resolution(tiff.get(), tags);
    }
    // The directory comes before the values: the checkpoint reserves its place, and it is rewritten there once they are
    // known.
    const bool good = TIFFCheckpointDirectory(tiff.get()) == 1 &&
                      TIFFWriteEncodedStrip(tiff.get(), 0, values.data(), static_cast<tmsize_t>(value_bytes)) ==
                          static_cast<tmsize_t>(value_bytes) &&
                      TIFFWriteDirectory(tiff.get()) == 1;
    tiff.reset();
    if (!good || !bytes.message.empty()) {
        throw failed();
    }
    return std::move(bytes.written);
}

// --- Reading ---

// Larger images are left to OpenImageIO to accept or refuse.
constexpr std::uint32_t longest_side = 1 << 16;
constexpr std::uint64_t most_pixels = 1 << 28;
constexpr int most_channels = 64;
constexpr std::size_t longest_description = 1 << 16;

template <class Value>
Value field(TIFF* tiff, std::uint32_t tag) {
    Value value{};
    TIFFGetFieldDefaulted(tiff, tag, &value);
    return value;
}

// True if the page has only tags that vkfv writes. libtiff has no list of all tags of a page, so those known here are
// counted and compared with the directory's count.
bool known_tags_only(TIFF* tiff, TiffBytes& bytes) {
    std::uint16_t entries = 0;
    bytes.place = TIFFCurrentDirOffset(tiff);
    if (read_some(&bytes, &entries, sizeof entries) != sizeof entries) {
        return false;
    }
    constexpr std::array known = {
        TIFFTAG_IMAGEWIDTH,   TIFFTAG_IMAGELENGTH,  TIFFTAG_BITSPERSAMPLE,   TIFFTAG_COMPRESSION,
        TIFFTAG_PHOTOMETRIC,  TIFFTAG_STRIPOFFSETS, TIFFTAG_ORIENTATION,     TIFFTAG_SAMPLESPERPIXEL,
        TIFFTAG_ROWSPERSTRIP, TIFFTAG_XRESOLUTION,  TIFFTAG_STRIPBYTECOUNTS, TIFFTAG_IMAGEDESCRIPTION,
        TIFFTAG_PLANARCONFIG, TIFFTAG_YRESOLUTION,  TIFFTAG_RESOLUTIONUNIT,  TIFFTAG_SOFTWARE,
        TIFFTAG_SAMPLEFORMAT, TIFFTAG_DATETIME,     TIFFTAG_EXTRASAMPLES};
    const auto there = [&](int tag) {
        std::array<void*, 2> value{}; // receives a number, a pointer, or both
        return TIFFGetField(tiff, static_cast<std::uint32_t>(tag), &value[0], &value[1]) == 1;
    };
    return std::count_if(known.begin(), known.end(), there) == entries;
}

bool has_extra_samples(TIFF* tiff, int channels) {
    std::uint16_t count = 0;
    const std::uint16_t* found = nullptr;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_EXTRASAMPLES, &count, &found);
    return std::ranges::equal(std::span(found, count), extra_samples(channels));
}

// The description as OpenImageIO would return it; none if it contains digests or colours, which OpenImageIO removes as
// its own marks.
std::optional<std::string> plain_description(TIFF* tiff) {
    const char* text = nullptr;
    if (TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &text) != 1 || text == nullptr) {
        return std::string();
    }
    std::string description = text;
    if (description.size() > longest_description || description.find("oiio:") != std::string::npos ||
        description.find("SHA-1=") != std::string::npos) {
        return std::nullopt;
    }
    return description;
}

template <class Value>
bool read_strip(TIFF* tiff, std::vector<Value>& values, std::uint64_t count) {
    values.resize(count);
    const auto size = static_cast<tmsize_t>(count * sizeof(Value));
    return TIFFReadEncodedStrip(tiff, 0, values.data(), size) == size;
}

std::optional<PlainTiff> read_plain(TiffBytes& bytes, TiffPart part) {
    // The directory below can be interpreted only if it is little-endian with offsets of 4 bytes.
    std::array<char, 4> magic{};
    if (read_some(&bytes, magic.data(), magic.size()) != magic.size() || std::memcmp(magic.data(), "II*", 4) != 0) {
        return std::nullopt;
    }
    bytes.place = 0;
    const OpenTiff open = open_tiff(bytes, "rmc"); // m: not memory-mapped; c: strips unchanged
    TIFF* const tiff = open.get();
    if (tiff == nullptr || !bytes.message.empty() || TIFFLastDirectory(tiff) == 0 || TIFFIsTiled(tiff) != 0) {
        return std::nullopt;
    }
    const auto columns = field<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH);
    const auto rows = field<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH);
    const auto number = [&](std::uint32_t tag) { return int{field<std::uint16_t>(tiff, tag)}; };
    const int channels = number(TIFFTAG_SAMPLESPERPIXEL);
    const int format = number(TIFFTAG_SAMPLEFORMAT), bits = number(TIFFTAG_BITSPERSAMPLE);
    const bool floats = format == SAMPLEFORMAT_IEEEFP && bits == 32;
    const bool integers = format == SAMPLEFORMAT_UINT && (bits == 16 || bits == 8);
    if (columns < 1 || columns > longest_side || rows < 1 || rows > longest_side ||
        std::uint64_t{columns} * rows > most_pixels || channels < 1 || channels > most_channels ||
        (!floats && !integers) || number(TIFFTAG_COMPRESSION) != COMPRESSION_NONE ||
        number(TIFFTAG_PLANARCONFIG) != PLANARCONFIG_CONTIG || number(TIFFTAG_ORIENTATION) != ORIENTATION_TOPLEFT ||
        number(TIFFTAG_PHOTOMETRIC) != photometric(channels) || !has_extra_samples(tiff, channels) ||
        field<std::uint32_t>(tiff, TIFFTAG_ROWSPERSTRIP) != rows || TIFFNumberOfStrips(tiff) != 1) {
        return std::nullopt;
    }
    const std::uint64_t count = std::uint64_t{columns} * rows * static_cast<std::uint64_t>(channels);
    const std::uint64_t strip = TIFFGetStrileOffset(tiff, 0), length = count * static_cast<unsigned>(bits / 8);
    if (TIFFGetStrileByteCount(tiff, 0) != length || strip > bytes.size || length > bytes.size - strip ||
        !known_tags_only(tiff, bytes)) {
        return std::nullopt;
    }
    auto description = plain_description(tiff);
    if (!description) {
        return std::nullopt;
    }
    PlainTiff image{.columns = static_cast<int>(columns),
                    .rows = static_cast<int>(rows),
                    .channels = channels,
                    .integers = integers,
                    .description = std::move(*description)};
    if (part == TiffPart::all) {
        std::vector<std::uint8_t> small;
        if (!(floats       ? read_strip(tiff, image.floats, count)
              : bits == 16 ? read_strip(tiff, image.counts, count)
                           : read_strip(tiff, small, count))) {
            return std::nullopt;
        }
        image.counts.insert(image.counts.end(), small.begin(), small.end());
    }
    return bytes.message.empty() ? std::optional(std::move(image)) : std::nullopt;
}

} // namespace

std::string tiff_of_floats(std::span<const Grid<float>> channels, const ImageTags& tags) {
    return single_page(channels, tags);
}

std::string tiff_of_integers(const Grid<std::uint16_t>& image, const ImageTags& tags) {
    return single_page(std::span(&image, 1), tags);
}

std::string tiff_of_integers(const Grid<std::uint8_t>& image, const ImageTags& tags) {
    return single_page(std::span(&image, 1), tags);
}

std::optional<PlainTiff> plain_tiff(std::string_view bytes, TiffPart part) {
    TiffBytes source{.there = bytes, .size = bytes.size()};
    return read_plain(source, part);
}

std::string tiff_text(std::string_view bytes, std::uint32_t tag) {
    if (!bytes.starts_with("II") && !bytes.starts_with("MM")) {
        return {};
    }
    TiffBytes source{.there = bytes, .size = bytes.size()};
    const OpenTiff tiff = open_tiff(source, "rmc");
    // For a tag that it does not know, libtiff also returns the count.
    std::uint32_t count = 0;
    const char* text = nullptr;
    const TIFFField* field = tiff ? TIFFFindField(tiff.get(), tag, TIFF_ASCII) : nullptr;
    if (field == nullptr || TIFFFieldPassCount(field) == 0 || TIFFFieldReadCount(field) != TIFF_VARIABLE2 ||
        TIFFGetField(tiff.get(), tag, &count, &text) != 1 || text == nullptr) {
        return {};
    }
    const std::string_view whole(text, count);
    return std::string(whole.substr(0, whole.find('\0')));
}

std::optional<PlainTiff> plain_tiff_file(const std::filesystem::path& path, TiffPart part) {
    const InputFile file(path, FileRequest{.expected = "an image file"});
    TiffBytes source{.file = &file, .size = file.bytes()};
    return read_plain(source, part);
}

} // namespace vkfv::images
