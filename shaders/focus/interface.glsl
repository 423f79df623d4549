// What host and kernels of the evaluation share besides the records: where buffers are bound (set 0), push constants.

const uint BINDING_FROM = 0u; // planes of a mean: what is added to it,
const uint BINDING_TO = 1u;   //   and the mean
const uint BINDING_IMAGE = 2u;
const uint BINDING_BEFORE = 3u;  // the image before
const uint BINDING_EARLIER = 4u; //   and the one before that
const uint BINDING_BRIGHTNESS = 5u;
const uint BINDING_SQUARED_DIFFERENCES = 6u;
const uint BINDING_RESPONSES = 7u;
const uint BINDING_WEIGHTS = 8u;
const uint BINDING_ROW_SUMS = 9u;
const uint BINDING_CURVE = 10u;  // of one image
const uint BINDING_CURVES = 11u; // the last images' in turn
const uint BINDING_RECORDS = 12u;
const uint BINDING_SHARPEST = 13u;
const uint BINDING_ALL_IN_FOCUS = 14u;

// focus_mean.comp: a term of a weighted mean of planes.
struct MeanTerm {
    uint count;
    uint first_to; // where the mean begins
    real weight;
    uint first; // 1: the first term
};

// focus_noise.comp
struct NoiseSizes {
    uint pixels;
    uint channels;
    uint differences; // 0: there are no two images before this
};

// focus_follow.comp
struct FollowedImage {
    FocusPlan plan;
    int at;
    int images;
    int kept; // curves
};

// focus_select.comp
struct SelectedImage {
    uint pixels;
    uint channels;
    int wanted;
};
