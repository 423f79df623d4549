// All supported parameters of ISO 25178-2, of one height map.
#pragma once

#include "surface/feature_parameters.hpp"
#include "surface/height_parameters.hpp"
#include "surface/hybrid_parameters.hpp"
#include "surface/material_ratio.hpp"
#include "surface/spatial_parameters.hpp"
#include "surface/volume_parameters.hpp"

#include <string_view>
#include <vector>

namespace vkfv::surface {

struct ArealParameters {
    HeightParameters height;
    HybridParameters hybrid;
    SpatialParameters spatial;
    CoreParameters core;
    VolumeParameters volume;
    RatioParameters ratio;
    FeatureParameters feature;
};

// Computes the parameters of the map as it is: levelling and filters are the caller's task.
ArealParameters areal_parameters(const HeightMap& map);

struct NamedParameter {
    std::string_view name; // symbol: "Sa"
    double value = 0;      // mm, mm^3/mm^2, radians, shares of 1, 1/mm, 1/mm^2
};

// The parameters with their symbols in the standard's order; Sdq is followed by the share that sampling takes from it.
std::vector<NamedParameter> named_parameters(const ArealParameters& parameters);

} // namespace vkfv::surface
