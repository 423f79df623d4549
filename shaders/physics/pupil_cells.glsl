// Pupil cells: light is sorted by where it crosses the pupil, so that diffraction can be applied to it afterwards
// (optics/waves/pupil_filter.hpp). The cells are a square grid over the exit pupil as the detector sees it; each has an
// image whose pixels are divided finely enough for all detail that diffraction leaves. Opposite cells stay apart, since
// an aberration shifts their phases in opposite ways.
// clang-format off
#define VKFV_PUPIL_CELLS_FIELDS(FIELD) \
    FIELD(uint, side)             /* cells across the pupil, an even number; 0: light is not sorted */ \
    FIELD(uint, parts)            /* parts that a pixel's side is divided into */ \
    FIELD(real, sensitive_side)   /* share of a pixel's side; the parts' light is taken as even over each */ \
    FIELD(real, chief_x)          /* slope of the chief ray that lands on the detector's middle */ \
    FIELD(real, chief_y) \
    FIELD(real, chief_position)   /* 1/mm: growth of the chief ray's slope with its position on the detector */ \
    FIELD(real, per_slope)        /* 1 over the largest slope about the chief ray */
struct PupilCells {
    VKFV_PUPIL_CELLS_FIELDS(VKFV_DECLARE)
};
// clang-format on

VKFV_FUNCTION uint pupil_cell_count(PupilCells cells) { return cells.side * cells.side; }

// Index of a pupil cell. about_chief: slope dx/dz, dy/dz of light that arrives at the detector, less the chief ray's.
// Light from outside the grid belongs to the cell at its edge.
VKFV_FUNCTION uint pupil_cell(PupilCells cells, real2 about_chief) {
    real half_side = real(0.5) * real(cells.side);
    int last = int(cells.side) - 1;
    int column = clamp(int(floor((about_chief.x * cells.per_slope + real(1.0)) * half_side)), 0, last);
    int row = clamp(int(floor((about_chief.y * cells.per_slope + real(1.0)) * half_side)), 0, last);
    return uint(row) * cells.side + uint(column);
}

// Slope of the chief ray that lands on this position of the detector. position: mm.
VKFV_FUNCTION real2 chief_slope(PupilCells cells, real2 position) {
    return real2(cells.chief_x, cells.chief_y) + position * cells.chief_position;
}

// Index of the part of a pixel at a coordinate within it, in pixels.
VKFV_FUNCTION int pixel_part(PupilCells cells, real within) {
    return clamp(int(floor(within * real(cells.parts))), 0, int(cells.parts) - 1);
}

// The share of a part's width that is sensitive, where the pixel's sensitive part is in its middle.
VKFV_FUNCTION real sensitive_share(PupilCells cells, uint part) {
    real from = real(0.5) * (real(1.0) - cells.sensitive_side) * real(cells.parts);
    real to = real(0.5) * (real(1.0) + cells.sensitive_side) * real(cells.parts);
    return clamp(min(to, real(part) + real(1.0)) - max(from, real(part)), real(0.0), real(1.0));
}

// A pupil cell, and a part of a pixel in its image.
struct CellPlace {
    uint cell;
    int column; // part of a pixel, counted over the whole image
    int row;
};
