// Glass catalogues in the AGF format of Zemax.
#pragma once

#include "optics/media/medium.hpp"

#include <filesystem>
#include <string_view>
#include <vector>

namespace vkfv::optics {

// The glasses of a catalogue in the order of the file: name, formula (NM), coefficients (CD) and valid range
// (LD); their source is the file's name. The lines CC, GC, ED, TD, OD, IT, MD and BD, and those that begin
// with '!' or '#', are skipped: temperature, transmission, price and remarks change no index. Other text
// before the first NM is skipped too (some files begin with a remark); the encoding is UTF-8, UTF-16 or
// Latin-1. A line that begins with a number continues the one before it. Of glasses with the same name the first is
// taken, with a warning in the log if they differ. Throws InputError that names file, line and keyword.
std::vector<Medium> read_agf(const std::filesystem::path& file);
// The same of the bytes of a file; `name` stands for it in messages.
std::vector<Medium> parse_agf(std::string_view bytes, const std::filesystem::path& name);

} // namespace vkfv::optics
