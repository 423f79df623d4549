// A configuration to begin with, made from data sheets: short, with comments, and small enough for a first image in
// seconds. Positions, texture, window and rays follow from the optics.
#pragma once

#include "measurement/beginning/data_sheet.hpp"

#include <string>

namespace vkfv::measurement {

struct DataSheets {
    SheetObjective objective;
    SheetCamera camera;
    SheetLight light;
    SheetLed led;
    SheetSpecimen specimen;
};

// Returns TOML that read_configuration() takes. `name` is the name of the file that it will be; the commands in its
// comments use it. Throws InputError for parts that do not fit together, and for a measured surface that cannot be
// read.
std::string first_configuration(const DataSheets& sheets, const std::string& name);

} // namespace vkfv::measurement
