// A centred train in light of one wavelength as polynomials of the ray that enters it, instead of surface by surface.
// Let a ray have the place r and the direction's part s across the axis, counted from some multiple of r. A train of
// revolution maps it to sums of those two vectors, with factors that depend on u = r.r, v = r.s and w = s.s alone; so
// do the squares of its distances from the axis at the surfaces. The factors are polynomials (M. B. Hullin, J. Hanika,
// W. Heidrich, "Polynomial optics", Computer Graphics Forum 31 (2012) 1375). Near an edge they cannot decide: such
// light is traced. src/optics/instrument/train_polynomials.hpp finds them and their errors.

const int POLYNOMIAL_DEGREE = 5; // highest degree
const int POLYNOMIAL_TERMS = 56;
const int POLYNOMIAL_EDGES = 6;

// The sum of terms u^i v^j w^k, i + j + k <= degree, which stand in the order of i, then j, then k, as if the degree
// were the highest; terms beyond it are 0.
struct Polynomial {
    int degree;
    real terms[POLYNOMIAL_TERMS];
};

// Horner's scheme in w, in v, in u. It is written out, as constants fold only where each term has a place of its own.
// clang-format off
#define VKFV_STEP(order, x, more, term) ((order) < p.degree ? (more) * x + (term) : (term))
#define VKFV_ROW_0(order, n) p.terms[n]
#define VKFV_ROW_1(order, n) VKFV_STEP(order, w, VKFV_ROW_0(order + 1, n + 1), p.terms[n])
#define VKFV_ROW_2(order, n) VKFV_STEP(order, w, VKFV_ROW_1(order + 1, n + 1), p.terms[n])
#define VKFV_ROW_3(order, n) VKFV_STEP(order, w, VKFV_ROW_2(order + 1, n + 1), p.terms[n])
#define VKFV_ROW_4(order, n) VKFV_STEP(order, w, VKFV_ROW_3(order + 1, n + 1), p.terms[n])
#define VKFV_ROW_5(order, n) VKFV_STEP(order, w, VKFV_ROW_4(order + 1, n + 1), p.terms[n])
#define VKFV_SHEET_0(order, n) p.terms[n]
#define VKFV_SHEET_1(order, n) VKFV_STEP(order, v, VKFV_SHEET_0(order + 1, n + 2), VKFV_ROW_1(order, n))
#define VKFV_SHEET_2(order, n) VKFV_STEP(order, v, VKFV_SHEET_1(order + 1, n + 3), VKFV_ROW_2(order, n))
#define VKFV_SHEET_3(order, n) VKFV_STEP(order, v, VKFV_SHEET_2(order + 1, n + 4), VKFV_ROW_3(order, n))
#define VKFV_SHEET_4(order, n) VKFV_STEP(order, v, VKFV_SHEET_3(order + 1, n + 5), VKFV_ROW_4(order, n))
#define VKFV_SHEET_5(order, n) VKFV_STEP(order, v, VKFV_SHEET_4(order + 1, n + 6), VKFV_ROW_5(order, n))
// clang-format on
VKFV_FUNCTION real value_of(Polynomial p, real u, real v, real w) {
    real sum = VKFV_SHEET_0(5, 55);
    sum = VKFV_STEP(4, u, sum, VKFV_SHEET_1(4, 52));
    sum = VKFV_STEP(3, u, sum, VKFV_SHEET_2(3, 46));
    sum = VKFV_STEP(2, u, sum, VKFV_SHEET_3(2, 36));
    sum = VKFV_STEP(1, u, sum, VKFV_SHEET_4(1, 21));
    return VKFV_STEP(0, u, sum, VKFV_SHEET_5(0, 0));
}
#undef VKFV_STEP
#undef VKFV_ROW_0
#undef VKFV_ROW_1
#undef VKFV_ROW_2
#undef VKFV_ROW_3
#undef VKFV_ROW_4
#undef VKFV_ROW_5
#undef VKFV_SHEET_0
#undef VKFV_SHEET_1
#undef VKFV_SHEET_2
#undef VKFV_SHEET_3
#undef VKFV_SHEET_4
#undef VKFV_SHEET_5

