// All parameters of ISO 25178-2 that vkfv knows, of one height map.
#pragma once

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
};

// No levelling, no filter: the caller's business.
ArealParameters areal_parameters(const HeightMap& map);

// mm, mm^3/mm^2, radians; shares are usually given in per cent, numbers as they are.
enum class ParameterUnit { length, volume_per_area, angle, share, number };

struct NamedParameter {
    std::string_view name; // "Sa"
    double value = 0;
    ParameterUnit unit = ParameterUnit::length;
};

// Those that the standard names, in its order.
std::vector<NamedParameter> named_parameters(const ArealParameters& parameters);

} // namespace vkfv::surface
