// Read-only formats of instruments' own programs. Each is found by its first bytes; the first row has the highest y.
// All throw InputError.
#pragma once

#include "surface_files/surface_file.hpp"

#include <string_view>

namespace vkfv::surface {

// PLU, Sensofar's confocal microscopes and interferometers (facts: Gwyddion's user guide and sensofar module,
// surfalize).
bool looks_like_plu(std::string_view bytes);
// Float32 um; topographies alone.
SurfaceFile parse_plu(std::string_view bytes, const std::filesystem::path& file);

// OPD, Wyko's and Veeco's (now Bruker's) interferometers (facts: Gwyddion's opdfile module, surfalize).
bool looks_like_opd(std::string_view bytes);
// The array RAW_DATA, Raw (Vision64) or SAMPLE_DATA: int16 or float32 waves; the file's array is by columns, from the
// lowest y.
SurfaceFile parse_opd(std::string_view bytes, const std::filesystem::path& file);

// MetroPro's DAT, Zygo's interferometers; big-endian (facts: Zygo's MetroPro Reference Guide, Gwyddion's metropro
// module).
bool looks_like_metropro(std::string_view bytes);
// The phase data as heights.
SurfaceFile parse_metropro(std::string_view bytes, const std::filesystem::path& file);

// NMS, NanoFocus' confocal microscopes (facts: surfalize; a real file).
bool looks_like_nms(std::string_view bytes);
// Uint16 codes from the lowest to the highest height; no code for not-measured points is known.
SurfaceFile parse_nms(std::string_view bytes, const std::filesystem::path& file);

} // namespace vkfv::surface
