// How far vkfv's images of waves are from exact ones: the error of using the axis' filter across the whole field, and
// aliasing where light is sorted more coarsely than the waves require.
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

// The wavefronts at the edge and in the corner of the field: traced by other threads while the filter is made.
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
