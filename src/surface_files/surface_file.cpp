#include "surface_files/surface_file.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "images/image_file.hpp"
#include "surface_files/al3d.hpp"
#include "surface_files/height_image.hpp"
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

} // namespace

SurfaceFile read_surface(const std::filesystem::path& path, const ImageScale& scale) {
    const std::string bytes = read_file(path, {.expected = "a surface or image file"});
    if (looks_like_height_image(bytes))
        return parse_height_image(bytes, path, scale);
    if (scale.pitch || scale.unit)
        refuse_file(path, scale.pitch ? "pitch" : "unit", "given", "no second scale: the file states its own",
                    "Leave it out.");
    if (looks_like_x3p(bytes))
        return parse_x3p(bytes, path);
    if (looks_like_sur(bytes))
        return parse_sur(bytes, path);
    if (looks_like_sdf(bytes))
        return parse_sdf(bytes, path);
    if (looks_like_al3d(bytes))
        return parse_al3d(bytes, path);
    refuse_file(path, "", "a file of unknown kind", "an X3P, SUR, SDF, AL3D, TIFF or OpenEXR file",
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
    refuse_file(path, "", "a name that ends otherwise", "one that ends in .x3p, .sur, .sdf, .tif or .ply",
                "Choose one of these formats by the name's ending.");
}

} // namespace vkfv::surface
