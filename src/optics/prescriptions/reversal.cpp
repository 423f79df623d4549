#include "optics/prescriptions/reversal.hpp"

#include <utility>

namespace vkfv::optics {

namespace {

// The inverse of a break, in a frame rotated by 180 degrees about y, which changes the signs of x and z. The inverse
// has the break's parts in the opposite order, so the thickness comes first, as a break of its own.
std::vector<CoordinateBreak> turned_round(const CoordinateBreak& change) {
    std::vector<CoordinateBreak> result;
    if (change.thickness != 0) {
        result.push_back({.thickness = change.thickness});
    }
    result.push_back({.decentre_x = change.decentre_x,
                      .decentre_y = -change.decentre_y,
                      .tilt_x = change.tilt_x,
                      .tilt_y = -change.tilt_y,
                      .tilt_z = change.tilt_z,
                      .tilt_first = !change.tilt_first,
                      .thickness = 0});
    return result;
}

} // namespace

Prescription turned_round(const Prescription& prescription) {
    Prescription result = prescription;
    result.source_distance.reset();
    result.surfaces.clear();
    const auto& surfaces = prescription.surfaces;
    for (std::size_t i = surfaces.size(); i-- > 0;) {
        PrescribedSurface surface = surfaces[i];
        surface.curvature = -surface.curvature + 0.0; // + 0.0 avoids a negative zero
        for (double& coefficient : surface.aspheric) {
            coefficient = -coefficient + 0.0;
        }
        surface.medium_after = i > 0 ? surfaces[i - 1].medium_after : prescription.medium_before;
        surface.thickness = i > 0 ? surfaces[i - 1].thickness : 0;
        surface.breaks.clear();
        if (i + 1 < surfaces.size() && !surfaces[i + 1].breaks.empty()) {
            // The path to this vertex was thickness, then breaks; in the reversed lens the thickness comes last.
            PrescribedSurface& before = result.surfaces.back();
            const auto& breaks = surfaces[i + 1].breaks;
            for (auto change = breaks.rbegin(); change != breaks.rend(); ++change) {
                for (const CoordinateBreak& part : turned_round(*change)) {
                    surface.breaks.push_back(part);
                }
            }
            if (const double distance = std::exchange(before.thickness, 0.0); distance != 0) {
                surface.breaks.push_back({.thickness = distance});
            }
        }
        result.surfaces.push_back(std::move(surface));
    }
    if (!surfaces.empty()) {
        result.medium_before = surfaces.back().medium_after;
    }
    return result;
}

} // namespace vkfv::optics
