#include "optics/waves/airy_pattern.hpp"

#include "core/mathematics/units.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::optics {

double circular_pupil_transfer(double frequency, double cutoff) {
    const double s = std::abs(frequency) / cutoff;
    return s < 1 ? 2 / pi * (std::acos(s) - s * std::sqrt((1 - s) * (1 + s))) : 0;
}

AiryPattern::AiryPattern(double numerical_aperture, const Spectrum& spectrum) {
    double before = 0;
    for (const physics::f64::SpectralBin& bin : spectrum.bins) {
        const double wavelength = 0.5 * (bin.start + bin.stop) / um_per_mm;
        lines_.push_back({2 * numerical_aperture / wavelength, bin.cumulative - before});
        before = bin.cumulative;
    }
}

double AiryPattern::transfer(double frequency) const {
    double sum = 0;
    for (const Line& line : lines_)
        sum += line.share * circular_pupil_transfer(frequency, line.cutoff);
    return sum;
}

double AiryPattern::cutoff() const {
    double most = 0;
    for (const Line& line : lines_)
        most = std::max(most, line.cutoff);
    return most;
}

} // namespace vkfv::optics
