// Polynomials of the illumination as constants of the kernel; DeviceScene gives the values.
layout(constant_id = CONSTANT_POLYNOMIAL_EDGES) const int known_edges = -1; // -1: no polynomials
layout(constant_id = CONSTANT_POLYNOMIAL_PER_RADIUS) const real known_per_radius = real(1);
layout(constant_id = CONSTANT_POLYNOMIAL_SHIFT) const real known_shift = real(0);
layout(constant_id = CONSTANT_POLYNOMIAL_PER_SINE) const real known_per_sine = real(1);
layout(constant_id = CONSTANT_POLYNOMIAL_PLANE) const real known_plane = real(0);

// clang-format off
#define VKFV_EACH_TERM(M, p) \
    M(p, 0) M(p, 1) M(p, 2) M(p, 3) M(p, 4) M(p, 5) M(p, 6) M(p, 7) M(p, 8) M(p, 9) M(p, 10) M(p, 11) M(p, 12) \
    M(p, 13) M(p, 14) M(p, 15) M(p, 16) M(p, 17) M(p, 18) M(p, 19) M(p, 20) M(p, 21) M(p, 22) M(p, 23) M(p, 24) \
    M(p, 25) M(p, 26) M(p, 27) M(p, 28) M(p, 29) M(p, 30) M(p, 31) M(p, 32) M(p, 33) M(p, 34) M(p, 35) M(p, 36) \
    M(p, 37) M(p, 38) M(p, 39) M(p, 40) M(p, 41) M(p, 42) M(p, 43) M(p, 44) M(p, 45) M(p, 46) M(p, 47) M(p, 48) \
    M(p, 49) M(p, 50) M(p, 51) M(p, 52) M(p, 53) M(p, 54) M(p, 55)
// clang-format on

#define VKFV_DECLARE_TERM(p, n) \
    layout(constant_id = CONSTANT_POLYNOMIALS + KNOWN_POLYNOMIAL_CAPACITY * p + n) const real term_##p##_##n = real(0);
#define VKFV_KNOW_TERM(p, n) known.terms[n] = term_##p##_##n;
#define VKFV_DECLARE_OF_POLYNOMIAL(p, place, type, name) \
    layout(constant_id = CONSTANT_POLYNOMIALS + KNOWN_POLYNOMIAL_CAPACITY * p + place) const type name##_##p = type(0);
#define VKFV_DECLARE_POLYNOMIAL(p) \
    VKFV_DECLARE_OF_POLYNOMIAL(p, KNOWN_DEGREE, int, degree) \
    VKFV_EACH_TERM(VKFV_DECLARE_TERM, p) \
    Polynomial known_polynomial_##p() { \
        Polynomial known; \
        known.degree = degree_##p; \
        VKFV_EACH_TERM(VKFV_KNOW_TERM, p) \
        return known; \
    }
#define VKFV_DECLARE_EDGE(p) \
    VKFV_DECLARE_POLYNOMIAL(p) \
    VKFV_DECLARE_OF_POLYNOMIAL(p, KNOWN_EDGE_SURFACE, int, edge_surface) \
    VKFV_DECLARE_OF_POLYNOMIAL(p, KNOWN_EDGE_INSIDE_BELOW, real, inside_below) \
    VKFV_DECLARE_OF_POLYNOMIAL(p, KNOWN_EDGE_ENDS_FROM, real, ends_from) \
    VKFV_DECLARE_OF_POLYNOMIAL(p, KNOWN_EDGE_ENDS_BELOW, real, ends_below) \
    EdgePolynomial known_edge_##p() { \
        EdgePolynomial known; \
        known.distance_squared = known_polynomial_##p(); \
        known.surface = edge_surface_##p; \
        known.inside_below = inside_below_##p; \
        known.ends_from = ends_from_##p; \
        known.ends_below = ends_below_##p; \
        return known; \
    }

VKFV_DECLARE_POLYNOMIAL(0)
VKFV_DECLARE_POLYNOMIAL(1)
VKFV_DECLARE_POLYNOMIAL(2)
VKFV_DECLARE_POLYNOMIAL(3)
VKFV_DECLARE_EDGE(4)
VKFV_DECLARE_EDGE(5)
VKFV_DECLARE_EDGE(6)
VKFV_DECLARE_EDGE(7)
VKFV_DECLARE_EDGE(8)
VKFV_DECLARE_EDGE(9)

TrainPolynomials known_illumination() {
    TrainPolynomials known;
    known.edges = known_edges;
    known.per_radius = known_per_radius;
    known.shift = known_shift;
    known.per_sine = known_per_sine;
    known.plane = known_plane;
    known.place_r = known_polynomial_0();
    known.place_s = known_polynomial_1();
    known.direction_r = known_polynomial_2();
    known.direction_s = known_polynomial_3();
    known.edge[0] = known_edge_4();
    known.edge[1] = known_edge_5();
    known.edge[2] = known_edge_6();
    known.edge[3] = known_edge_7();
    known.edge[4] = known_edge_8();
    known.edge[5] = known_edge_9();
    return known;
}
