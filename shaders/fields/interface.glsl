// Records that the host and the kernels of an interferometer's fields share. Buffers are reached by their addresses.

const uint FIELDS_WORKGROUP = 128u;
const uint FIELDS_FRAMES = 8u;        // images that an invocation makes at a time
const uint FIELDS_EDGE_PARTS = 64u;   // heights of a cell with an edge
const uint FIELDS_BINDING_WAVES = 0u; // planes of complex numbers, node by node

// The grid, its surface, and a batch of wave numbers whose planes are made.
struct FieldBatch {
    uint64_t points;   // address: of each point its height (mm), slopes along x and y, and amplitude, float
    uint64_t edges;    // address: of each edge its point, uint
    uint64_t heights;  // address: FIELDS_EDGE_PARTS heights of each edge, mm, float
    uint64_t transfer; // address: of each step of frequency the factors of all nodes, vec2
    uint64_t pixels;   // address: of each node the pixels' means, vec2
    uint columns;
    uint rows;
    uint edge_count;
    uint first; // node of the first plane
    uint planes;
    uint nodes;           // of all
    uint steps;           // of frequency
    float first_turns;    // turns of a wave a mm, q_z / (2 pi), of node 0
    float turns;          // from node to node
    float steps_a_column; // steps of the transfer from one frequency of the grid's lines to the next
    float steps_a_row;
    float pitch;  // mm
    float tilt_x; // slopes of the reference mirror
    float tilt_y;
    uint pixel_columns;
    uint pixel_rows;
    uint parts;
    uint margin_x;
    uint margin_y;
    float centre_x; // column and row of the field's middle
    float centre_y;
};

// The images of a group of focal heights.
struct FieldFrames {
    uint64_t fields;     // address: FieldBatch::pixels
    uint64_t phases;     // address: of each node the cosine and the sine of each of FIELDS_FRAMES images, vec2
    uint64_t background; // address: float, W
    uint64_t images;     // address: of each image its pixels, float, W
    uint pixels;
    uint nodes;
    uint frames;  // of this group, at most FIELDS_FRAMES
    float signal; // W
};
