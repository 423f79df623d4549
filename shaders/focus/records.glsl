// Records of the evaluation of focus stacks that host and device share, in scalar layout, and its choices by number.

const int FOCUS_STANDARD_DEVIATION = 0;
const int FOCUS_TENENGRAD = 1;
const int FOCUS_MODIFIED_LAPLACIAN = 2;
const int FOCUS_BRENNER = 3;
const int FOCUS_WAVELET = 4;
const int FOCUS_MEASURE_COUNT = 5;

const int PEAK_GAUSSIAN = 0;
const int PEAK_PARABOLA = 1;
const int PEAK_GAUSSIAN_FIT = 2;
const int PEAK_POLYNOMIAL_FIT = 3;
const int PEAK_CENTRE_OF_GRAVITY = 4;
const int PEAK_METHOD_COUNT = 5;

const int NO_IMAGE = -1;

struct FocusPlan {
    int columns;
    int rows;
    int channels;
    int measure;       // FOCUS_*
    int window_radius; // pixels
    int peak;          // PEAK_*
    int peak_range;    // steps on either side of the maximum, at least 1
};

// What is left of a pixel's focus curve once it has passed by. Values of the curve are dimensionless.
struct CurveRecord {
    real largest;
    real sum;      // of all values
    real offset;   // of the maximum, in steps from the image `at`
    real residual; // RMS distance from a Gaussian over the range, in units of the largest value
    int at;        // image of the largest value; the first of equals
    int found;     // 1: the method finds a maximum there
    real peak_1;   // the largest local maxima (is_local_maximum()) in descending order
    real peak_2;
    real peak_3;
    real peak_4;
};
