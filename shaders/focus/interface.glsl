// What host and kernels of the evaluation share besides the records: where buffers are bound (set 0), push constants.

const uint BINDING_TO = 1u; // a mean of planes
const uint BINDING_IMAGE = 2u;
const uint BINDING_BRIGHTNESS = 3u;
const uint BINDING_RESPONSES = 4u;
const uint BINDING_WEIGHTS = 5u;
const uint BINDING_ROW_SUMS = 6u;
const uint BINDING_CURVE = 7u;  // of one image
const uint BINDING_CURVES = 8u; // the last images' in turn
const uint BINDING_RECORDS = 9u;
const uint BINDING_PLACES = 10u;
const uint BINDING_ALL_IN_FOCUS = 11u;
const uint BINDING_SINGLES = 12u;
const uint BINDING_PIXELS = 13u;
const uint BINDING_GATHERED = 14u;
const uint BINDING_JOINT = 15u;   // joint_value() of the last images in turn
const uint BINDING_ALONE = 16u;   // alone_value(), likewise
const uint BINDING_SQUARES = 17u; // of single images' focus measures
const uint BINDING_PLANE = 18u;   // the first of MOST_PLANES

// That a dispatch reads at most (planes.glsl).
const int MOST_PLANES = 8;

// focus_mean.comp: terms of a weighted mean of planes.
struct MeanTerms {
    uint count;
    uint first_to; // where the mean begins
    uint first;    // 1: with the mean's first term
    int planes;
    real weights[MOST_PLANES];
};

// focus_brightness.comp
struct ImageSize {
    uint pixels;
    uint channels;
};

// focus_single.comp
struct SingleImage {
    uint pixels;
    int at;
};

// focus_follow.comp
struct FollowedImage {
    FocusPlan plan;
    int at;
    int images;
    int kept; // curves
};

// focus_gather.comp
struct GatheredImage {
    uint count;
    uint first_from; // where the curves' values of this image begin
    uint first_to;
};

// focus_select.comp: images that follow each other.
struct SelectedImages {
    uint pixels;
    uint channels;
    int first;
    int planes;
};
