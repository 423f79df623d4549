// Height fields and analytic surfaces by a pyramid of minima and maxima over their cells: the ray goes from block to
// block of 2^level cells, up a level where it leaves the larger block too and down where its heights overlap the
// block's (A. Tevs, I. Ihrke, H.-P. Seidel, "Maximum mipmaps for fast, accurate, and scalable dynamic height field
// rendering", I3D 2008). In a cell the side of the surface that the ray was on is known, and a meeting is a change of
// side: no rounding at the border of two facets can lose it.

// PyramidHeader and pyramid of src/trace/pyramid.hpp.
layout(set = 0, binding = 9, scalar) readonly buffer Pyramid {
    int pyramid_cells_x; // cells with a surface
    int pyramid_cells_y;
    int pyramid_padded_x; // multiples of 2^top_level
    int pyramid_padded_y;
    int pyramid_top_level;
    real pyramid_cell_x; // mm
    real pyramid_cell_y;
    real pyramid_unused;
    real2 pyramid_ranges[]; // (lowest, highest) height, mm; level by level from the finest, row-major
};

real2 pyramid_range(ivec2 block, int level, uint padded_cells) {
    // Levels 0 to level - 1 hold (4/3) (n - n / 4^level) ranges. A division by 3 without remainder is a product with
    // the inverse of 3 modulo 2^32.
    uint first = 4u * ((padded_cells - (padded_cells >> (2 * level))) * 0xAAAAAAABu);
    return pyramid_ranges[first + uint(block.y * (pyramid_padded_x >> level) + block.x)];
}

// Heights of a cell's corners: (i, j), (i+1, j), (i, j+1), (i+1, j+1).
vec4 cell_corners(ivec2 cell) {
    int first = cell.y * specimen.columns + cell.x;
    return vec4(heights[first], heights[first + 1], heights[first + specimen.columns],
                heights[first + specimen.columns + 1]);
}

// Height of the facets at fractions of the cell; lower_right: the triangle with the corner (i+1, j).
real facet_height(vec4 corners, real2 fraction, bool lower_right) {
    real2 f = clamp(fraction, real2(0.0, 0.0), real2(1.0, 1.0));
    return corners.x + (lower_right ? f.x * (corners.y - corners.x) + f.y * (corners.w - corners.y)
                                    : f.x * (corners.w - corners.z) + f.y * (corners.z - corners.x));
}

