// Records that host and device share, in scalar layout: physics.hpp compiles them in float for the buffers, and
// tests/trace asserts sizes and has a probe kernel echo every field.
// Units: mm, W; directions are unit vectors scaled by the refractive index of the medium they travel in.

// What became of a path. Every path ends with exactly one of these, and the ledger counts each.
const uint PATH_ALIVE = 0u;            // still under way: never a final status
const uint PATH_DETECTED = 1u;         // counted on a pixel
const uint PATH_OFF_SPECIMEN = 2u;     // the illumination passed beside the specimen's footprint
const uint PATH_ESCAPED = 3u;          // left the specimen outside the pupil's gate
const uint PATH_BOUNCE_LIMIT = 4u;     // would have met the specimen more often than permitted
const uint PATH_OFF_DETECTOR = 5u;     // reached the detector's plane beside the detector
const uint PATH_NUMERICAL = 6u;        // a non-finite number or an exhausted rejection loop
const uint PATH_VIGNETTED = 7u;        // stopped by the edge of a surface (a surface index belongs to it)
const uint PATH_MISSED_SURFACE = 8u;   // a surface of a train does not meet the ray (likewise)
const uint PATH_TOTAL_REFLECTION = 9u; // totally reflected at a surface (likewise)
const int PATH_STATUS_COUNT = 10;

const uint SURFACE_CLIPPED = 1u;  // semi_diameter_squared limits it; without the flag it is unbounded
const uint SURFACE_ASPHERIC = 2u; // the even coefficients are not all zero

const int SURFACE_CAPACITY = 128; // surfaces of both trains together that the device's uniform block holds

// One refracting surface or stop, in the frame of its own vertex; light travels towards +z.
// Sag: z = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + a4 r^4 + ... + a16 r^16 (ISO 10110-12, eq. 5).
struct Surface {
    real curvature;             // 1/mm, positive: centre of curvature towards +z
    real conic;                 // conic constant k; 0 is a sphere
    real semi_diameter_squared; // mm^2
    real distance;              // mm, from the previous vertex to this one; a train's first: 0
    real index_before;
    real index_after;
    real a4; // mm^-3 and so on
    real a6;
    real a8;
    real a10;
    real a12;
    real a14;
    real a16;
    uint flags; // SURFACE_*
};

// A ray in some frame; which one the function says.
struct Ray {
    real3 position;   // mm
    real3 direction;  // unit vector times the index of the medium
    real path_length; // optical path so far, mm
};

// The chain that light goes through, but for the specimen and the scan's position.
struct Instrument {
    real source_radius;         // mm, a flat Lambertian disc
    real source_distance;       // mm, from the source to the first vertex of the illumination train
    real emission_sine;         // sine of the half-angle of the cone aimed into; 1 is the whole hemisphere
    real magnification;         // lateral, signed: detector over object
    real detector_distance;     // mm, from the last vertex of the imaging train to the detector
    real detector_half_size;    // mm
    real gate_position;         // gate: |gate_position * (x, y) + gate_slope * (dx/dz, dy/dz)| <= gate_radius,
    real gate_slope;            //   with x, y in mm on the specimen's top plane: the pupil's outline made
    real gate_radius;           //   linear and wide enough that no ray outside it reaches the detector
    int illumination_first;     // indices into the surfaces
    int illumination_count;
    int imaging_first;
    int imaging_count;
    int detector_pixels; // along one side
};

const uint SPECIMEN_FACETS = 0u;   // a height field of triangles: each cell split from (i, j) to (i+1, j+1)
const uint SPECIMEN_MESH = 1u;     // any triangles
const uint SPECIMEN_ANALYTIC = 2u; // the continuous function of surface_function.glsl

const uint SHAPE_PLANE = 0u;
const uint SHAPE_STEP = 1u;
const uint SHAPE_SPHERE = 2u;
const uint SHAPE_SINUSOID = 3u;
const uint SHAPE_CHIRP = 4u;

// The specimen in its own frame: x and y across, +z towards the objective, mm.
struct SpecimenRecord {
    real x_min; // footprint
    real y_min;
    real x_max;
    real y_max;
    real bottom; // lowest height
    real top;    // highest height; rays enter through the plane z = top
    real pitch_x; // of the height field or lattice; column i stands at x_min + i * pitch_x
    real pitch_y;
    real shape_parameter_0; // of the analytic function: surface_function.glsl says what each shape means
    real shape_parameter_1;
    real shape_parameter_2;
    real shape_parameter_3;
    real lipschitz;       // bound of the analytic function's slope
    real scatter_g;       // Henyey-Greenstein asymmetry
    int columns; // points of the height field or lattice; 0 x 0: none
    int rows;
    int max_bounces; // scatter events permitted
    uint kind;  // SPECIMEN_*
    uint shape; // SHAPE_*
};

// What changes from image to image.
struct Exposure {
    real top_distance; // mm, along the axis from the objective's front vertex to the specimen's top plane
    uint seed;
    uint image;
    uint unused; // keeps the record's size a multiple of 16 bytes
};

// Where a ray meets the specimen (specimen frame).
struct Hit {
    uint found;    // 1: met, 0: not
    real distance; // along the ray, mm for a unit direction
    real3 position;
    real3 normal; // unit, on the side of +z for height fields and analytic surfaces, against the ray for meshes
};

// Light that leaves the specimen towards the objective, between the two passes.
struct Survivor {
    real3 position;  // specimen frame, on the specimen
    real direction_x; // unit; z is recomputed, positive
    real direction_y;
    uint test_occlusion; // 1: whether it meets the specimen again is not yet known
};

// How a path ended, and where the ledger counts it.
struct Fate {
    uint status; // PATH_*
    int surface; // index into the surfaces for the statuses that belong to one, else -1
};
