#include "measurement/calibration/characteristic.hpp"

#include <boost/math/distributions/students_t.hpp>

#include <cmath>

namespace vkfv::measurement {

double CertificateFigure::coverage_factor() const {
    constexpr double both_sides_95 = 0.975, as_good_as_normal = 1e6;
    if (!(degrees_of_freedom > 0)) {
        return surface::undefined;
    }
    const boost::math::students_t student(std::min(degrees_of_freedom, as_good_as_normal));
    return boost::math::quantile(student, both_sides_95);
}

double CertificateFigure::expanded_uncertainty() const {
    return std::isfinite(standard_uncertainty) ? coverage_factor() * standard_uncertainty : surface::undefined;
}

const std::vector<Characteristic>& characteristics() {
    static const std::vector<Characteristic> all = {measurement_noise(), flatness_deviation(), vertical_amplification(),
                                                    lateral_mapping(),   lateral_resolution(), slope_limit(),
                                                    least_roughness(),   repeatability()};
    return all;
}

} // namespace vkfv::measurement
