// Records that host and device share, in scalar layout: physics.hpp compiles them in float for the buffers. A record is
// a list of its fields, and code that goes through all fields is made of that list: the struct, its rounding from
// double to float (src/trace/interface/device_records.cpp), the constants that kernels know (device/prescription.glsl),
// and the probe of the layout (tests/trace/records_test.cpp). Units are mm and W; directions are unit vectors scaled by
// the refractive index of the medium they travel in.

// Status of a path. Every path ends with exactly one of these, and the ledger counts each.
const uint PATH_ALIVE = 0u;             // still under way: never a final status
const uint PATH_DETECTED = 1u;          // counted on a pixel
const uint PATH_OFF_SPECIMEN = 2u;      // the illumination passed beside the specimen's footprint
const uint PATH_ESCAPED = 3u;           // left the specimen outside the pupil's gate
const uint PATH_BOUNCE_LIMIT = 4u;      // would have met the specimen more often than permitted
const uint PATH_OFF_DETECTOR = 5u;      // reached the detector's plane beside the detector
const uint PATH_NUMERICAL = 6u;         // a non-finite number or an exhausted rejection loop
const uint PATH_ABSORBED = 7u;          // absorbed by the specimen
const uint PATH_INTERACTION_LIMIT = 8u; // non-sequential: met more surfaces than permitted
const uint PATH_VIGNETTED = 9u;         // stopped by the edge of a surface (a surface index belongs to it)
const uint PATH_MISSED_SURFACE = 10u;   // a surface of a train does not meet the ray (a surface index belongs to it)
const uint PATH_TOTAL_REFLECTION = 11u; // totally reflected at a surface (a surface index belongs to it)
const uint PATH_INTERFACE_LOSS = 12u;   // reflected by an interface, absorbed by a mirror (with a surface index)
const int PATH_STATUS_COUNT = 13;
const int SURFACE_STATUS_COUNT = 4; // statuses from PATH_VIGNETTED on

const uint SURFACE_CLIPPED = 1u;      // semi_diameter_squared limits it; without the flag it is unbounded
const uint SURFACE_ASPHERIC = 2u;     // the even coefficients are not all zero
const uint SURFACE_FRESNEL = 4u;      // reflects by Fresnel's equations
const uint SURFACE_LAYER = 8u;        // reflects by Fresnel's equations through one thin layer
const uint SURFACE_MIRROR = 16u;      // plane; a train is unfolded at it
const uint SURFACE_IDEAL_LENS = 32u;  // an ideal lens of `power` instead of an interface
const uint SURFACE_LIGHT_FIELD = 64u; // lets through the share that the instrument's LightField gives
const uint SURFACE_TURNED = 128u;     // its frame is the light field's turned by half a turn about x

// Features that some scenes have and most have not: kernels are compiled without the absent ones.
const uint FEATURE_PLACEMENT = 1u; // surfaces decentred or tilted against each other
const uint FEATURE_LOSSES = 2u;    // interfaces that reflect, mirrors that absorb
const uint FEATURE_SPECTRUM = 4u;  // more than one wavelength
const uint FEATURE_IDEAL_LENS = 8u;
const uint FEATURE_RING = 16u;                // a ring light instead of the disc
const uint FEATURE_DIRECTED_SCATTER = 32u;    // the trace directs scatter at the gate: survivors have weights
const uint FEATURE_PUPIL_CELLS = 128u;        // the trace sorts light by where it crosses the pupil
const uint FEATURE_REFLECTANCE_MAP = 64u;     // the specimen has a map of its reflectance
const uint FEATURE_RECTANGLE = 256u;          // a rectangle instead of the disc
const uint FEATURE_FACETS = 512u;             // elements whose form is a mesh
const uint FEATURE_LIGHT_FIELD = 1024u;       // a pattern or uneven light in the plane of the field stop
const uint FEATURE_AIMED_RECTANGLE = 2048u;   // directions of the source are a rectangle instead of a disc
const uint FEATURE_SPECTRAL_MATERIAL = 4096u; // the specimen's material changes with the wavelength

