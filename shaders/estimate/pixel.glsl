// What the numbers that were counted for a pixel say of its light, in double and operation by operation: host and
// devices find the same bits where their quotients and roots are IEEE 754's, as those of lavapipe and NVIDIA are. One
// source, as GLSL for kernels/estimate_light.comp and as C++ (estimate.hpp).

const uint ESTIMATE_COUNTS = 0u;         // a pixel has one number: of rays
const uint ESTIMATE_WEIGHTS = 1u;        // two: the sum of the rays' weights and the sum of the weights' squares
const uint ESTIMATE_RANDOMISATIONS = 2u; // one in each randomisation: the sum over its paths

// How numbers become flux.
struct EstimateRule {
    uint kind;
    double scale;           // W that 1 stands for: of one ray of weight 1, or of the mean over a pixel's paths
    double unit;            // of a number; of a sum over paths: of their mean
    double unit_of_squares; // of weights
    double count;           // of launched rays, or of randomisations
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

// From what a pixel has of all launched rays: a sum of values and of their squares (Poisson's where they are 1).
VKFV_FUNCTION PixelEstimate estimate_of_rays(EstimateRule rule, double sum, double squares) {
    VKFV_PRECISE double expected = sum * sum / rule.count;
    VKFV_PRECISE double variance = max(squares - expected, double(0.0));
    return scaled_estimate(rule, sum, variance);
}

// Of the means of randomisations, one after the other.
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

// From their scatter.
VKFV_FUNCTION PixelEstimate estimate_of_randomisations(EstimateRule rule, MeanSums sums) {
    VKFV_PRECISE double mean = sums.sum / rule.count;
    VKFV_PRECISE double spread = sums.squares / rule.count - mean * mean;
    VKFV_PRECISE double variance = max(double(0.0), spread) / (rule.count - double(1.0));
    return scaled_estimate(rule, mean, variance);
}
