// Bindings (set 0) and push constants of the kernels that compute wave images from light sorted by pupil cells; the
// host binds them in trace/device/device_wave_image.hpp.

const uint WAVES_BINDING_PLANES = 0u; // complex, two planes a group of cells
const uint WAVES_BINDING_TABLE = 1u; // the cells' transfer functions: at each node those of a window's filters together
const uint WAVES_BINDING_SPECTRUM =
    2u; // of the image, two complex numbers a frequency: at (l, m) and (-l, m); filter after filter
const uint WAVES_BINDING_IMAGE =
    3u; // complex, the images with their mirror images: two filters a plane, one real and one imaginary
const uint WAVES_BINDING_PIXELS = 4u;
const uint WAVES_BINDING_TABLES = 5u; // the transfer functions of all tiles of the field, one tile after the other

// Some groups of cells, each of four that are mirror images.
struct WaveGroups {
    uvec2 light;        // address of a table of the addresses of the cells' images
    uint image_columns; // parts of pixels, of the whole image
    uint first_column;  // of the window, in which some filters are blended
    uint first_row;
    uint columns;
    uint rows;
    uint cells_side; // cells across the pupil
    uint first;      // group
    uint count;
    uint steps;          // of the table, from 0 to the cutoff
    real steps_a_column; // the table's for each 1 / (2 columns) cycles a part
    real steps_a_row;    // for each 1 / (2 rows)
};

struct WaveTables {
    uint nodes;  // of all cells' transfer functions together
    uvec4 tiles; // of the field, whose filters a window blends
};

struct WaveSize {
    uint columns; // parts of pixels, of the window
    uint rows;
    PupilCells cells;
    uint image_columns; // pixels, of the whole image
    uint first_column;  // of the window
    uint first_row;
    TileRamp along;
    TileRamp up;
};

const uint WAVES_CONSTANT_FILTERS = 0u; // how many are blended in a window: 1 or 4