const int SURFACE_CAPACITY = 128;  // most surfaces of both trains together, limited by the device's uniform block
const int KNOWN_SURFACES = 64;     // most surfaces that a kernel can have as constants (device/prescription.glsl)
const int SPECTRUM_CAPACITY = 256; // most bins of a spectrum, limited by the device's uniform block
const int RING_CAPACITY = 32;      // most segments of a ring light, which are bits of a mask

// clang-format off

// index(x) - index(0) = c1 x + ... + c6 x^6 with the spectral coordinate x of Light.
#define VKFV_DISPERSION_FIELDS(FIELD) \
    FIELD(real, c1) \
    FIELD(real, c2) \
    FIELD(real, c3) \
    FIELD(real, c4) \
    FIELD(real, c5) \
    FIELD(real, c6)
struct Dispersion {
    VKFV_DISPERSION_FIELDS(VKFV_DECLARE)
};

// A refracting surface, mirror, ideal lens or stop, in the frame of its own vertex; light travels towards +z.
// The sag is z = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + a4 r^4 + ... + a16 r^16 (ISO 10110-12, eq. 5).
// Points come from the frame of the previous vertex by p' = rotation (p - (decentre_x, decentre_y, distance)).
// KNOWN: a field of the k-th surface that a kernel can have as a constant, with its place in the order of the surface's
// constants (device/prescription.glsl).
#define VKFV_SURFACE_FIELDS(FIELD, KNOWN, k) \
    KNOWN(k, 0, real, curvature)             /* 1/mm, positive: centre of curvature towards +z */ \
    KNOWN(k, 1, real, conic)                 /* conic constant k; 0 is a sphere */ \
    KNOWN(k, 2, real, semi_diameter_squared) /* mm^2 */ \
    KNOWN(k, 3, real, distance)              /* mm, from the previous vertex along its z; a train's first: 0 */ \
    FIELD(real, index_before)                /* index at spectral coordinate x = 0 */ \
    KNOWN(k, 4, real, index_after) \
    KNOWN(k, 5, real, a4)                    /* mm^-3, and so on for mm^-5 ... */ \
    KNOWN(k, 6, real, a6) \
    KNOWN(k, 7, real, a8) \
    KNOWN(k, 8, real, a10) \
    KNOWN(k, 9, real, a12) \
    KNOWN(k, 10, real, a14) \
    KNOWN(k, 11, real, a16) \
    FIELD(real, decentre_x)                  /* mm */ \
    FIELD(real, decentre_y) \
    FIELD(real, rotation_xx)                 /* weight of old x in new x, and so on */ \
    FIELD(real, rotation_xy) \
    FIELD(real, rotation_xz) \
    FIELD(real, rotation_yx) \
    FIELD(real, rotation_yy) \
    FIELD(real, rotation_yz) \
    FIELD(real, rotation_zx) \
    FIELD(real, rotation_zy) \
    FIELD(real, rotation_zz) \
    FIELD(real, power)                       /* 1/mm, for an ideal lens */ \
    FIELD(real, reflectance)                 /* for a mirror */ \
    FIELD(real, layer_index)                 /* index of the thin layer */ \
    FIELD(real, layer_thickness)             /* um */ \
    /* 1/mm: what curvature * (index_after - index_before), of the rounded numbers, falls short of; 0 in double. */ \
    KNOWN(k, 13, real, bend_residual) \
    FIELD(Dispersion, dispersion_before) \
    FIELD(Dispersion, dispersion_after) \
    KNOWN(k, 12, uint, flags)                /* SURFACE_* */
struct Surface {
    VKFV_SURFACE_FIELDS(VKFV_DECLARE, VKFV_DECLARE_KNOWN, 0)
};

