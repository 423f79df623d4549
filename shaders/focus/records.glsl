// Records of the evaluation of focus stacks that host and device share, in scalar layout, and the numbers of its
// choices.

const int FOCUS_STANDARD_DEVIATION = 0;
const int FOCUS_TENENGRAD = 1;
const int FOCUS_MODIFIED_LAPLACIAN = 2;
const int FOCUS_BRENNER = 3;
const int FOCUS_WAVELET = 4;
const int FOCUS_GRADIENT_AND_CURVATURE = 5;
const int FOCUS_MEASURE_COUNT = 6;

const int PEAK_GAUSSIAN = 0;
const int PEAK_PARABOLA = 1;
const int PEAK_GAUSSIAN_FIT = 2;
const int PEAK_POLYNOMIAL_FIT = 3;
const int PEAK_CENTRE_OF_GRAVITY = 4;
const int PEAK_METHOD_COUNT = 5;

const real NO_PLACE = real(-2.0);

// clang-format off
#define VKFV_FOCUS_PLAN_FIELDS(FIELD) \
    FIELD(int, columns) \
    FIELD(int, rows) \
    FIELD(int, channels) \
    FIELD(int, measure)       /* FOCUS_* */ \
    FIELD(int, window_radius) /* pixels */ \
    FIELD(int, peak)          /* PEAK_* */ \
    FIELD(int, peak_range)    /* steps on either side of the maximum, at least 1 */
struct FocusPlan {
    VKFV_FOCUS_PLAN_FIELDS(VKFV_DECLARE)
};

// The summary of a pixel's focus curve, updated image by image. Values of the curve are dimensionless.
#define VKFV_CURVE_RECORD_FIELDS(FIELD) \
    FIELD(real, largest) \
    FIELD(real, sum)      /* sum of all values */ \
    FIELD(real, offset)   /* of the maximum, in steps from the image `at` */ \
    /* RMS distance from a Gaussian over the range, in units of the largest value */ \
    FIELD(real, residual) \
    FIELD(real, bend)     /* twice the largest value, minus the values of both its neighbours */ \
    FIELD(int, at)        /* image of the largest value; the first of equals */ \
    FIELD(int, found)     /* 1: the method finds a maximum there */ \
    FIELD(real, first)     /* first value */ \
    FIELD(real, squares)   /* sum of squared differences from the first value */ \
    FIELD(real, latest)    /* latest value */ \
    FIELD(real, variation) /* sum of the steps from value to value, up or down */ \
    FIELD(real, highest)   /* largest value so far */ \
    FIELD(real, valley)    /* the smallest value since the largest */ \
    FIELD(real, rival)     /* how far the curve falls and rises again, at most: prominence of the second maximum */ \
    FIELD(real, peak_1)   /* the largest local maxima (is_local_maximum()) in descending order */ \
    FIELD(real, peak_2) \
    FIELD(real, peak_3) \
    FIELD(real, peak_4) \
    /* Persistence (below), where the curve is largest: joint_value() and alone_value() of that image */ \
    FIELD(real, joint) \
    FIELD(real, alone) \
    FIELD(real, joint_squares) /* sum of the squares of joint_value() over all images */ \
    FIELD(real, alone_sum)     /* sum of alone_value() over all images */
// Texture stays from image to image, and its measure is the same whether images are averaged before or after it is
// taken. Noise differs from image to image, and averaging the images before removes it, however its strength changes
// along z. So two values of every image are compared: joint_value(), the focus measure of the mean of the images around
// it, and alone_value(), the mean square of those images' own focus measures.
struct CurveRecord {
    VKFV_CURVE_RECORD_FIELDS(VKFV_DECLARE)
};

// The summary of the curve of single images, before any average along z.
#define VKFV_SINGLE_RECORD_FIELDS(FIELD) \
    FIELD(real, first)   /* first value; sums are of differences from it */ \
    FIELD(real, sum) \
    FIELD(real, squares) \
    FIELD(real, before_1) /* the last values, the latest first */ \
    FIELD(real, before_2) \
    FIELD(real, before_3) \
    FIELD(real, steps_1)  /* sum of squared differences between values one image apart */ \
    FIELD(real, steps_2)  /* two images apart */ \
    FIELD(real, steps_3)  /* three images apart */ \
    FIELD(real, highest) \
    FIELD(real, valley)  /* the smallest value since the largest */ \
    FIELD(real, rival)
struct SingleRecord {
    VKFV_SINGLE_RECORD_FIELDS(VKFV_DECLARE)
};
// clang-format on
