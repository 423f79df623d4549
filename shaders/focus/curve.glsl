// A focus curve that is followed image by image: a value is judged once the values within the range after it are known.

#ifdef __cplusplus
template <class Scene>
real joint_value(const Scene& scene, int image) {
    return scene.joint_value(image);
}
template <class Scene>
real alone_value(const Scene& scene, int image) {
    return scene.alone_value(image);
}
#else
real joint_value(int image);
real alone_value(int image);
#endif

VKFV_FUNCTION CurveRecord empty_curve() {
    CurveRecord curve;
    curve.largest = real(0.0);
    curve.sum = real(0.0);
    curve.offset = real(0.0);
    curve.residual = real(1.0);
    curve.bend = real(0.0);
    curve.at = 0;
    curve.found = 0;
    curve.first = real(0.0);
    curve.squares = real(0.0);
    curve.latest = real(0.0);
    curve.variation = real(0.0);
    curve.highest = real(0.0);
    curve.valley = real(0.0);
    curve.rival = real(0.0);
    curve.peak_1 = real(0.0);
    curve.peak_2 = real(0.0);
    curve.peak_3 = real(0.0);
    curve.peak_4 = real(0.0);
    curve.joint = real(0.0);
    curve.alone = real(0.0);
    curve.joint_squares = real(0.0);
    curve.alone_sum = real(0.0);
    return curve;
}

// True if the value is larger than all within the range before it and no smaller than those after it; never for the
// first or last image.
VKFV_SCENE_FUNCTION bool is_local_maximum(VKFV_SCENE_PARAMETER FocusPlan plan, int at, int images) {
    if (at == 0 || at == images - 1) {
        return false;
    }
    real value = curve_value(VKFV_SCENE at);
    if (!(value > curve_value(VKFV_SCENE at - 1)) || value < curve_value(VKFV_SCENE at + 1)) {
        return false; // most images end here
    }
    for (int d = 2; d <= plan.peak_range; ++d) {
        if (at - d >= 0 && !(value > curve_value(VKFV_SCENE at - d))) {
            return false;
        }
        if (at + d < images && value < curve_value(VKFV_SCENE at + d)) {
            return false;
        }
    }
    return true;
}

struct CurveStep {
    CurveRecord curve;
    real place; // images, place of the largest value; NO_PLACE: unchanged
};

// rival_with(): the deepest fall and rise of a curve so far, with the value added. valley_with(): the deepest valley
// that a later maximum can rise from.
VKFV_FUNCTION real rival_with(real rival, real highest, real valley, real value) {
    return max(rival, min(highest, value) - valley);
}

VKFV_FUNCTION real valley_with(real highest, real valley, real value) {
    return value > highest ? value : min(valley, value);
}

// Updates the fields that judge the shape of the whole curve. `highest` is the largest value so far, whether the curve
// turns there or not.
VKFV_FUNCTION CurveRecord follow_shape(CurveRecord before, real value, int at) {
    CurveRecord curve = before;
    curve.latest = value;
    curve.sum = before.sum + value;
    if (at == 0) {
        curve.first = value;
        curve.highest = value;
        curve.valley = value;
    } else {
        curve.squares = before.squares + (value - before.first) * (value - before.first);
        curve.variation = before.variation + abs(value - before.latest);
        curve.rival = rival_with(before.rival, before.highest, before.valley, value);
        curve.valley = valley_with(before.highest, before.valley, value);
        curve.highest = max(before.highest, value);
    }
    return curve;
}

VKFV_FUNCTION real squared_step(real from, real to) { return (to - from) * (to - from); }

VKFV_FUNCTION SingleRecord follow_single(SingleRecord before, real value, int at) {
    SingleRecord single = before;
    if (at == 0) {
        single.first = value;
        single.sum = real(0.0);
        single.squares = real(0.0);
        single.steps_1 = real(0.0);
        single.steps_2 = real(0.0);
        single.steps_3 = real(0.0);
        single.highest = value;
        single.valley = value;
        single.rival = real(0.0);
    } else {
        single.sum = before.sum + (value - before.first);
        single.squares = before.squares + squared_step(before.first, value);
        single.steps_1 = before.steps_1 + squared_step(before.before_1, value);
        single.steps_2 = before.steps_2 + (at > 1 ? squared_step(before.before_2, value) : real(0.0));
        single.steps_3 = before.steps_3 + (at > 2 ? squared_step(before.before_3, value) : real(0.0));
        single.rival = rival_with(before.rival, before.highest, before.valley, value);
        single.valley = valley_with(before.highest, before.valley, value);
        single.highest = max(before.highest, value);
    }
    single.before_1 = value;
    single.before_2 = before.before_1;
    single.before_3 = before.before_2;
    return single;
}

// The largest value of single images minus their mean.
VKFV_FUNCTION real single_rise(SingleRecord single, int images) {
    return single.highest - single.first - quotient(single.sum, real(images));
}

