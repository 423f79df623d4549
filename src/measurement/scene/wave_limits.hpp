// The deviation of vkfv's images of waves from exact ones: the error by the pupil's cells and by the field's tiles, and
// aliasing where light is sorted more coarsely than the waves require.
#pragma once

#include "core/messages/warning.hpp"
#include "optics/waves/filter_error.hpp"
#include "optics/waves/pupil_filter.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace vkfv::measurement {

struct WaveLimits {
    struct Point {
        const char* name; // "axis", "edge", "corner"
        optics::FilterError error;
    };
    int cells = 0; // across the pupil
    int tiles = 1; // across the field
    int parts = 0; // of a pixel's side into which light is sorted; asked_parts: by the aperture
    int asked_parts = 0;
    double folded_contrast = 0; // the most contrast of waves that fold back; 0: none do
    std::vector<Point> points;
};

// The limits in the light of each source (Instrument::lights()) at the axis, the middle of a side and the corner of the
// field, within two depths of field. filters: one for each source's light.
std::vector<WaveLimits> limits_of_lights(const std::vector<optics::PupilFilter>& filters,
                                         const optics::Instrument& instrument);
std::vector<WaveLimits> limits_of_lights(const optics::WaveOptions& options, const optics::Instrument& instrument);

// The largest error of any light at each point. Cells and parts are those of the light whose aperture asks for the most
// parts.
WaveLimits worst_of(const std::vector<WaveLimits>& limits);

// Warnings where the worst point's contrast is off by more than 0.1, and where waves fold back.
std::vector<Warning> warnings_of(const WaveLimits& limits);

nlohmann::ordered_json json_of(const WaveLimits& limits);
// A line for each point, for a terminal.
std::string summary(const WaveLimits& limits);

} // namespace vkfv::measurement
