#include "surface_files/surface_file.hpp"

#include "core/files/file.hpp"
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

#include <algorithm>
#include <cctype>

namespace vkfv::surface {
namespace {

// Lower case.
std::string name_of(const std::filesystem::path& path) {
    std::string name = path.filename().string();
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
    return name;
}

// Files that state their own scale.
struct Format {
    bool (*looks_like)(std::string_view bytes);
    SurfaceFile (*parse)(std::string_view bytes, const std::filesystem::path& file);
};
constexpr Format formats[] = {{looks_like_x3p, parse_x3p}, {looks_like_sur, parse_sur},
                              {looks_like_sdf, parse_sdf}, {looks_like_al3d, parse_al3d},
                              {looks_like_gsf, parse_gsf}, {looks_like_gwy, parse_gwy},
                              {looks_like_opd, parse_opd}, {looks_like_metropro, parse_metropro},
                              {looks_like_nms, parse_nms}, {looks_like_plu, parse_plu}};
// Those that need one.
struct UnscaledFormat {
    bool (*looks_like)(std::string_view bytes);
    SurfaceFile (*parse)(std::string_view bytes, const std::filesystem::path& file, const ImageScale& scale);
};
constexpr UnscaledFormat unscaled_formats[] = {{looks_like_height_image, parse_height_image},
                                               {looks_like_npy, parse_npy}};

} // namespace

SurfaceFile read_surface(const std::filesystem::path& path, const ImageScale& scale) {
    const std::string bytes = read_file(path, {.expected = "a surface or image file"});
    for (const auto& [looks_like, parse] : unscaled_formats)
        if (looks_like(bytes))
            return parse(bytes, path, scale);
    for (const auto& [looks_like, parse] : formats)
        if (looks_like(bytes)) {
            refuse_second_scale(path, scale);
            return parse(bytes, path);
        }
    if (!bytes.empty() && named_like_height_table(name_of(path)))
        return parse_height_table(bytes, path, scale);
    refuse_file(path, "", "a file of unknown kind",
                "an X3P, SUR, SDF, AL3D, GSF, GWY, OPD, MetroPro, NMS, PLU, TIFF, OpenEXR or NPY file, or a table of "
                "heights named .csv, .txt, .asc or .xyz",
                "Export the surface in one of these formats.");
}

std::string surface_bytes(const std::filesystem::path& path, const HeightMap& map, const Provenance& provenance) {
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
