// The dimensions of a standard: nominal, true and measured values.
#pragma once

#include "dimensions/evaluate.hpp"
#include "topography/focus_measure.hpp"
#include "topography/uncertainty/brightness_pull.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace vkfv::measurement {

// One dimension of the measured and of the true heights, found by the same rule.
struct StandardDimension {
    dimensions::Dimension measured;
    double truth = surface::undefined; // in the unit of `measured`; NaN without a truth
    // Standard uncertainties of the measured value that the scatter of the heights does not show, in its unit; NaN
    // where they are not known. By brightness that changes with focus: how far the value moves if every height comes
    // nearer to the mean height by its own such uncertainty. By the focus window, which averages heights: how far the
    // value moves if the map is averaged once more.
    double brightness_uncertainty = surface::undefined;
    double window_uncertainty = surface::undefined;

    // The values in the units of results: um, degrees, or none.
    struct Row {
        std::string name, rule, unit;
        double nominal, truth, measured;
        double deviation; // measured less nominal
        double error;     // measured less true
        double standard_deviation, standard_error, brightness_uncertainty, window_uncertainty;
        int profiles;
    };
    Row in_unit() const;
};

// The properties of a focus evaluation that move all heights of a feature alike.
struct FocusEffects {
    const topography::BrightnessPull* pull; // mm
    topography::FocusWindow window;
};

// The dimensions of the feature. truth: on the grid of the measured heights. effects: of the evaluation that measured
// them; without these, uncertainties by them are not known.
std::vector<StandardDimension> standard_dimensions(const dimensions::Feature& feature,
                                                   const surface::HeightMap& measured,
                                                   const std::optional<surface::HeightMap>& truth,
                                                   const std::optional<FocusEffects>& effects = {});

// A list of objects. NaN (not measured, not known) becomes null.
nlohmann::ordered_json json_of(const std::vector<StandardDimension>& dimensions);

// Adds the dimensions as the member "dimensions", if there are any.
void add_dimensions(nlohmann::ordered_json& results, const std::vector<StandardDimension>& dimensions);

// A line for each dimension.
std::string dimensions_text(const std::vector<StandardDimension>& dimensions);

} // namespace vkfv::measurement
