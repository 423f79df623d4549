// How far vkfv's images of waves are from exact ones: the error of the pupil's cells and of the field's tiles, and
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
    int parts = 0; // of a pixel's side
    int asked_parts = 0;
    double folded_contrast = 0; // at most, of waves that the pupil passes; 0: nothing folds
    std::vector<Point> points;
};

// Of the axis, the middle of a side and the corner of the field, within two depths of field, in the light of each
// source: Instrument::lights(). filters: a light's each.
std::vector<WaveLimits> limits_of_lights(const std::vector<optics::PupilFilter>& filters,
                                         const optics::Instrument& instrument);
std::vector<WaveLimits> limits_of_lights(const optics::WaveOptions& options, const optics::Instrument& instrument);

// The largest error of any light at each point; cells and parts are those of the light with the most parts that its
// aperture asks for.
WaveLimits worst_of(const std::vector<WaveLimits>& limits);

// Where the worst point's contrast is off by more than 0.1, and where light folds back; some sentences each.
std::vector<Warning> warnings_of(const WaveLimits& limits);

nlohmann::ordered_json json_of(const WaveLimits& limits);
// A line a point, for a terminal.
std::string summary(const WaveLimits& limits);

} // namespace vkfv::measurement