// An edge that stops light; edges stand in the order in which light comes to them. For light inside all edges before,
// the squared distance from the axis at this one, mm^2, decides between surely inside, surely stopped here, and
// unknown.
struct EdgePolynomial {
    Polynomial distance_squared;
    int surface;       // index in the train, from 0
    real inside_below; // mm^2, inside if the square is less
    real ends_from;    // mm^2, stopped here if the square is from this on
    real ends_below;   // mm^2, and less than this
};

// The map of a ray in the source's frame with a unit direction to the plane z = `plane` behind the train's last vertex.
struct TrainPolynomials {
    int edges;       // number of edges tested; -1: there are no polynomials
    real per_radius; // 1/mm, scale of r: 1 at the source's own radius
    real shift;      // 1/mm: s is the direction less `shift` times the place
    real per_sine;   // scale of s: 1 for the farthest direction that is emitted
    real plane;      // mm
    // The factors of r and of s in the place, mm, and in the direction, which has the length of the index.
    Polynomial place_r;
    Polynomial place_s;
    Polynomial direction_r;
    Polynomial direction_s;
    EdgePolynomial edge[POLYNOMIAL_EDGES];
};

struct PolynomialPassage {
    bool known;  // false: the ray has to be traced
    uint status; // PATH_ALIVE or PATH_VIGNETTED
    int surface; // index in the train of the surface where it ended, else -1
    Ray ray;     // on the plane
};

VKFV_FUNCTION PolynomialPassage meet_edge(PolynomialPassage before, bool there, EdgePolynomial edge, real u, real v,
                                          real w) {
    PolynomialPassage result = before;
    if (there) {
        real square = value_of(edge.distance_squared, u, v, w);
        bool on_its_way = before.status == PATH_ALIVE;
        bool inside = square < edge.inside_below;
        bool ends = square > edge.ends_from && square < edge.ends_below;
        result.known = before.known && (!on_its_way || inside || ends);
        result.status = on_its_way && ends ? PATH_VIGNETTED : before.status;
        result.surface = on_its_way && ends ? edge.surface : before.surface;
    }
    return result;
}

// The status by the edges alone; the ray is not computed.
VKFV_FUNCTION PolynomialPassage meet_edges(TrainPolynomials train, real u, real v, real w) {
    PolynomialPassage passage;
    passage.known = true;
    passage.status = PATH_ALIVE;
    passage.surface = -1;
    passage = meet_edge(passage, train.edges > 0, train.edge[0], u, v, w);
    passage = meet_edge(passage, train.edges > 1, train.edge[1], u, v, w);
    passage = meet_edge(passage, train.edges > 2, train.edge[2], u, v, w);
    passage = meet_edge(passage, train.edges > 3, train.edge[3], u, v, w);
    passage = meet_edge(passage, train.edges > 4, train.edge[4], u, v, w);
    passage = meet_edge(passage, train.edges > 5, train.edge[5], u, v, w);
    return passage;
}

// Passes a ray through the train by its polynomials. index: of the medium behind the train.
VKFV_FUNCTION PolynomialPassage pass_by_polynomials(TrainPolynomials train, Ray ray, real index) {
    real2 from = real2(ray.position.x, ray.position.y);
    real2 r = from * train.per_radius;
    real2 s = (real2(ray.direction.x, ray.direction.y) - from * train.shift) * train.per_sine;
    real u = dot(r, r);
    real v = dot(r, s);
    real w = dot(s, s);
    PolynomialPassage passage = meet_edges(train, u, v, w);
    real2 place = r * value_of(train.place_r, u, v, w) + s * value_of(train.place_s, u, v, w);
    real2 across = r * value_of(train.direction_r, u, v, w) + s * value_of(train.direction_s, u, v, w);
    passage.ray.position = real3(place.x, place.y, train.plane);
    passage.ray.direction = real3(across.x, across.y, sqrt(max(index * index - dot(across, across), real(0.0))));
    passage.ray.path_length = real(0.0);
    return passage;
}
