#include "topography/peak.hpp"

#include "topography/parallel_rows.hpp"

#include <cmath>
#include <limits>

namespace vkfv::topography {

double gaussian_peak_offset(double before, double at, double after) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (!(before > 0 && after > 0 && at >= before && at >= after))
        return none;
    const double a = std::log(before), b = std::log(at), c = std::log(after);
    const double curvature = (a - b) + (c - b);
    return curvature < 0 ? (a - c) / (2 * curvature) : none;
}

void PeakTracker::add(const Grid<float>& curve_values) {
    if (images_ == 0)
        curves_ = Grid<Curve>(curve_values.columns, curve_values.rows);
    parallel_rows(curves_.columns, curves_.rows, [&](int first, int end) {
        for (std::size_t k = curves_.index(0, first); k < curves_.index(0, end); ++k) {
            Curve& curve = curves_.values[k];
            const float value = curve_values.values[k];
            if (images_ == curve.at + 1)
                curve.after = value;
            if (images_ == 0 || value > curve.largest) {
                curve.largest = value;
                curve.before = curve.last;
                curve.at = images_;
            }
            curve.sum += value;
            curve.last = value;
        }
    });
    ++images_;
}

double PeakTracker::position(int column, int row) const {
    const Curve& curve = curves_(column, row);
    if (curve.at == 0 || curve.at == images_ - 1)
        return std::numeric_limits<double>::quiet_NaN();
    return curve.at + gaussian_peak_offset(curve.before, curve.largest, curve.after);
}

double PeakTracker::prominence(int column, int row) const {
    const Curve& curve = curves_(column, row);
    return curve.largest - curve.sum / images_;
}

} // namespace vkfv::topography
