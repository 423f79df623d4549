#include "surface_files/surface_file.hpp"

#include "core/files/file.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "images/image_file.hpp"
#include "surface_files/al3d.hpp"
#include "surface_files/gsf.hpp"
#include "surface_files/gwy.hpp"
#include "surface_files/height_image.hpp"
#include "surface_files/height_table.hpp"
#include "surface_files/image_scale.hpp"
#include "surface_files/instruments.hpp"
#include "surface_files/npy.hpp"
#include "surface_files/ply.hpp"
#include "surface_files/sdf.hpp"
#include "surface_files/sur.hpp"
#include "surface_files/x3p.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace vkfv::surface {
namespace {

// The file's name in lower case.
std::string name_of(const std::filesystem::path& path) {
    std::string name = path.filename().string();
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
    return name;
}

// The formats that state their own scale.
struct Format {
    bool (*looks_like)(std::string_view bytes);
    SurfaceFile (*parse)(std::string_view bytes, const std::filesystem::path& file);
};
constexpr Format formats[] = {
    {looks_like_sur, parse_sur},           {looks_like_sdf, parse_sdf}, {looks_like_al3d, parse_al3d},
    {looks_like_gsf, parse_gsf},           {looks_like_gwy, parse_gwy}, {looks_like_opd, parse_opd},
    {looks_like_metropro, parse_metropro}, {looks_like_nms, parse_nms}, {looks_like_plu, parse_plu}};
// The formats that may need a scale.
struct UnscaledFormat {
    bool (*looks_like)(std::string_view bytes);
    SurfaceFile (*parse)(std::string_view bytes, const std::filesystem::path& file, const ImageScale& scale);
};
constexpr UnscaledFormat unscaled_formats[] = {{looks_like_height_image, parse_height_image},
                                               {looks_like_npy, parse_npy},
                                               {looks_like_zygo_text, parse_zygo_text}};

// The name of a picture format by its first bytes; null if unknown.
const char* kind_of_picture(std::string_view bytes) {
    return bytes.starts_with("\x89PNG") ? "PNG" : bytes.starts_with("\xff\xd8\xff") ? "JPEG" : nullptr;
}

SurfaceFile parse_surface(std::string_view bytes, const std::filesystem::path& path, const ImageScale& scale,
                          Checksums checksums) {
    for (const auto& [looks_like, parse] : unscaled_formats)
        if (looks_like(bytes))
            return parse(bytes, path, scale);
    if (looks_like_x3p(bytes)) {
        refuse_second_scale(path, scale);
        return parse_x3p(bytes, path, checksums);
    }
    for (const auto& [looks_like, parse] : formats)
        if (looks_like(bytes)) {
            refuse_second_scale(path, scale);
            return parse(bytes, path);
        }
    if (const char* kind = kind_of_picture(bytes))
        refuse_file(path, "", fmt::format("a picture ({}), whose values have no scale", kind), "a file of heights",
                    "Save the heights as TIFF, and give --pitch_um and --unit_um; a specimen of kind \"image\" takes "
                    "pictures as they are.");
    if (bytes.starts_with("\x89HDF\r\n"))
        refuse_file(path, "", "an HDF5 file, such as Zygo's .datx or a .mat or .h5 of others", "a surface file",
                    "Save it in Mx as .dat, .xyz or .sdf; from other programs as X3P, SDF or NPY.");
    if (!bytes.empty() && named_like_height_table(name_of(path)))
        return parse_height_table(bytes, path, scale);
    refuse_file(path, "", "a file of unknown kind",
                "an X3P, SUR, SDF, AL3D, GSF, GWY, OPD, MetroPro, Zygo text, NMS, PLU, TIFF, OpenEXR or NPY file, or a "
                "table of "
                "heights named .csv, .txt, .asc or .xyz",
                "Export the surface in one of these formats.");
}

// The value below which this share of the values lies. Changes the order of the values.
double quantile(std::vector<double>& values, double share) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, place);
    return *place;
}

void warn_of_implausible_heights(const std::filesystem::path& path, SurfaceFile& file) {
    constexpr std::size_t most_looked_at = std::size_t{1} << 22;
    constexpr double most_ranges = 1e4, most_length = 1000; // in ranges of heights; mm
    const auto& all = file.map.height.values;
    const std::size_t every = all.size() / most_looked_at + 1;
    std::vector<double> some;
    for (std::size_t k = 0; k < all.size(); k += every)
        if (std::isfinite(all[k]))
            some.push_back(all[k]);
    if (some.empty())
        return;
    const double median = quantile(some, 0.5), range = quantile(some, 0.9) - quantile(some, 0.1);
    const double most = range > 0 ? std::min(most_ranges * range, most_length) : most_length;
    std::size_t count = 0;
    double farthest = 0;
    for (const double height : all)
        if (const double off = std::abs(height - median); off > most) {
            ++count;
            farthest = std::max(farthest, off);
        }
    if (count > 0)
        file.warnings.push_back(
            fmt::format("{}: {} heights lie up to {:.3g} um from the median, where the heights of the 10 to 90 % in "
                        "the middle span "
                        "{:.3g} um. If they mark points that were not measured, export these as NaN",
                        path.string(), count, farthest * um_per_mm, range * um_per_mm));
}

} // namespace

SurfaceFile read_surface(const std::filesystem::path& path, const ImageScale& scale, Checksums checksums) {
    const std::string bytes = read_file(path, {.expected = "a surface or image file"});
    SurfaceFile result = parse_surface(bytes, path, scale, checksums);
    warn_of_implausible_heights(path, result);
    for (const auto& warning : result.warnings)
        spdlog::warn("{}", warning);
    return result;
}

std::string surface_bytes(const std::filesystem::path& path, const HeightMap& map, const Provenance& of_map) {
    Provenance provenance = of_map;
    if (provenance.date.empty())
        provenance.date = source_date();
    const std::string name = name_of(path);
    if (name.ends_with(".x3p"))
        return x3p_bytes(map, provenance);
    if (name.ends_with(".sur"))
        return sur_bytes(map, provenance);
    if (name.ends_with(".asc.sdf"))
        return sdf_text(map, provenance);
    if (name.ends_with(".sdf"))
        return sdf_bytes(map, provenance);
    if (name.ends_with(".tif") || name.ends_with(".tiff"))
        return height_map_bytes(map, provenance);
    if (name.ends_with(".ply"))
        return ply_bytes(map, provenance);
    if (name.ends_with(".gsf"))
        return gsf_bytes(map, provenance);
    if (name.ends_with(".gwy"))
        return gwy_bytes(map, provenance);
    if (name.ends_with(".npy"))
        return npy_bytes(map);
    if (name.ends_with(".csv") || name.ends_with(".txt"))
        return height_table(map, provenance);
    refuse_file(path, "", "a name that ends otherwise",
                "one that ends in .x3p, .sur, .sdf, .gwy, .gsf, .npy, .csv, .tif or .ply",
                "Choose one of these formats by the name's ending.");
}

} // namespace vkfv::surface
