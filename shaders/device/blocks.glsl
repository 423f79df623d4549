// What else host and kernels of the trace share, in scalar layout: push constants, the heads of buffers, and what the
// kernels give and take that are no part of the trace.

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

// Pushed: some of an image's paths.
struct Batch {
    uvec2 first_path; // low and high word
    uint count;
};

// Pushed: the same of non-sequential paths.
struct NonsequentialBatch {
    Batch paths;
    uint elements_root; // of their tree of boxes
    SourceFrame source_frame;
};

#if defined(__cplusplus) || defined(VKFV_BACKWARD)
// The uniform block of backward paths.
struct BackwardBlock {
    BackwardOptics optics;
    Lattice lattice;
};

// Pushed: chunks of the pixels' lattices, those of one number after another, each in the order of the pixels.
struct BackwardBatch {
    uint first_chunk;
    uint first_pixel; // whose first_chunk is the first
    uint chunks;      // pixels and numbers together
    uint chunk_points;
    uint randomisation;
};
#endif

// Of a height field's or an analytic surface's ceilings, which follow: specimen_quadtree.glsl.
struct CeilingsHeader {
    int cells_x; // cells with a surface
    int cells_y;
    real per_x; // cells/mm
    real per_y;
    real steepest;    // the surface's slope is nowhere larger
    int fine_level;   // its blocks come first, row-major
    int fine_columns; // blocks
    int coarse_level;
    int coarse_columns;
    int coarse_first; // index of the coarse level's first ceiling
};

// trace_rays.comp: given rays through one of the trains and on to a plane behind it.
struct TrainPassage {
    uint count; // rays
    uint apertures;
    uint form; // SHORT_TRAIN_*, with apertures; 0: trace_train()
    int first_surface;
    int surfaces;
    real index;
    real plane; // mm, from the last vertex
};
struct TracedRay {
    real3 position; // on the plane, z unused
    real3 direction;
    real path_length;
    uint status;
    int surface;
};

// probe_paths.comp: how and where one path ended.
struct PathEnd {
    uint status;
    int surface;
    real x; // mm, as Detection, for light that left the specimen through the gate (of meaning if it arrived), else 0
    real y;
    real weight; // of the light at x and y
};

// probe_hits.comp, which gives a Hit of each.
struct ProbeRay {
    real3 origin;
    real3 direction;
};

// time_hits.comp: what it pushes, and where rays that leave the specimen start.
struct TimedHits {
    uint count;
    uint seed;
    real aperture;    // sine of the cone's half-angle
    uint strata_bits; // points lie in 2^strata_bits strata a side, in Morton order; 0: anywhere
};
struct TimedStart {
    real3 position;
    real3 normal;
};
