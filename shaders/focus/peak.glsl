// The maximum of a focus curve, to a fraction of a step. Positions are offsets from the image `at` in steps.

struct PeakFit {
    real offset;
    bool found; // true: there is a maximum within the range
};

#ifdef __cplusplus
template <class Scene>
real curve_value(const Scene& scene, int image) {
    return scene.curve_value(image);
}
#else
real curve_value(int image);
#endif

// ln(a / b) without the loss of digits where a and b are nearly equal, as the values around a maximum are: with
// t = (a - b) / (a + b) it is 2 artanh t, whose series ends below the last digit of a double for |t| < 0.05.
VKFV_FUNCTION real log_ratio(real a, real b) {
    real t = quotient(a - b, a + b);
    real s = t * t;
    real series =
        real(1.0) + s * (real(1.0 / 3.0) +
                         s * (real(1.0 / 5.0) + s * (real(1.0 / 7.0) + s * (real(1.0 / 9.0) + s * real(1.0 / 11.0)))));
    return abs(t) < real(0.05) ? real(2.0) * t * series : natural_log(quotient(a, b));
}

VKFV_FUNCTION PeakFit no_peak() {
    PeakFit fit;
    fit.offset = real(0.0);
    fit.found = false;
    return fit;
}

// The offset of the maximum of a Gaussian through the points (-1, before), (0, at), (1, after),
//   (ln before - ln after) / (2 (ln before - 2 ln at + ln after)),
// which is exact for a Gaussian. There is none unless all three are positive and `at` is no smaller than its neighbours
// and larger than one of them.
VKFV_FUNCTION PeakFit gaussian_peak(real before, real at, real after) {
    PeakFit fit = no_peak();
    if (before > real(0.0) && after > real(0.0) && at >= before && at >= after) {
        real a = log_ratio(before, at);
        real c = log_ratio(after, at);
        if (a + c < real(0.0)) {
            fit.offset = quotient(a - c, real(2.0) * (a + c));
            fit.found = true;
        }
    }
    return fit;
}

// The offset of the maximum of a parabola through three points: (before - after) / (2 (before - 2 at + after)).
VKFV_FUNCTION PeakFit parabola_peak(real before, real at, real after) {
    PeakFit fit = no_peak();
    real curvature = (before - at) + (after - at);
    if (at >= before && at >= after && curvature < real(0.0)) {
        fit.offset = quotient(before - after, real(2.0) * curvature);
        fit.found = true;
    }
    return fit;
}

// A least-squares parabola level + slope p1(x) + bend p2(x) over x = -range ... range, in the polynomials
// p1 = x - middle_1 and p2 = (x - middle_2) p1 - overlap that are orthogonal under its weights (G. E. Forsythe,
// "Generation and use of orthogonal polynomials for data-fitting with a digital computer", 1957): no normal equations
// are solved.
struct ParabolaFit {
    real middle_1;
    real middle_2;
    real overlap;
    real level;
    real slope;
    real bend;
};

// Weight and value of a point in the fit. The parabola is fitted to the values with equal weights or, if `logarithmic`,
// to the logarithms of their ratios to the largest, weighted by the square of the value (H. Guo, "A simple algorithm
// for fitting a Gaussian function", 2011), since the logarithm's noise is that of the value over the value.
VKFV_SCENE_FUNCTION real fit_weight(VKFV_SCENE_PARAMETER int at, int step, bool logarithmic) {
    real ratio = quotient(curve_value(VKFV_SCENE at + step), curve_value(VKFV_SCENE at));
    return logarithmic ? (ratio > real(0.0) ? ratio * ratio : real(0.0)) : real(1.0);
}

VKFV_SCENE_FUNCTION real fit_value(VKFV_SCENE_PARAMETER int at, int step, bool logarithmic) {
    real value = curve_value(VKFV_SCENE at + step);
    real largest = curve_value(VKFV_SCENE at);
    return logarithmic ? (value > real(0.0) ? log_ratio(value, largest) : real(0.0)) // its weight is 0
                       : quotient(value - largest, largest);
}

