// Traversal of height fields and analytic surfaces, mostly met from above: a ray jumps over empty space, and close to
// the surface it walks from cell to cell. The length of a jump is read off ceilings: a block of 2^level x 2^level cells
// has as its ceiling the highest point of the block and of its eight neighbours. From anywhere in the block a ray is
// free down to the ceiling or until it is a block's side further across, whichever comes first
// (after maximum mipmaps, A. Tevs, I. Ihrke, H.-P. Seidel, "Maximum mipmaps for fast, accurate, and scalable dynamic
// height field rendering", I3D 2008; with the neighbours, no border of blocks need be met). In a cell the side of the
// surface that the ray was on is known, and a meeting is a change of side: no rounding at the border of two facets can
// lose it.

layout(set = 0, binding = BINDING_CEILINGS, scalar) readonly buffer Ceilings {
    CeilingsHeader ceilings_header;
    real ceilings[]; // mm
};

// A height field has two points of a column at each step, (i, j) and (i, j+1), so that a cell takes two neighbouring
// loads.
layout(set = 0, binding = BINDING_HEIGHTS, scalar) readonly buffer Columns { real2 column_steps[]; };

// True if some cells are split from (i+1, j) to (i, j+1) instead of from (i, j) to (i+1, j+1): cells for which the last
// bit of (i, j)'s height is set. Such a cell is met as its mirror image in x.
layout(constant_id = CONSTANT_FALLING_CELLS) const bool has_falling_cells = false;

// Number of cells walked before jumps are tried again.
const int CELLS_AHEAD = 16;

// Heights of a cell's corners: (i, j), (i+1, j), (i, j+1), (i+1, j+1).
vec4 cell_corners(ivec2 cell) {
    int first = cell.y * specimen.columns + cell.x;
    real2 left = column_steps[first];
    real2 right = column_steps[first + 1];
    return vec4(left.x, right.x, left.y, right.y);
}

// Height of the facets at fractions of the cell; lower_right: the triangle with the corner (i+1, j).
real facet_height(vec4 corners, real2 fraction, bool lower_right) {
    real2 f = clamp(fraction, real2(0.0, 0.0), real2(1.0, 1.0));
    return corners.x + (lower_right ? f.x * (corners.y - corners.x) + f.y * (corners.w - corners.y)
                                    : f.x * (corners.w - corners.z) + f.y * (corners.z - corners.x));
}

// A ray over the grid of cells, by its distance t in mm.
struct GridRay {
    ivec2 cells;                 // size of the grid
    real2 per_mm;                // cells/mm
    real2 place;                 // cells, at t = 0
    real2 speed;                 // cells/mm
    real2 slowness;              // mm/cell, finite
    real to_next_cell;           // mm, lower bound of the way to one cell further along x or y
    real drift_slowness;         // mm, to move one cell across the diagonals
    real falling_drift_slowness; // mm, the same for a mirrored cell
    ivec2 forward;               // 1: towards larger columns, larger rows
    real height;                 // mm
    real rise;                   // mm/mm
    real inverse_rise;
};

GridRay grid_ray(real3 start, real3 direction, real inverse_rise) {
    GridRay ray;
    ray.cells = ivec2(ceilings_header.cells_x, ceilings_header.cells_y);
    ray.per_mm = real2(ceilings_header.per_x, ceilings_header.per_y);
    ray.place = real2(start.x - specimen.x_min, start.y - specimen.y_min) * ray.per_mm;
    ray.speed = direction.xy * ray.per_mm;
    // A slower ray moves by less than a cell in 1e9 mm; the bound keeps its inverse finite.
    bvec2 moves = greaterThan(abs(ray.speed), real2(1e-9, 1e-9));
    ray.slowness = real2(moves.x ? real(1.0) / ray.speed.x : real(1e9), moves.y ? real(1.0) / ray.speed.y : real(1e9));
    ray.forward = ivec2(ray.slowness.x >= real(0.0) ? 1 : 0, ray.slowness.y >= real(0.0) ? 1 : 0);
    real drift = ray.speed.x - ray.speed.y;
    ray.drift_slowness = real(1.0) / (abs(drift) > real(1e-9) ? drift : real(1e-9));
    real falling_drift = -ray.speed.x - ray.speed.y;
    ray.falling_drift_slowness = real(1.0) / (abs(falling_drift) > real(1e-9) ? falling_drift : real(1e-9));
    ray.height = start.z;
    ray.rise = direction.z;
    ray.inverse_rise = inverse_rise;
    // The bound is short of a cell by far more than the rounding of a place.
    ray.to_next_cell = real(0.98) * min(abs(ray.slowness.x), abs(ray.slowness.y));
    return ray;
}

ivec2 cell_at(GridRay ray, real t) { return clamp(ivec2(ray.place + t * ray.speed), ivec2(0, 0), ray.cells - 1); }