// The curve with the image `at` added. images: number of values known, at least to at + peak_range, or all. Fits are
// made only where the curve turns: the largest value of all is one of these, or stands at an end. Near the ends the
// range is the largest that fits on both sides.
VKFV_SCENE_FUNCTION CurveStep follow_curve(VKFV_SCENE_PARAMETER FocusPlan plan, CurveRecord before, int at,
                                           int images) {
    CurveStep step;
    step.place = NO_PLACE;
    real value = curve_value(VKFV_SCENE at);
    step.curve = follow_shape(before, value, at);
    real joint = joint_value(VKFV_SCENE at);
    real alone = alone_value(VKFV_SCENE at);
    step.curve.joint_squares = before.joint_squares + joint * joint;
    step.curve.alone_sum = before.alone_sum + alone;
    bool turns = at == images - 1 || value >= curve_value(VKFV_SCENE min(at + 1, images - 1));
    if (at == 0 || (value > before.largest && turns)) {
        int range = min(plan.peak_range, min(at, images - 1 - at));
        PeakFit fit = locate_peak(VKFV_SCENE plan, at, range);
        step.curve.largest = value;
        step.curve.joint = joint;
        step.curve.alone = alone;
        step.curve.bend =
            range > 0 ? real(2.0) * value - curve_value(VKFV_SCENE at - 1) - curve_value(VKFV_SCENE at + 1) : real(0.0);
        step.curve.at = at;
        step.curve.offset = fit.offset;
        step.curve.found = fit.found ? 1 : 0;
        step.curve.residual = gaussian_residual(VKFV_SCENE at, range);
        step.place = clamp(real(at) + fit.offset, real(0.0), real(images - 1));
    }
    if (is_local_maximum(VKFV_SCENE plan, at, images)) {
        real falling = value;
        real kept = max(step.curve.peak_1, falling);
        falling = min(step.curve.peak_1, falling);
        step.curve.peak_1 = kept;
        kept = max(step.curve.peak_2, falling);
        falling = min(step.curve.peak_2, falling);
        step.curve.peak_2 = kept;
        kept = max(step.curve.peak_3, falling);
        falling = min(step.curve.peak_3, falling);
        step.curve.peak_3 = kept;
        step.curve.peak_4 = max(step.curve.peak_4, falling);
    }
    return step;
}

// Number of local maxima that stand at least half as high above the curve's mean as the largest, at most 4.
VKFV_FUNCTION int count_peaks(CurveRecord curve, int images) {
    real mean = quotient(curve.sum, real(images));
    real least = mean + real(0.5) * (curve.largest - mean);
    return (curve.peak_1 >= least ? 1 : 0) + (curve.peak_2 >= least ? 1 : 0) + (curve.peak_3 >= least ? 1 : 0) +
           (curve.peak_4 >= least ? 1 : 0);
}

// The share of the curve's total variation that its largest maximum accounts for: 1 for a curve that rises to it and
// falls from it, whatever its form and width; little for values in random order or noise.
VKFV_FUNCTION real unimodality(CurveRecord curve) {
    return curve.variation > real(0.0)
               ? quotient(real(2.0) * curve.highest - curve.first - curve.latest, curve.variation)
               : real(0.0);
}

VKFV_FUNCTION real variance_about(real sum, real squares, int images) {
    real mean = quotient(sum, real(images));
    return max(real(0.0), quotient(squares, real(images)) - mean * mean);
}

// Measure of order in a curve. It is the product of its unimodality; of its standard deviation over that of single
// images, which no order changes, since persistent structure outlasts averages along z, and noise or texture that comes
// and goes does not; and of exp(c), where c is the single images' serial correlation over one to three images (J. von
// Neumann, "Distribution of the ratio of the mean square successive difference to the variance", 1941) with weights 1,
// 0.8 and 0.5. The threshold for random order is found from the stack itself.
VKFV_FUNCTION real order_shown(CurveRecord curve, SingleRecord single, int images) {
    real variance = variance_about(single.sum, single.squares, images);
    if (!(variance > real(0.0))) {
        return real(0.0);
    }
    real averaged = variance_about(curve.sum - real(images) * curve.first, curve.squares, images);
    real twice = real(2 * images) * variance;
    real correlation = (quotient(real(images - 1), real(images)) - quotient(single.steps_1, twice)) +
                       real(0.8) * (quotient(real(images - 2), real(images)) - quotient(single.steps_2, twice)) +
                       real(0.5) * (quotient(real(images - 3), real(images)) - quotient(single.steps_3, twice));
    return unimodality(curve) * root(quotient(averaged, variance)) * exponential(correlation);
}

// The weight of an image in a pixel of the all-in-focus image: the two images around the place count, linear between
// them, so that no seam shows where the nearest image changes.
VKFV_FUNCTION real share_in_focus(real place, int image) {
    return max(real(0.0), real(1.0) - abs(place - real(image)));
}
