// A pixel's flux and standard error from its counted numbers, in double and operation by operation: host and devices
// find the same bits where their quotients and roots are IEEE 754's, as those of lavapipe and NVIDIA are. One source
// serves as GLSL for kernels/estimate_light.comp and as C++ (estimate.hpp).

const uint ESTIMATE_COUNTS = 0u;         // a pixel has one number: its count of rays
const uint ESTIMATE_WEIGHTS = 1u;        // a pixel has two numbers: sums of its rays' weights and of their squares
const uint ESTIMATE_RANDOMISATIONS = 2u; // a pixel has one number in each randomisation: the sum over its paths

// The rule that converts numbers to flux.
struct EstimateRule {
    uint kind;
    double scale;           // W of one ray of weight 1, or of a mean over a pixel's paths of 1
    double unit;            // value of 1 in a number; for a sum over paths: in their mean
    double unit_of_squares; // value of 1 in a sum of squared weights
    double count;           // number of launched rays, or of randomisations
};

struct PixelEstimate {
    double flux;           // W
    double standard_error; // W
};

VKFV_FUNCTION PixelEstimate scaled_estimate(EstimateRule rule, double value, double variance) {
    PixelEstimate estimate;
    estimate.flux = rule.scale * value;
    estimate.standard_error = rule.scale * sqrt(variance);
    return estimate;
}

// The estimate from all launched rays: sums of a pixel's values and of their squares, which are equal (Poisson) where
// the values are 1.
VKFV_FUNCTION PixelEstimate estimate_of_rays(EstimateRule rule, double sum, double squares) {
    VKFV_PRECISE double expected = sum * sum / rule.count;
    VKFV_PRECISE double variance = max(squares - expected, double(0.0));
    return scaled_estimate(rule, sum, variance);
}

// Sums over the means of the randomisations, added one after the other.
struct MeanSums {
    double sum;
    double squares;
};

VKFV_FUNCTION MeanSums with_randomisation(EstimateRule rule, MeanSums sums, double number) {
    VKFV_PRECISE double mean = rule.unit * number;
    VKFV_PRECISE double sum = sums.sum + mean;
    VKFV_PRECISE double squares = sums.squares + mean * mean;
    MeanSums all;
    all.sum = sum;
    all.squares = squares;
    return all;
}

// The estimate from the scatter of the randomisations' means.
VKFV_FUNCTION PixelEstimate estimate_of_randomisations(EstimateRule rule, MeanSums sums) {
    VKFV_PRECISE double mean = sums.sum / rule.count;
    VKFV_PRECISE double spread = sums.squares / rule.count - mean * mean;
    VKFV_PRECISE double variance = max(double(0.0), spread) / (rule.count - double(1.0));
    return scaled_estimate(rule, mean, variance);
}
