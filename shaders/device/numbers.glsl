// Binding numbers (set 0) and specialisation constant numbers that host and kernels of the trace share.

const uint BINDING_SURFACES = 0u;
const uint BINDING_PARAMETERS = 1u;
const uint BINDING_SURVIVORS = 2u;
const uint BINDING_PIXELS = 3u;
const uint BINDING_LEDGER = 4u;
const uint BINDING_SURVIVOR_COUNT = 5u;
const uint BINDING_GIVEN = 6u; // input of kernels that are no part of the trace
const uint BINDING_FOUND = 7u; // output of these kernels
// The following buffers hold the specimen; src/trace/device/device_specimen.cpp fills them.
const uint BINDING_HEIGHTS = 8u;
const uint BINDING_CEILINGS = 9u;
const uint BINDING_VERTICES = 10u; // or pairs of triangles, for vkfv's own hierarchy of boxes
const uint BINDING_TRIANGLES = 11u;
const uint BINDING_STRUCTURE = 12u; // acceleration structure, or the nodes of the own hierarchy
const uint BINDING_TILES = 13u;
const uint BINDING_SPECTRUM = 14u;
const uint BINDING_ELEMENTS = 15u;
const uint BINDING_ELEMENT_ORDER = 16u;
const uint BINDING_BACKWARD = 17u;
const uint BINDING_REFLECTANCES = 18u; // grid of the specimen's reflectance map
const uint BINDING_FACETS = 19u;
const uint BINDING_LIGHT_POINTS = 20u; // grid of the pattern in the plane of the field stop
const uint BINDING_EMISSION_CELLS = 21u;
const uint BINDING_EMISSION_FIRST = 22u;
const uint BINDING_ENTRY_NODES = 23u;
const uint BINDING_MATERIAL = 24u; // numbers of the specimen's material

const uint FACET_BIT = 0x80000000u; // in the order of the elements' boxes: the rest of the number is a facet's index

const uint CONSTANT_SPECIMEN_KIND = 0u;
const uint CONSTANT_LEDGER_SLOTS = 1u;
const uint CONSTANT_STOP_AFTER = 2u;
const uint CONSTANT_FEATURES = 3u;
const uint CONSTANT_SCATTER_MODELS = 4u;
const uint CONSTANT_CONE_CANDIDATES = 5u;
const uint CONSTANT_LOBE_CANDIDATES = 6u;
const uint CONSTANT_QUERY_CAPACITY = 7u;
const uint CONSTANT_HITS_WAY = 8u;
const uint CONSTANT_FALLING_CELLS = 9u;
const uint CONSTANT_RIM_PERIOD = 10u;
const uint CONSTANT_SURE_CANDIDATES = 11u;

// Stages after which the halves of the forward trace may end early, for timing alone.
const uint STOP_NOWHERE = 0u;
const uint STOP_AFTER_TRAIN = 1u; // the illumination, or in the second half the imaging, before the detector counts
const uint STOP_AFTER_SPECIMEN = 2u;
const uint STOP_AFTER_SOURCE = 3u;

const uint HITS_ARRIVE = 0u; // rays go down from the top plane
const uint HITS_RECORD = 1u; // as HITS_ARRIVE, and the meetings are kept
const uint HITS_LEAVE = 2u;  // rays leave the kept meetings, cosine-distributed over the hemisphere of the normal

// Fields that a kernel can have as constants (device/prescription.glsl): the range of surfaces, and fields of
// Instrument, of SpecimenRecord, and of its material's first lobe.
const uint CONSTANT_KNOWN_FIRST = 88u;
const uint CONSTANT_KNOWN_COUNT = 89u;
// clang-format off
#define VKFV_KNOWN_OF_INSTRUMENT(KNOWN) \
    KNOWN(90, int, illumination_first) \
    KNOWN(91, int, illumination_count) \
    KNOWN(92, int, imaging_first) \
    KNOWN(93, int, imaging_count)
#define VKFV_KNOWN_OF_SPECIMEN(KNOWN) \
    KNOWN(94, int, max_bounces)
#define VKFV_KNOWN_OF_LOBE(KNOWN) \
    KNOWN(95, real, parameter_0) \
    KNOWN(96, real, parameter_1) \
    KNOWN(97, real, parameter_2) \
    KNOWN(98, real, parameter_3)
// clang-format on
const uint CONSTANT_KNOWN_SURFACES = 100u; // first number of the surfaces' constants
const uint KNOWN_FIELD_CAPACITY = 16u;     // numbers reserved for each surface; a field has the number of its place

// Polynomials of the illumination (device/train_polynomials.glsl): fields of TrainPolynomials, then the terms and
// degree of each polynomial, and for an edge's polynomial the other fields of EdgePolynomial.
const uint CONSTANT_POLYNOMIAL_EDGES = 12u;
const uint CONSTANT_POLYNOMIAL_PER_RADIUS = 13u;
const uint CONSTANT_POLYNOMIAL_SHIFT = 14u;
const uint CONSTANT_POLYNOMIAL_PER_SINE = 15u;
const uint CONSTANT_POLYNOMIAL_PLANE = 16u;
const uint CONSTANT_POLYNOMIALS = 1200u;    // from here to 1839; glslang takes numbers below 2048
const uint KNOWN_POLYNOMIAL_CAPACITY = 64u; // numbers reserved for each: terms, degree and edge
const uint KNOWN_DEGREE = 56u;
const uint KNOWN_EDGE_SURFACE = 57u;
const uint KNOWN_EDGE_INSIDE_BELOW = 58u;
const uint KNOWN_EDGE_ENDS_FROM = 59u;
const uint KNOWN_EDGE_ENDS_BELOW = 60u;