// A ray, in the frame that the function states.
struct Ray {
    real3 position;   // mm
    real3 direction;  // unit vector times the index of the medium
    real path_length; // optical path so far, mm
};

// Spectral properties of a ray's light, and its draw for losses.
struct Light {
    real spectral;    // x = (1/lambda^2 - centre) / half-width of the spectrum in 1/lambda^2; in [-1, 1]
    real wave_number; // 1/um, 1/lambda
    real survival;    // in [0, 1): light is lost where the product of the transmittances is below this
};

// A bin of a spectrum, whose density changes linearly from (1 - tilt) to (1 + tilt) times its mean.
#define VKFV_SPECTRAL_BIN_FIELDS(FIELD) \
    FIELD(real, cumulative) /* share of the flux in this bin and those before it */ \
    FIELD(real, start)      /* um */ \
    FIELD(real, stop)       /* um; equal to start for a line */ \
    FIELD(real, tilt)
struct SpectralBin {
    VKFV_SPECTRAL_BIN_FIELDS(VKFV_DECLARE)
};

// A ring of Lambertian segments that face the axis' meeting with the plane of best focus: a band of a cone.
#define VKFV_RING_LIGHT_FIELDS(FIELD) \
    /* mm, from the illumination train's first vertex to that meeting along the axis */ \
    FIELD(real, aim_distance) \
    FIELD(real, distance)         /* mm, from there to the middle of the band */ \
    /* of the direction to the middle of the band, over the specimen's plane */ \
    FIELD(real, elevation_sine) \
    FIELD(real, elevation_cosine) \
    FIELD(real, half_width)       /* mm, of the band, at right angles to that direction */ \
    FIELD(real, fill)             /* share of its sector that a segment takes */ \
    FIELD(int, segments) \
    FIELD(uint, switched_on)      /* bit k: segment k, counted from +x towards +y of the specimen frame */
struct RingLight {
    VKFV_RING_LIGHT_FIELDS(VKFV_DECLARE)
};

const uint ELEMENT_INTERFACE = 0u;
const uint ELEMENT_STOP = 1u; // passes light within its aperture
const uint ELEMENT_MIRROR = 2u;
const uint ELEMENT_SPLITTER = 3u;
const uint ELEMENT_IDEAL_LENS = 4u;
const uint ELEMENT_DETECTOR = 5u;
const uint ELEMENT_BARREL = 6u;   // an absorbing tube about z
const uint ELEMENT_ABSORBER = 7u; // absorbs; has facets alone

// An element as it stands in space, for non-sequential tracing. It absorbs around its free aperture (the surface's
// semi-diameter): its mount is the same surface out to rim_radius, and from there the plane z = rim_height.
#define VKFV_ELEMENT_FIELDS(FIELD) \
    FIELD(Surface, surface)    /* in its own frame; its transfer from another is not used */ \
    FIELD(real3, origin)       /* mm, of the element's frame */ \
    FIELD(real3, axis_x)       /* unit vectors */ \
    FIELD(real3, axis_y) \
    FIELD(real3, axis_z) \
    FIELD(real, rim_radius)    /* mm */ \
    FIELD(real, rim_height) \
    FIELD(real, outer_radius)  /* mm, of the mount or of a barrel */ \
    FIELD(real, barrel_length) /* mm, along z */ \
    FIELD(real, transmittance) /* transmittance of a splitter; its reflectance is the surface's */ \
    FIELD(uint, kind)          /* ELEMENT_* */
struct Element {
    VKFV_ELEMENT_FIELDS(VKFV_DECLARE)
};

// A flat triangle of an element whose form is a mesh, in the frame that elements stand in.
#define VKFV_FACET_FIELDS(FIELD) \
    FIELD(real3, corner_a) /* mm; of a closed mesh counter-clockwise seen from outside */ \
    FIELD(real3, corner_b) \
    FIELD(real3, corner_c) \
    FIELD(real3, normal)   /* unit, towards the side from which the corners are counter-clockwise */ \
    FIELD(int, element)    /* index of its element */ \
    FIELD(uint, closed)    /* 1: part of a closed mesh, which light meets only from the side that it is on */