struct Jump {
    real t;    // the ray is free until there
    bool over; // the ray is above the ceiling where it starts
    bool open; // the ray ends the jump by leaving the block, not by reaching the ceiling
};

Jump jump_over(GridRay ray, real t, int level, int columns, int first) {
    ivec2 block = cell_at(ray, t) >> level;
    real ceiling = ceilings[first + block.y * columns + block.x];
    real further = t + ray.to_next_cell * real(1 << level);
    real to_ceiling = ray.rise < real(0.0) ? (ceiling - ray.height) * ray.inverse_rise : further;
    Jump jump;
    jump.over = ray.height + t * ray.rise > ceiling;
    jump.open = jump.over && to_ceiling >= further;
    jump.t = jump.over ? max(t, min(further, to_ceiling)) : t;
    return jump;
}

// A ray over one cell, in cells from its corner, and the cell's corners; both mirrored in x if the cell falls.
struct CellRay {
    vec4 corners;
    real2 place;
    real2 speed;
    real2 slowness;
    ivec2 forward;
    real drift_slowness;
    bool mirrored;
};

CellRay ray_over_cell(GridRay ray, ivec2 cell) {
    CellRay over;
    over.corners = cell_corners(cell);
    over.place = ray.place - real2(cell);
    over.speed = ray.speed;
    over.slowness = ray.slowness;
    over.forward = ray.forward;
    over.drift_slowness = ray.drift_slowness;
    over.mirrored = has_falling_cells && (floatBitsToUint(over.corners.x) & 1u) != 0u;
    if (over.mirrored) {
        over.corners = over.corners.yxwz;
        over.place.x = real(1.0) - over.place.x;
        over.speed.x = -over.speed.x;
        over.slowness.x = -over.slowness.x;
        over.forward.x = 1 - over.forward.x;
        over.drift_slowness = ray.falling_drift_slowness;
    }
    return over;
}

// State of a ray on its way from cell to cell.
struct CellWalk {
    real t;
    real side;      // 1: above the surface, -1: below, 0: not yet known
    bool under_way; // false: the facet is found or the ray has left
    bool found;
    ivec2 cell; // the cell with the facet, once found
    real from;  // start of the way within that facet
    real to;
};

// Walks along the facets of at most CELLS_AHEAD cells.
void walk_cells(inout CellWalk walk, GridRay ray, real stop) {
    for (int k = 0; k < CELLS_AHEAD && walk.under_way; ++k) {
        CellRay over = ray_over_cell(ray, walk.cell);
        vec4 corners = over.corners;
        real2 local = over.place;
        if (walk.side == real(0.0)) {
            real2 at = local + walk.t * over.speed;
            bool above = ray.height + walk.t * ray.rise > facet_height(corners, at, at.x >= at.y);
            walk.side = above ? real(1.0) : real(-1.0);
        }
        real2 to_border = (real2(over.forward) - local) * over.slowness;
        bool cross_x = to_border.x <= to_border.y;
        real leave = clamp(min(to_border.x, to_border.y), walk.t, stop);
        // Height over the diagonal, where both facets have the same height.
        real middle = (local.y - local.x) * over.drift_slowness;
        bool crosses = middle > walk.t && middle < leave;
        real along = clamp(local.x + middle * over.speed.x, real(0.0), real(1.0));
        real gap_middle = ray.height + middle * ray.rise - (corners.x + along * (corners.w - corners.x));
        // Height over the border, which the next cell sees alike. A ray that stops short of it does so above or below
        // all.
        real2 ends =
            cross_x ? (over.forward.x == 1 ? corners.yw : corners.xz) : (over.forward.y == 1 ? corners.zw : corners.xy);
        along = clamp(cross_x ? local.y + leave * over.speed.y : local.x + leave * over.speed.x, real(0.0), real(1.0));
        real gap_leave = ray.height + leave * ray.rise - (ends.x + along * (ends.y - ends.x));
        bool in_first = crosses && walk.side * gap_middle <= real(0.0);
        walk.found = in_first || walk.side * gap_leave <= real(0.0);
        walk.from = in_first || !crosses ? walk.t : middle;
        walk.to = in_first ? middle : leave;
        ivec2 step = cross_x ? ivec2(2 * ray.forward.x - 1, 0) : ivec2(0, 2 * ray.forward.y - 1);
        walk.cell = walk.found ? walk.cell : walk.cell + step;
        bool inside = uint(walk.cell.x) < uint(ray.cells.x) && uint(walk.cell.y) < uint(ray.cells.y);
        walk.under_way = !walk.found && inside && leave < stop;
        walk.t = leave;
        VKFV_LEAVE_IF(!walk.under_way);
    }
}

