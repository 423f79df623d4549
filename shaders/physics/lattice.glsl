// Points of a randomly shifted rank-1 lattice (J. Dick, F. Y. Kuo, I. H. Sloan, "High-dimensional integration: the
// quasi-Monte Carlo way", Acta Numerica 22 (2013), section 5): point i of n stands at the fractions of i z_d / n +
// shift_d.
// clang-format off
#define VKFV_LATTICE_FIELDS(FIELD) \
    FIELD(uint, size_bits) /* n = 2^size_bits */ \
    FIELD(uint, z_0) \
    FIELD(uint, z_1) \
    FIELD(uint, z_2) \
    FIELD(uint, z_3) \
    FIELD(uint, z_4) \
    FIELD(uint, z_5) \
    FIELD(uint, z_6) \
    FIELD(uint, z_7)
struct Lattice {
    VKFV_LATTICE_FIELDS(VKFV_DECLARE)
};
// clang-format on

// The lattice's shifts in its eight dimensions, in units of 2^-32.
struct LatticeShift {
    uvec4 first;
    uvec4 second;
};

// The shift of one randomisation for one pixel of one image. The 2 keeps its counters apart from those of paths.
VKFV_FUNCTION LatticeShift lattice_shift(uint seed, uint image, uint pixel, uint randomisation) {
    LatticeShift shift;
    shift.first = philox_4x32(uvec4(pixel, randomisation, 0u, 2u), seed, image, PHILOX_ROUNDS);
    shift.second = philox_4x32(uvec4(pixel, randomisation, 1u, 2u), seed, image, PHILOX_ROUNDS);
    return shift;
}

// A coordinate in (0, 1) from a point's fraction and its shift, both in units of 2^-32.
VKFV_FUNCTION real shifted_coordinate(uint fraction, uint shift) {
    return (real((fraction + shift) >> 9) + real(0.5)) * real(1.1920928955078125e-7);
}

// A coordinate of a point, by that dimension's z and shift. A lattice with n = 1 has no fraction.
VKFV_FUNCTION real lattice_coordinate(Lattice lattice, uint point, uint z, uint shift) {
    return shifted_coordinate(lattice.size_bits == 0u ? 0u : (point * z) << (32u - lattice.size_bits), shift);
}

// Two coordinates for a lattice of every period-th point alone, which might be a poor lattice: the k-th of n such
// points has k / n and k times the golden ratio. In another order, or as multiples of two irrational numbers, they
// leave more noise.
VKFV_FUNCTION real2 sparse_coordinates(Lattice lattice, uint point, uint period, uint shift_0, uint shift_1) {
    return real2(lattice_coordinate(lattice, point, 1u, shift_0),
                 shifted_coordinate(point / period * 2654435769u, shift_1));
}
