// Glass catalogues in the AGF format of Zemax.
#pragma once

#include "core/messages/error.hpp"
#include "optics/media/medium.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::optics {

struct AgfGlasses {
    std::vector<Medium> media; // in the order of the file
    // Glasses with a faulty record, by name, and the first problem of each. A record without a name has the name "".
    std::map<std::string, InputProblem> unusable;
};

// Reads name, formula (NM), coefficients (CD) and valid range (LD) of each glass; `source` of the media is the file's
// name. The lines CC, GC, ED, TD, OD, IT, MD and BD, and lines that begin with '!' or '#', are skipped: temperature,
// transmission, price and remarks change no index. Other text before the first NM is skipped too (some files begin with
// a remark); the encoding is any of as_utf8(). A line that begins with a number continues the one before it. Of glasses
// with the same name the first is taken, with a warning in the log if they differ. A record that cannot be used is left
// out, with a warning that names file, line and keyword. Throws InputError if no glass can be used.
AgfGlasses read_agf(const std::filesystem::path& file);
// Reads the bytes of an AGF file as read_agf() does; `name` stands for the file in messages.
AgfGlasses parse_agf(std::string_view bytes, const std::filesystem::path& name);

} // namespace vkfv::optics
