#include "optics/instrument/assembly.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::optics {

namespace {

Range spectral_range(const Spectrum& light, const Spectrum& whole) {
    if (whole.monochromatic()) {
        return {};
    }
    const auto x = [&](double wavelength_um) {
        return (1 / (wavelength_um * wavelength_um) - whole.centre()) / whole.half_width();
    };
    return {x(light.longest_um), x(light.shortest_um)};
}

// The light reversed: half a turn about x and the opposite direction turn places (x, y) into (x, -y), slopes (s, t)
// into (-s, t).
DiscLight light_of_detector(const InstrumentDescription& description, const AxialLayout& layout,
                            const ImagingTrain& placed, const MeasuredImaging& measured) {
    const Imaging& imaging = placed.imaging;
    const auto chief_from = [&](glm::dvec2 place) {
        return imaging.trace(place, 0, imaging.chief_cosines(place), 0).value_or(Imaging::Landing{});
    };
    const auto slope = [](const Imaging::Landing& landing) {
        return landing.direction.z > 0 ? glm::dvec2(landing.direction) / landing.direction.z : glm::dvec2(0);
    };
    const Imaging::Landing axial = chief_from({0, 0});
    const Imaging::Landing aside = chief_from({layout.field_corner.x, 0});
    const double way = aside.position.x - axial.position.x;
    const Spectrum& spectrum = description.spectrum;
    const double half_width = 0.5 * description.detector_width;
    const ImageSize& pixels = description.detector_pixels;
    DiscLight light;
    light.train = placed.from_detector;
    light.radius = layout.reach * std::hypot(half_width, half_width * pixels.rows / pixels.columns);
    light.spectral = spectral_range(description.source.spectrum.value_or(spectrum), spectrum);
    light.middle = {-slope(axial).x, slope(axial).y};
    light.towards = way != 0 ? -(slope(aside).x - slope(axial).x) / way : 0;
    light.reach = measured.numerical_aperture / std::abs(layout.magnification);
    light.symmetric = imaging.symmetric;
    return light;
}

} // namespace

DetectorHulls::DetectorHulls(const InstrumentDescription& description, const AxialLayout& layout,
                             const ImagingTrain& imaging, const MeasuredImaging& measured)
    : light_(light_of_detector(description, layout, imaging, measured)), heights_{measured.best_focus_offset -
                                                                                      description.greatest_defocus,
                                                                                  measured.best_focus_offset +
                                                                                      description.greatest_defocus},
      working_distance_(layout.working_distance), gate_position_(imaging.imaging.pupil_curvature) {}

// A ray's crossing is convex in the plane's height, so its maximum is at one of the ends.
double DetectorHulls::gate_radius() const {
    return greatest_of(light_, ConePart::rim, [&](const PassingRay& ray) {
        const auto crossing = [&](double height) {
            const glm::dvec2 place = ray.end + (working_distance_ - height) * ray.end_slope;
            return glm::length(gate_position_ * place - ray.end_slope);
        };
        return std::max(crossing(heights_.low), crossing(heights_.high));
    });
}

double DetectorHulls::field_radius() const {
    return greatest_of(light_, ConePart::whole, [&](const PassingRay& ray) {
        const auto from_axis = [&](double height) {
            return glm::length(ray.end + (working_distance_ - height) * ray.end_slope);
        };
        return std::max(from_axis(heights_.low), from_axis(heights_.high));
    });
}

double DetectorHulls::pupil_radius(double per_position) const {
    return greatest_of(light_, ConePart::rim,
                       [&](const PassingRay& ray) { return glm::length(per_position * ray.start + ray.start_slope); });
}

double DetectorHulls::least_pupil_rim(double per_position, double radius) const {
    return radius - greatest_of(light_, ConePart::rim, [&](const PassingRay& ray) {
               return std::max(0.0, radius - glm::length(per_position * ray.start + ray.start_slope));
           });
}

} // namespace vkfv::optics