// The hit of the facet that the walk has found.
Hit facet_hit(CellWalk walk, GridRay ray, real3 start, real3 direction) {
    Hit hit;
    CellRay over = ray_over_cell(ray, walk.cell);
    vec4 corners = over.corners;
    real2 local = over.place;
    real2 centre = local + real(0.5) * (walk.from + walk.to) * over.speed;
    bool lower_right = centre.x >= centre.y;
    real gap_from = walk.side * (ray.height + walk.from * ray.rise -
                                 facet_height(corners, local + walk.from * over.speed, lower_right));
    real gap_to = walk.side *
                  (ray.height + walk.to * ray.rise - facet_height(corners, local + walk.to * over.speed, lower_right));
    gap_from = max(gap_from, real(0.0));
    real total = gap_from + max(-gap_to, real(0.0));
    real meeting = total > real(0.0) ? walk.from + (walk.to - walk.from) * (gap_from / total) : walk.from;
    hit.found = 1u;
    hit.position = real3(start.x + meeting * direction.x, start.y + meeting * direction.y,
                         facet_height(corners, local + meeting * over.speed, lower_right));
    real2 rise = lower_right ? real2(corners.y - corners.x, corners.w - corners.y)
                             : real2(corners.w - corners.z, corners.z - corners.x);
    rise.x = over.mirrored ? -rise.x : rise.x;
    hit.normal = normalize(real3(-rise * ray.per_mm, real(1.0)));
    hit.distance = meeting;
    return hit;
}

Hit specimen_hit(real3 origin, real3 direction) {
    real rounding = specimen_rounding();
    real upper = specimen.top + rounding;
    real lower = specimen.bottom - rounding;
    bool down = direction.z < real(0.0);
    // The origin is moved to the specimen's top, as in cut_to_specimen().
    real inverse_rise = real(1.0) / (abs(direction.z) > real(1e-12) ? direction.z : real(1e-12));
    bool from_top = down && origin.z >= specimen.top;
    real advance = from_top ? (upper - origin.z) * inverse_rise : real(0.0);
    real3 start =
        real3(origin.x + advance * direction.x, origin.y + advance * direction.y, from_top ? upper : origin.z);
    GridRay ray = grid_ray(start, direction, inverse_rise);
    real2 to_first = -ray.place * ray.slowness;
    real2 to_last = (real2(ray.cells) - ray.place) * ray.slowness;
    real2 enters = min(to_first, to_last);
    real2 leaves = max(to_first, to_last);
    real stop = min(((down ? lower : upper) - start.z) * ray.inverse_rise, min(leaves.x, leaves.y));
    CellWalk walk;
    walk.t = max(real(0.0), max(enters.x, enters.y));
    bool beside = walk.t > real(0.0);
    walk.side = beside ? real(0.0) : real(1.0);
    // A ray that rises faster than the surface anywhere leaves it.
    bool escapes = !beside && direction.z > ceilings_header.steepest * length(direction.xy);
    walk.under_way = walk.t <= stop && !escapes && specimen_kind != SPECIMEN_MESH;
    walk.found = false;
    walk.cell = ivec2(0, 0);
    walk.from = walk.t;
    walk.to = walk.t;
    Hit hit = no_hit();
    // Each round walks at least one cell.
    for (int rounds = ray.cells.x + ray.cells.y + 8; walk.under_way && rounds > 0; --rounds) {
        bool free = walk.side >= real(0.0);
        while (free) {
            Jump coarse = jump_over(ray, walk.t, ceilings_header.coarse_level, ceilings_header.coarse_columns,
                                    ceilings_header.coarse_first);
            Jump fine = jump_over(ray, coarse.t, ceilings_header.fine_level, ceilings_header.fine_columns, 0);
            walk.t = fine.t;
            walk.side = fine.over ? real(1.0) : walk.side;
            free = fine.open && walk.t < stop;
            VKFV_LEAVE_IF(!free);
        }
        walk.under_way = walk.t <= stop;
        if (specimen_kind == SPECIMEN_ANALYTIC && walk.under_way) {
            // A ray from beside may be below the surface, so the march covers all of the ray to know its side.
            real ahead = beside ? stop : min(stop, walk.t + ray.to_next_cell * real(CELLS_AHEAD));
            hit = march_surface(specimen, start, direction, beside ? real(0.0) : walk.t, ahead);
            walk.found = hit.found == 1u;
            walk.under_way = !walk.found && ahead < stop;
            walk.t = ahead;
        }
        if (specimen_kind == SPECIMEN_FACETS) {
            walk.cell = cell_at(ray, walk.t);
            walk_cells(walk, ray, stop);
        }
        VKFV_LEAVE_IF(!walk.under_way);
    }
    if (specimen_kind == SPECIMEN_FACETS && walk.found) {
        hit = facet_hit(walk, ray, start, direction);
    }
    hit.distance = max(hit.distance + advance, real(0.0));
    return hit;
}