struct Facet {
    VKFV_FACET_FIELDS(VKFV_DECLARE)
};

// The nearest element along a ray.
struct ElementHit {
    int index;     // -1: none
    int facet;     // facet of its mesh; -1: the element is no mesh
    real distance; // mm
};

// The place of a path between two meetings.
struct PathPlace {
    int element; // element that the path comes from; -1: none, or a mesh
    int facet;   // facet that the path comes from; -1: none
    int inside;  // element of the closed mesh that the path is in; -1: none
};

// The frame of the source in space, in mm and unit vectors.
#define VKFV_SOURCE_FRAME_FIELDS(FIELD) \
    FIELD(real3, origin) \
    FIELD(real3, axis_x) \
    FIELD(real3, axis_y) \
    FIELD(real3, axis_z)
struct SourceFrame {
    VKFV_SOURCE_FRAME_FIELDS(VKFV_DECLARE)
};

const uint PATTERN_GRATING = 0u;
const uint PATTERN_CHECKERBOARD = 1u;
const uint PATTERN_STAR = 2u;
const uint PATTERN_GRID = 3u; // points are an image's pixels, or noise

// A pattern of factors over a plane (pattern.glsl): the specimen's reflectance with FEATURE_REFLECTANCE_MAP, the light
// in the plane of the field stop with FEATURE_LIGHT_FIELD.
#define VKFV_PATTERN_FIELDS(FIELD) \
    FIELD(real, lowest)   /* factors, of the pattern's values 0 and 1 */ \
    FIELD(real, highest) \
    FIELD(real, centre_x) /* the pattern's origin, mm */ \
    FIELD(real, centre_y) \
    FIELD(real, axis_x)   /* unit vector along the pattern's x */ \
    FIELD(real, axis_y) \
    FIELD(real, per_mm)   /* periods of a grating, squares of a checkerboard, points of a grid; a star's: 1 */ \
    FIELD(int, cycles)    /* periods of a star in one turn */ \
    FIELD(int, columns)   /* points of a grid along x */ \
    FIELD(int, rows) \
    FIELD(uint, square)   /* 1: a grating or star of two levels, 0: sinusoidal */ \
    FIELD(uint, of_light) /* grid that the pattern reads: 1 the light field's, 0 the specimen's */ \
    FIELD(uint, kind)     /* PATTERN_* */
struct Pattern {
    VKFV_PATTERN_FIELDS(VKFV_DECLARE)
};

// The light that the plane of the illumination's field stop lets through (light_field.glsl), in the frame of that
// surface.
#define VKFV_LIGHT_FIELD_FIELDS(FIELD) \
    FIELD(Pattern, pattern) \
    FIELD(real, falloff)     /* 1/mm^2, factor of the squared distance from the brightest place */ \
    FIELD(real, brightest_x) /* mm */ \
    FIELD(real, brightest_y)
struct LightField {
    VKFV_LIGHT_FIELD_FIELDS(VKFV_DECLARE)
};