VKFV_SCENE_FUNCTION ParabolaFit fit_parabola(VKFV_SCENE_PARAMETER int at, int range, bool logarithmic) {
    real total = real(0.0);
    real first = real(0.0);
    real level = real(0.0);
    for (int x = -range; x <= range; ++x) {
        real weight = fit_weight(VKFV_SCENE at, x, logarithmic);
        total = total + weight;
        first = first + weight * real(x);
        level = level + weight * fit_value(VKFV_SCENE at, x, logarithmic);
    }
    ParabolaFit fit;
    fit.middle_1 = quotient(first, total);
    fit.level = quotient(level, total);
    real square_1 = real(0.0);
    real third = real(0.0);
    real slope = real(0.0);
    for (int x = -range; x <= range; ++x) {
        real weight = fit_weight(VKFV_SCENE at, x, logarithmic);
        real p = real(x) - fit.middle_1;
        square_1 = square_1 + weight * p * p;
        third = third + weight * p * p * real(x);
        slope = slope + weight * p * (fit_value(VKFV_SCENE at, x, logarithmic) - fit.level);
    }
    fit.middle_2 = quotient(third, square_1);
    fit.overlap = quotient(square_1, total);
    fit.slope = quotient(slope, square_1);
    real square_2 = real(0.0);
    real bend = real(0.0);
    for (int x = -range; x <= range; ++x) {
        real p1 = real(x) - fit.middle_1;
        real p2 = (real(x) - fit.middle_2) * p1 - fit.overlap;
        real weight = fit_weight(VKFV_SCENE at, x, logarithmic);
        square_2 = square_2 + weight * p2 * p2;
        bend = bend + weight * p2 * (fit_value(VKFV_SCENE at, x, logarithmic) - fit.level - fit.slope * p1);
    }
    fit.bend = quotient(bend, square_2);
    return fit;
}

VKFV_FUNCTION PeakFit fitted_peak(ParabolaFit parabola, int range) {
    PeakFit fit = no_peak();
    if (parabola.bend < real(0.0)) {
        real offset =
            real(0.5) * (parabola.middle_1 + parabola.middle_2) - quotient(parabola.slope, real(2.0) * parabola.bend);
        if (abs(offset) <= real(range)) {
            fit.offset = offset;
            fit.found = true;
        }
    }
    return fit;
}

// The centre of gravity of the values minus the smallest in the range, so that a pedestal does not draw it to the
// middle. A symmetric range around the largest value still draws it there by the parts it cuts off: choose one that
// reaches the curve's feet.
VKFV_SCENE_FUNCTION PeakFit centre_of_gravity(VKFV_SCENE_PARAMETER int at, int range) {
    real floor_value = curve_value(VKFV_SCENE at);
    for (int x = -range; x <= range; ++x) {
        floor_value = min(floor_value, curve_value(VKFV_SCENE at + x));
    }
    real total = real(0.0);
    real first = real(0.0);
    for (int x = -range; x <= range; ++x) {
        real value = curve_value(VKFV_SCENE at + x) - floor_value;
        total = total + value;
        first = first + value * real(x);
    }
    PeakFit fit = no_peak();
    if (total > real(0.0)) {
        fit.offset = quotient(first, total);
        fit.found = true;
    }
    return fit;
}

// The maximum around the image `at`, whose value is the largest, by the plan's method over images at - range ... at +
// range.
VKFV_SCENE_FUNCTION PeakFit locate_peak(VKFV_SCENE_PARAMETER FocusPlan plan, int at, int range) {
    PeakFit fit = no_peak();
    real largest = curve_value(VKFV_SCENE at);
    if (range < 1 || !(largest > real(0.0))) {
        return fit;
    }
    real before = curve_value(VKFV_SCENE at - 1);
    real after = curve_value(VKFV_SCENE at + 1);
    if (plan.peak == PEAK_GAUSSIAN) {
        fit = gaussian_peak(before, largest, after);
    } else if (plan.peak == PEAK_PARABOLA) {
        fit = parabola_peak(before, largest, after);
    } else if (plan.peak == PEAK_CENTRE_OF_GRAVITY) {
        fit = centre_of_gravity(VKFV_SCENE at, range);
    } else if (before > real(0.0) && after > real(0.0)) {
        fit = fitted_peak(fit_parabola(VKFV_SCENE at, range, plan.peak == PEAK_GAUSSIAN_FIT), range);
    }
    return fit;
}

// RMS distance of the values from the least-squares Gaussian over the range, in units of the largest: a measure of how
// little the curve resembles a single peak, the same number whatever the method.
VKFV_SCENE_FUNCTION real gaussian_residual(VKFV_SCENE_PARAMETER int at, int range) {
    real largest = curve_value(VKFV_SCENE at);
    if (range < 1 || !(curve_value(VKFV_SCENE at - 1) > real(0.0)) || !(curve_value(VKFV_SCENE at + 1) > real(0.0))) {
        return real(1.0);
    }
    ParabolaFit fit = fit_parabola(VKFV_SCENE at, range, true);
    real sum = real(0.0);
    for (int x = -range; x <= range; ++x) {
        real p1 = real(x) - fit.middle_1;
        real exponent = fit.level + fit.slope * p1 + fit.bend * ((real(x) - fit.middle_2) * p1 - fit.overlap);
        real distance = quotient(curve_value(VKFV_SCENE at + x), largest) - exponential(min(exponent, real(1.0)));
        sum = sum + distance * distance;
    }
    return root(quotient(sum, real(2 * range + 1)));
}
