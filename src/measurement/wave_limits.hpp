// How far images are from those of waves: what the filter of the axis leaves across the field, and what folds back
// where light is sorted more coarsely than waves ask for.
#pragma once

#include "optics/filter_error.hpp"
#include "optics/pupil_filter.hpp"

#include <nlohmann/json.hpp>

#include <future>
#include <string>
#include <vector>

namespace vkfv::measurement {

struct WaveLimits {
    struct Point {
        const char* name; // "axis", "edge", "corner"
        optics::FilterError error;
    };
    int cells = 0; // across the pupil
    int parts = 0; // of a pixel's side
    int asked_parts = 0;
    double folded_contrast = 0; // at most, of waves that the pupil passes; 0: nothing folds
    std::vector<Point> points;
};

// What the field makes of the instrument's wavefront: traced by threads of their own, while its filter is made.
struct FieldWaves {
    explicit FieldWaves(const optics::Instrument& instrument); // which must live as long

    std::future<optics::PointWaves> edge;
    std::future<optics::PointWaves> corner;
};

// Of the axis, the middle of a side and the corner of the field, within two depths of field.
WaveLimits wave_limits(const optics::PupilFilter& filter, const optics::Instrument& instrument, FieldWaves waves);
WaveLimits wave_limits(const optics::PupilFilter& filter, const optics::Instrument& instrument);

// Where the worst point's contrast is off by more than 0.1, and where light folds back; some sentences each.
std::vector<std::string> warnings_of(const WaveLimits& limits);

nlohmann::ordered_json json_of(const WaveLimits& limits);
// A line a point, for a terminal.
std::string summary(const WaveLimits& limits);

} // namespace vkfv::measurement