// The optical chain of source, trains and detector, without the specimen and the scan's position. Its gate (the
// acceptance bound) is the pupil's outline, made linear and wide enough that no ray outside it reaches the detector:
//   |gate_position * (x, y) + gate_slope * (dx/dz, dy/dz)| <= gate_radius,  x, y in mm on the specimen's top plane.
#define VKFV_INSTRUMENT_FIELDS(FIELD) \
    FIELD(real, source_radius)       /* mm, a flat Lambertian disc */ \
    FIELD(real, source_half_width)   /* mm, a rectangle in its place: along x of the source's frame */ \
    FIELD(real, source_half_height)  /* along y */ \
    FIELD(real, source_distance)     /* mm, from the source to the first vertex of the illumination train */ \
    FIELD(real, emission_sine)       /* sine of the cone of aimed directions (source.glsl); 1: the hemisphere */ \
    FIELD(real, emission_shift)      /* 1/mm, shift of the cone's middle with the place; 0 for a ring light */ \
    FIELD(real, emission_half_width) /* half-sides of a rectangle in its place; emission_sine: of its corners */ \
    FIELD(real, emission_half_height) \
    FIELD(real, magnification)       /* lateral, signed: detector over object */ \
    FIELD(real, detector_distance)   /* mm, from the last vertex of the imaging train to the detector */ \
    FIELD(real, detector_half_width)  /* mm, along x */ \
    FIELD(real, detector_half_height) /* mm, along y */ \
    FIELD(real, image_distortion)    /* 1/mm^2, see image_distortion.glsl */ \
    FIELD(real, image_shear)         /* a ratio of lengths */ \
    FIELD(real, gate_position) \
    FIELD(real, gate_slope) \
    FIELD(real, gate_radius) \
    FIELD(real, spectrum_centre)     /* 1/um^2, value of 1/lambda^2 at x = 0 */ \
    FIELD(real, spectrum_half_width) /* 1/um^2, half-width of the spectrum, x = 1 */ \
    FIELD(real, specimen_index)      /* index of the medium over the specimen, at x = 0 */ \
    FIELD(Dispersion, specimen_dispersion) \
    FIELD(RingLight, ring) \
    FIELD(LightField, light_field) \
    FIELD(int, spectral_bins) \
    FIELD(int, illumination_first)   /* indices into the surfaces */ \
    FIELD(int, illumination_count) \
    FIELD(int, imaging_first) \
    FIELD(int, imaging_count) \
    FIELD(real, pixel_reach)         /* half the side of a pixel's sensitive part, in pixels; 1: all is sensitive */ \
    FIELD(int, detector_columns)     /* pixels, which are square */ \
    FIELD(int, detector_rows)
struct Instrument {
    VKFV_INSTRUMENT_FIELDS(VKFV_DECLARE)
};

const uint SPECIMEN_FACETS = 0u;   // a height field of triangles: each cell split from (i, j) to (i+1, j+1)
const uint SPECIMEN_MESH = 1u;     // any triangles
const uint SPECIMEN_ANALYTIC = 2u; // the continuous function of surface_function.glsl

const uint SHAPE_PLANE = 0u;
const uint SHAPE_STEP = 1u;
const uint SHAPE_SPHERE = 2u;
const uint SHAPE_SINUSOID = 3u;
const uint SHAPE_CHIRP = 4u;

const int LOBE_TABLE_SIZE = 16;

// A lobe of a material's scatter; shaders/physics/scatter/ has the models.
#define VKFV_LOBE_FIELDS(FIELD, ARRAY) \
    FIELD(uint, model)                  /* SCATTER_* */ \
    FIELD(real, weight)                 /* share of the incident light */ \
    FIELD(real, parameter_0) \
    FIELD(real, parameter_1) \
    FIELD(real, parameter_2) \
    FIELD(real, parameter_3) \
    /* what the host works out of the parameters, where the model says so */ \
    ARRAY(real, table, LOBE_TABLE_SIZE)
struct Lobe {
    VKFV_LOBE_FIELDS(VKFV_DECLARE, VKFV_DECLARE_ARRAY)
};

// The weights' sum is the reflectance, at most 1; the rest is absorbed. Unused lobes have the weight 0.
#define VKFV_MATERIAL_FIELDS(FIELD) \
    FIELD(Lobe, lobe_0) \
    FIELD(Lobe, lobe_1) \
    FIELD(Lobe, lobe_2) \
    FIELD(Lobe, lobe_3)
struct Material {
    VKFV_MATERIAL_FIELDS(VKFV_DECLARE)
};

