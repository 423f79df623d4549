// Read-only formats of instruments' own programs. Each is recognized by its first bytes; the first row has the highest
// y. All readers throw InputError.
#pragma once

#include "surface_files/surface_file.hpp"

#include <string_view>

namespace vkfv::surface {

// PLU, Sensofar's confocal microscopes and interferometers (facts: Gwyddion's user guide and sensofar module,
// surfalize).
bool looks_like_plu(std::string_view bytes);
// Reads float32 um, of topographies only.
SurfaceFile parse_plu(std::string_view bytes, const std::filesystem::path& file);

// OPD, Wyko's and Veeco's (now Bruker's) interferometers (facts: Gwyddion's opdfile module, surfalize).
bool looks_like_opd(std::string_view bytes);
// Reads the array RAW_DATA, Raw (Vision64) or SAMPLE_DATA: int16 or float32 waves; the file's array is stored by
// columns, from the lowest y.
SurfaceFile parse_opd(std::string_view bytes, const std::filesystem::path& file);

// MetroPro's DAT, Zygo's interferometers; big-endian (facts: Zygo's MetroPro Reference Guide, Gwyddion's metropro
// module).
bool looks_like_metropro(std::string_view bytes);
// Reads the phase data of formats 1 to 3 as heights.
SurfaceFile parse_metropro(std::string_view bytes, const std::filesystem::path& file);

// The text files of MetroPro and Mx: "Zygo ASCII Data File" with phases as whole numbers, and "Zygo XYZ Data File" with
// a pixel and its height a line (facts: Zygo's MetroPro Reference Guide; how prysm writes the first).
bool looks_like_zygo_text(std::string_view bytes);
// Reads heights. Those of XYZ files have the unit of `scale`, or else MetroPro's um, with a warning, since Mx writes
// the unit that is set there. The pitch is required if the file's lateral resolution is 0.
SurfaceFile parse_zygo_text(std::string_view bytes, const std::filesystem::path& file, const ImageScale& scale);

// NMS, NanoFocus' confocal microscopes (facts: surfalize; a real file).
bool looks_like_nms(std::string_view bytes);
// Reads uint16 codes from the lowest to the highest height; no code for not-measured points is known.
SurfaceFile parse_nms(std::string_view bytes, const std::filesystem::path& file);

} // namespace vkfv::surface
