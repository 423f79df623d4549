// Surfaces in the files of other programs and instruments.
//
// Row order: in memory row 0 has the lowest y. In every format here the first row in the file has the highest y, as
// Gwyddion and MountainsMap show it: seen from +z, x points to the right and y up. Positions in files are those of the
// point with the lowest x and y.
#pragma once

#include "surface/height_map.hpp"
#include "surface_files/provenance.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::surface {

struct SurfaceFile {
    HeightMap map; // NaN: not measured
    Provenance provenance{};
    std::vector<std::string> warnings{}; // sentences without the final full stop, for results and the log
};

// The scale that a plain image lacks.
struct ImageScale {
    std::optional<double> pitch; // mm between pixels
    std::optional<double> unit;  // mm per unit of a pixel's value
};
// The keys of errors about the scale; no other error of a file has them.
inline constexpr const char *scale_pitch_key = "pitch", *scale_unit_key = "unit";

// The treatment of a file's checksums: errors or warnings if they differ from those of its contents. Programs that edit
// an X3P file by hand often leave the old ones.
enum class Checksums { must_hold, may_be_stale };

// Reads X3P, SUR, SDF, AL3D, GSF, GWY, OPD, MetroPro's DAT, NMS, PLU, a TIFF or OpenEXR image or NPY array of heights,
// recognized by its first bytes, or else a table of numbers, recognized by its name's ending. `scale` is for images
// that vkfv did not write, arrays and tables, which need both of its parts; if the file has a scale of its own, a
// second one is an error. Implausible heights cause a warning: farther from the median than 10^4 times the range
// from the 10 to the 90 % quantile of the heights, or than 1 m. All warnings are in the log too. Throws InputError for
// anything that is not a complete and valid file; the memory used is bounded by the file's size and, for packed files,
// by the number of points in its header.
SurfaceFile read_surface(const std::filesystem::path& path, const ImageScale& scale = {},
                         Checksums checksums = Checksums::must_hold);

// The bytes of a surface file, for core/files/file.hpp to write. The name's ending selects the format: .x3p .sur .sdf
// (.asc.sdf: as text) .gwy .gsf .csv .txt .npy .tif .tiff .ply; another is an InputError. Without a date the file has
// that of source_date(). Equal maps and provenances give equal bytes, also after they were read back. RunError if the
// format cannot hold the map.
//   .x3p  float64 metres
//   .sur  32-bit integers, steps of at most 2^-29 of the largest height; pitches and position as float32
//   .sdf  float64 metres; without position, and of the provenance only manufacturer and date; .asc.sdf keeps all
//   .tif  float32 micrometres; pitches and position exact
//   .gwy  float64 metres, with a mask; for Gwyddion
//   .gsf  float32 metres
//   .csv  (.txt) text, um; all exact
//   .npy  float64 um; without pitch, position and provenance
//   .ply  float32 mm, two triangles a cell, for viewers of meshes; not read back
std::string surface_bytes(const std::filesystem::path& path, const HeightMap& map, const Provenance& provenance = {});

} // namespace vkfv::surface