// The specimen in its own frame: x and y across, +z towards the objective, mm.
#define VKFV_SPECIMEN_RECORD_FIELDS(FIELD) \
    FIELD(real, x_min)             /* footprint */ \
    FIELD(real, y_min) \
    FIELD(real, x_max) \
    FIELD(real, y_max) \
    FIELD(real, bottom)            /* lowest height */ \
    FIELD(real, top)               /* highest height; rays enter through the plane z = top */ \
    FIELD(real, pitch_x)           /* of the height field or lattice; column i stands at x_min + i * pitch_x */ \
    FIELD(real, pitch_y) \
    /* of the analytic function: surface_function.glsl says what each shape means */ \
    FIELD(real, shape_parameter_0) \
    FIELD(real, shape_parameter_1) \
    FIELD(real, shape_parameter_2) \
    FIELD(real, shape_parameter_3) \
    FIELD(real, lipschitz)         /* bound of the analytic function's slope */ \
    FIELD(Material, material) \
    FIELD(Pattern, reflectance) \
    FIELD(int, columns)            /* points of the height field or lattice; 0 x 0: none */ \
    FIELD(int, rows) \
    FIELD(int, max_bounces)        /* scatter events permitted */ \
    FIELD(int, material_spectral_points) /* with FEATURE_SPECTRAL_MATERIAL, at least 2 */ \
    FIELD(uint, kind)              /* SPECIMEN_* */ \
    FIELD(uint, shape)             /* SHAPE_* */
struct SpecimenRecord {
    VKFV_SPECIMEN_RECORD_FIELDS(VKFV_DECLARE)
};

// Quantities that change from image to image.
#define VKFV_EXPOSURE_FIELDS(FIELD) \
    FIELD(real, top_distance)          /* mm, along the axis from the objective's front vertex to the top plane */ \
    FIELD(uint, seed) \
    FIELD(uint, image) \
    FIELD(real, focal_height)          /* mm, of the focal plane in the specimen frame: z of the image */ \
    FIELD(real, top_distance_residual) /* mm, what rounding took from top_distance; 0 in double */ \
    FIELD(real, beside_x)              /* mm, displacement of the specimen from its place on the axis */ \
    FIELD(real, beside_y) \
    FIELD(real, magnification_change)  /* share by which the magnification exceeds that at z = 0 */
struct Exposure {
    VKFV_EXPOSURE_FIELDS(VKFV_DECLARE)
};

// A ray's meeting with the specimen (specimen frame).
struct Hit {
    uint found;    // 1: met, 0: not
    real distance; // mm along the ray, whose direction is a unit vector
    real3 position;
    real3 normal; // unit, on the side of +z for height fields and analytic surfaces, against the ray for meshes
};

const uint SURVIVOR_TO_TEST = 1u; // occlusion by the specimen is not yet tested
const uint SURVIVOR_TWIN = 2u;    // counts nowhere if occluded, since its path's own light went on
const uint SURVIVOR_BESIDE = 4u;  // its path's own light is counted in full elsewhere
const int SURVIVOR_WEIGHT_BIT = 3;
const uint WEIGHT_ONE = 0x400000u; // weights are multiples of 2^-22, so that their sums do not depend on the order

// Light that leaves the specimen towards the objective, between the two halves of the forward trace.
#define VKFV_SURVIVOR_FIELDS(FIELD) \
    FIELD(real3, position)   /* specimen frame, on the specimen */ \
    FIELD(real, direction_x) /* unit; z is recomputed, positive */ \
    FIELD(real, direction_y) \
    FIELD(real, spectral)    /* spectral coordinate of its Light in the imaging train */ \
    FIELD(real, survival) \
    /* SURVIVOR_*, and with directed scatter its weight / 2^-22 from SURVIVOR_WEIGHT_BIT on */ \
    FIELD(uint, mark)
struct Survivor {
    VKFV_SURVIVOR_FIELDS(VKFV_DECLARE)
};

// clang-format on

// The end of a path, and the slot of the ledger that counts it.
struct Fate {
    uint status; // PATH_*
    int surface; // index into the surfaces for the statuses that belong to one, else -1
};