Hit specimen_hit(real3 origin, real3 direction) {
    SpecimenRay ray = cut_to_specimen(origin, direction, specimen_rounding(), real(0.0));
    real3 start = ray.origin;
    real stop = ray.over.stop;
    real t = ray.over.start;

    // Across, in cells.
    real2 cell_size = real2(pyramid_cell_x, pyramid_cell_y);
    real2 place = real2(start.x - specimen.x_min, start.y - specimen.y_min) / cell_size;
    real2 speed = direction.xy / cell_size;
    // Slower than this is less than a cell in 1e9 mm, and its inverse is finite.
    bvec2 moves = greaterThan(abs(speed), real2(1e-9, 1e-9));
    real2 slowness = real2(moves.x ? real(1.0) / speed.x : real(0.0), moves.y ? real(1.0) / speed.y : real(0.0));
    real2 never = real2(moves.x ? real(0.0) : real(3e37), moves.y ? real(0.0) : real(3e37));
    ivec2 forward = ivec2(speed.x >= real(0.0) ? 1 : 0, speed.y >= real(0.0) ? 1 : 0);
    real fall = direction.z < real(0.0) ? real(1.0) / direction.z : real(0.0);
    ivec2 cells = ivec2(pyramid_cells_x, pyramid_cells_y);
    uint padded_cells = uint(pyramid_padded_x) * uint(pyramid_padded_y);
    int top_level = pyramid_top_level;

    ivec2 cell = clamp(ivec2(floor(place + t * speed)), ivec2(0, 0), cells - 1);
    // Blocks about as large as the ray is long across.
    real across = max(abs(speed.x), abs(speed.y)) * (stop - t);
    int level = clamp(findMSB(uint(clamp(across, real(0.0), real(1e6)))) + 1, 0, top_level);

    real side = ray.beside ? real(0.0) : real(1.0); // of the surface: above, below (-1), not yet known
    bool found = false;
    bool lower_right = true;
    real meeting = t;
    Hit hit = no_hit();
    bool under_way = t <= stop && specimen_kind != SPECIMEN_MESH;
    // Each step but a descent crosses a border of the grid, and each ascent is a crossing too.
    for (int steps = 2 * (cells.x + cells.y + top_level) + 8; under_way && steps > 0; --steps) {
        ivec2 block = cell >> level;
        real2 range = pyramid_range(block, level, padded_cells);
        ivec2 border = (block + forward) << level;
        real2 to_border = (real2(border) - place) * slowness + never;
        real leave = clamp(min(to_border.x, to_border.y), t, stop);
        // Going down, nothing is met before the block's highest point.
        real enter = max(t, (range.y - start.z) * fall);
        real height_enter = start.z + t * direction.z;
        real height_leave = start.z + leave * direction.z;
        bool overlaps = enter <= leave && min(height_enter, height_leave) <= range.y &&
                        max(height_enter, height_leave) >= range.x;
        side = enter > t ? real(1.0) : side;
        ivec2 block_first = block << level;
        ivec2 block_last = block_first + (1 << level) - 1;
        bool marched = false;
        if (overlaps && level > 0) {
            t = enter;
            cell = clamp(ivec2(floor(place + t * speed)), block_first, min(block_last, cells - 1));
            level -= 1;
        } else {
            if (overlaps && specimen_kind == SPECIMEN_FACETS) {
                vec4 corners = cell_corners(cell);
                real2 local = place - real2(cell);
                real to_diagonal = (local.y - local.x) / (speed.x - speed.y);
                bool crosses = to_diagonal > t && to_diagonal < leave;
                real middle = crosses ? to_diagonal : leave;
                real2 first_centre = local + real(0.5) * (t + middle) * speed;
                bool first_lower_right = first_centre.x >= first_centre.y;
                bool last_lower_right = crosses ? !first_lower_right : first_lower_right;
                real gap_enter = height_enter - facet_height(corners, local + t * speed, first_lower_right);
                real gap_middle = start.z + middle * direction.z -
                                  facet_height(corners, local + middle * speed, first_lower_right);
                real gap_leave = height_leave - facet_height(corners, local + leave * speed, last_lower_right);
                side = side != real(0.0) ? side : (gap_enter > real(0.0) ? real(1.0) : real(-1.0));
                bool in_first = side * gap_middle <= real(0.0);
                found = in_first || side * gap_leave <= real(0.0);
                lower_right = in_first ? first_lower_right : last_lower_right;
                real from = in_first ? t : middle;
                real to = in_first ? middle : leave;
                real gap_from = max(side * (in_first ? gap_enter : gap_middle), real(0.0));
                real gap_to = max(-side * (in_first ? gap_middle : gap_leave), real(0.0));
                real total = gap_from + gap_to;
                meeting = total > real(0.0) ? from + (to - from) * (gap_from / total) : from;
            } else if (overlaps) {
                // A ray from beside may be below: the march over all of it knows from where it comes.
                marched = ray.beside;
                hit = march_surface(specimen, start, direction, ray.beside ? real(0.0) : t, ray.beside ? stop : leave);
                found = hit.found == 1u;
            } else {
                side = side != real(0.0) ? side : (height_enter > range.y ? real(1.0) : real(-1.0));
            }
            bool cross_x = to_border.x <= to_border.y;
            bool last = min(to_border.x, to_border.y) >= stop;
            t = leave;
            ivec2 next = clamp(ivec2(floor(place + t * speed)), block_first, min(block_last, cells - 1));
            next.x = cross_x ? border.x - 1 + forward.x : next.x;
            next.y = cross_x ? next.y : border.y - 1 + forward.y;
            bool outside = next.x < 0 || next.y < 0 || next.x >= cells.x || next.y >= cells.y;
            under_way = !(found || last || outside || marched);
            cell = found ? cell : next;
            int crossed = cross_x ? border.x : border.y;
            level += ((crossed >> level) & 1) == 0 && level < top_level ? 1 : 0;
        }
    }

    if (specimen_kind == SPECIMEN_FACETS && found) {
        vec4 corners = cell_corners(cell);
        hit.found = 1u;
        hit.position = real3(start.x + meeting * direction.x, start.y + meeting * direction.y,
                             facet_height(corners, place + meeting * speed - real2(cell), lower_right));
        real2 rise = lower_right ? real2(corners.y - corners.x, corners.w - corners.y)
                                 : real2(corners.w - corners.z, corners.z - corners.x);
        hit.normal = normalize(real3(-rise / cell_size, real(1.0)));
        hit.distance = meeting;
    }
    hit.distance = max(hit.distance + ray.advance, real(0.0));
    return hit;
}
