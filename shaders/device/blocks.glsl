// Records that host and kernels of the trace share in scalar layout besides physics/records.glsl: push constants, heads
// of buffers, and inputs and outputs of the probes.

// The uniform block of one image.
// clang-format off
#define VKFV_PARAMETERS_FIELDS(FIELD) \
    FIELD(Instrument, instrument) \
    FIELD(SpecimenRecord, specimen) \
    FIELD(Exposure, exposure) \
    FIELD(PupilCells, pupil_cells) \
    FIELD(uvec2, cell_light)              /* address of the table of CellAddress */ \
    FIELD(uvec4, emission_drawn)          /* EmissionCell::drawn */ \
    FIELD(uint, emission_cells)           /* their number */ \
    FIELD(real, emission_cells_per_path)
// clang-format on

// Push constants: a range of an image's paths.
struct Batch {
    uvec2 first_path; // low and high word of the path's number
    uint count;
};

// Push constants: a range of an image's non-sequential paths.
struct NonsequentialBatch {
    Batch paths;
    uint elements_root; // root of the elements' tree of boxes, a node index
    SourceFrame source_frame;
};

#if defined(__cplusplus) || defined(VKFV_BACKWARD)
// The uniform block of backward paths.
struct BackwardBlock {
    BackwardOptics optics;
    Lattice lattice;
};

// Push constants: chunks of the pixels' lattices. All pixels' chunks of one number stand in the order of the pixels,
// then those of the next number.
struct BackwardBatch {
    uint first_chunk;
    uint first_pixel; // pixel with which the range begins, in its chunk first_chunk
    uint chunks;      // in the range, over pixels and chunk numbers
    uint chunk_points;
    uint randomisation;
};
#endif

// Head of the buffer of ceilings of a height field or an analytic surface; the ceilings follow it
// (specimen_quadtree.glsl).
struct CeilingsHeader {
    int cells_x; // cells with a surface
    int cells_y;
    real per_x; // cells/mm
    real per_y;
    real steepest;    // upper bound of the slope of the surface
    int fine_level;   // its blocks come first, row-major
    int fine_columns; // blocks
    int coarse_level;
    int coarse_columns;
    int coarse_first; // index of the coarse level's first ceiling
};

// trace_rays.comp: passage of given rays through one of the trains to a plane behind it.
struct TrainPassage {
    uint count; // number of rays
    uint apertures;
    uint form; // SHORT_TRAIN_*, with apertures; 0: trace_train()
    int first_surface;
    int surfaces;
    real index;
    real plane; // mm, z of the plane from the last vertex
};
struct TracedRay {
    real3 position; // on the plane, z unused
    real3 direction;
    real path_length;
    uint status;
    int surface;
};

// probe_paths.comp: the end of one path.
struct PathEnd {
    uint status;
    int surface;
    real x; // mm, as Detection, for light that left the specimen through the gate (has a meaning only if it arrived),
            // else 0
    real y;
    real weight; // weight of the light at x and y
};

// probe_hits.comp: a ray, of which the kernel finds the Hit.
struct ProbeRay {
    real3 origin;
    real3 direction;
};

// time_hits.comp: its push constants, and the points at which rays leave the specimen.
struct TimedHits {
    uint count;
    uint seed;
    real aperture;    // sine of the cone's half-angle
    uint strata_bits; // points are stratified in 2^strata_bits strata a side, in Morton order; 0: not stratified
};
struct TimedStart {
    real3 position;
    real3 normal;
};
