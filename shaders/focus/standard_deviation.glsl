// The standard deviation of grey levels over the window. F. C. A. Groen, I. T. Young and G. Ligthart, "A comparison of
// different focus functions for use in autofocus algorithms", 1985: their normalised variance, of which the root is
// taken. It has no response at a pixel alone, so the window gathers it: the variance over the window is the mean of its
// rows' variances plus the variance of their means, and no difference of large sums is taken.

VKFV_FUNCTION real squared_deviation(real level, real mean) {
    real deviation = level - mean;
    return deviation * deviation;
}
