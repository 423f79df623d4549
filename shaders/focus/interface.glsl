// Numbers and records that host and kernels of the evaluation share besides records.glsl: bindings (set 0), push
// constants.

const uint BINDING_TO = 1u; // mean of planes
const uint BINDING_IMAGE = 2u;
const uint BINDING_BRIGHTNESS = 3u;
const uint BINDING_RESPONSES = 4u;
const uint BINDING_WEIGHTS = 5u;
const uint BINDING_ROW_SUMS = 6u;
const uint BINDING_CURVE = 7u;  // focus curve's values at one image
const uint BINDING_CURVES = 8u; // curves' values at the last images in turn
const uint BINDING_RECORDS = 9u;
const uint BINDING_PLACES = 10u;
const uint BINDING_ALL_IN_FOCUS = 11u;
const uint BINDING_SINGLES = 12u;
const uint BINDING_PIXELS = 13u;
const uint BINDING_GATHERED = 14u;
const uint BINDING_JOINT = 15u;   // joint_value() of the last images in turn
const uint BINDING_ALONE = 16u;   // alone_value() of the last images in turn
const uint BINDING_SQUARES = 17u; // squares of single images' focus measures
const uint BINDING_PLANE = 18u;   // the first of MOST_PLANES

// Largest number of planes that a dispatch reads (planes.glsl).
const int MOST_PLANES = 8;

// focus_mean.comp: terms of a weighted mean of planes.
struct MeanTerms {
    uint count;
    uint first_to; // index at which the mean begins
    uint first;    // 1: the first term starts the mean, else terms are added to it
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
    int kept; // number of curves kept
};

// focus_gather.comp
struct GatheredImage {
    uint count;
    uint first_from; // index at which the curves' values of this image begin
    uint first_to;
};

// focus_select.comp: a range of consecutive images.
struct SelectedImages {
    uint pixels;
    uint channels;
    int first;
    int planes;
};
