// Bindings (set 0) and push constants of the kernels that compute wave images from light sorted by pupil cells; the
// host binds them in trace/device/device_wave_image.hpp.

const uint WAVES_BINDING_PLANES = 0u; // complex, two planes a group of cells
const uint WAVES_BINDING_TABLE = 1u;  // cells' transfer functions, at each node all of a window's filters
const uint WAVES_BINDING_SPECTRUM =
    2u; // image's spectrum, two complex numbers a frequency: at (l, m) and (-l, m); filter after filter
const uint WAVES_BINDING_IMAGE =
    3u; // complex, the images with their mirror images: two filters a plane, one real and one imaginary
const uint WAVES_BINDING_PIXELS = 4u;
const uint WAVES_BINDING_TABLES = 5u; // the transfer functions of all tiles of the field, one tile after the other

// Push constants: a range of groups of cells, each of four that are mirror images.
struct WaveGroups {
    uvec2 light;        // address of a table of the addresses of the cells' images
    uint image_columns; // parts of pixels across the whole image
    uint first_column;  // parts of pixels before the window, in which some filters are blended
    uint first_row;
    uint columns;
    uint rows;
    uint cells_side; // cells across the pupil
    uint first;      // index of the first group
    uint count;
    uint steps;          // nodes of the table from 0 to the cutoff
    real steps_a_column; // nodes of the table for each 1 / (2 columns) cycles a part
    real steps_a_row;    // nodes of the table for each 1 / (2 rows) cycles a part
};

struct WaveTables {
    uint nodes;  // number of nodes of all cells' transfer functions together
    uvec4 tiles; // indices of the field's tiles whose filters a window blends
};

struct WaveSize {
    uint columns; // parts of pixels across the window
    uint rows;
    PupilCells cells;
    uint image_columns; // pixels across the whole image
    uint first_column;  // pixels before the window
    uint first_row;
    TileRamp along;
    TileRamp up;
};

const uint WAVES_CONSTANT_FILTERS = 0u; // number of filters blended in a window: 1 or 4
