// Light sorted by where it crosses the pupil, for what diffraction makes of it afterwards
// (optics/waves/pupil_filter.hpp): a square grid of cells over the exit pupil as the detector sees it, and in every
// cell an image whose pixels are parted so finely that it can hold all that light waves resolve. Opposite cells stay
// apart: what aberration does to the phase of one is the opposite in the other.
// clang-format off
#define VKFV_PUPIL_CELLS_FIELDS(FIELD) \
    FIELD(uint, side)             /* cells across the pupil, an even number; 0: light is not sorted */ \
    FIELD(uint, parts)            /* of a pixel's side */ \
    FIELD(real, sensitive_side)   /* share of a pixel's side; the parts' light is taken as even over each */ \
    FIELD(real, chief_x)          /* slope of the chief ray that lands on the detector's middle */ \
    FIELD(real, chief_y) \
    FIELD(real, chief_position)   /* 1/mm: how the chief ray's slope grows with its position there */ \
    FIELD(real, per_slope)        /* 1 over the largest slope about the chief ray */
struct PupilCells {
    VKFV_PUPIL_CELLS_FIELDS(VKFV_DECLARE)
};
// clang-format on

VKFV_FUNCTION uint pupil_cell_count(PupilCells cells) { return cells.side * cells.side; }

// about_chief: slope dx/dz, dy/dz of light that arrives at the detector, less the chief ray's. Light from outside the
// grid belongs to the cell at its edge.
VKFV_FUNCTION uint pupil_cell(PupilCells cells, real2 about_chief) {
    real half_side = real(0.5) * real(cells.side);
    int last = int(cells.side) - 1;
    int column = clamp(int(floor((about_chief.x * cells.per_slope + real(1.0)) * half_side)), 0, last);
    int row = clamp(int(floor((about_chief.y * cells.per_slope + real(1.0)) * half_side)), 0, last);
    return uint(row) * cells.side + uint(column);
}

// slope: of the chief ray that lands on this position of the detector, mm.
VKFV_FUNCTION real2 chief_slope(PupilCells cells, real2 position) {
    return real2(cells.chief_x, cells.chief_y) + position * cells.chief_position;
}

// Which part of a pixel: of a coordinate in pixels.
VKFV_FUNCTION int pixel_part(PupilCells cells, real within) {
    return clamp(int(floor(within * real(cells.parts))), 0, int(cells.parts) - 1);
}

// The share of a part's width that is sensitive, where the pixel is sensitive on this share of its side, in its middle.
VKFV_FUNCTION real sensitive_share(PupilCells cells, uint part) {
    real from = real(0.5) * (real(1.0) - cells.sensitive_side) * real(cells.parts);
    real to = real(0.5) * (real(1.0) + cells.sensitive_side) * real(cells.parts);
    return clamp(min(to, real(part) + real(1.0)) - max(from, real(part)), real(0.0), real(1.0));
}

// A cell, and the part of a pixel in its image.
struct CellPlace {
    uint cell;
    int column; // of parts, over the whole image
    int row;
};
