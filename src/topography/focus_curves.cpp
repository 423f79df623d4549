#include "topography/focus_curves.hpp"

#include <algorithm>

namespace vkfv::topography {

namespace {

namespace f64 = focus::f64;

struct ValuesScene {
    const std::vector<double>& values;
    double curve_value(int image) const { return values[static_cast<std::size_t>(image)]; }
};

std::vector<int> evenly_spread(int count, int pixels) {
    const int kept = std::min(count, pixels);
    std::vector<int> places;
    places.reserve(static_cast<std::size_t>(kept));
    for (int k = 0; k < kept; ++k) {
        places.push_back(static_cast<int>((2 * std::int64_t{k} + 1) * pixels / (2 * std::int64_t{kept})));
    }
    return places;
}

} // namespace

std::vector<int> CurveGrid::columns_of(int image_columns) const {
    return evenly_spread(columns, image_columns);
}

std::vector<int> CurveGrid::rows_of(int image_rows) const {
    return evenly_spread(rows, image_rows);
}

CurveFit fit_of(PeakMethod method, const std::vector<double>& curve, int at, int range) {
    CurveFit fit{.at = at,
                 .gaussian = method == PeakMethod::gaussian || method == PeakMethod::gaussian_fit,
                 .largest = curve[static_cast<std::size_t>(at)]};
    const bool three_values = method == PeakMethod::gaussian || method == PeakMethod::parabola;
    const int images = static_cast<int>(curve.size());
    const int reach = std::min({three_values ? 1 : range, at, images - 1 - at});
    if (reach < 1 || !(fit.largest > 0) || method == PeakMethod::centre_of_gravity) {
        return fit;
    }
    // Least squares through three points are exact, whatever the weights.
    const auto parabola = f64::fit_parabola(ValuesScene{curve}, at, reach, fit.gaussian);
    fit.range = reach;
    fit.coefficients = {parabola.level - parabola.slope * parabola.middle_1 +
                            parabola.bend * (parabola.middle_1 * parabola.middle_2 - parabola.overlap),
                        parabola.slope - parabola.bend * (parabola.middle_1 + parabola.middle_2), parabola.bend};
    return fit;
}

} // namespace vkfv::topography
