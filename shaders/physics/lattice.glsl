// Points of an embedded rank-1 lattice in base 2, randomly shifted (J. Dick, F. Y. Kuo, I. H. Sloan, "High-dimensional
// integration: the quasi-Monte Carlo way", Acta Numerica 22 (2013), section 5): every run of 2^k points that starts at a
// multiple of 2^k is a shifted lattice of 2^k points, so a path needs no more than its index, and their number may grow.
// The generator was searched component by component for the least P2 error, with weights 0.9^j, over 2^5 to 2^14 points
// at once.
const uint LATTICE_DIMENSIONS = 12u;
#ifdef __cplusplus
inline constexpr uint lattice_generator[12] = {
    1u, 9937u, 14971u, 5153u, 11037u, 4649u, 10271u, 7731u, 2869u, 13763u, 7855u, 14181u};
#else
const uint lattice_generator[12] = uint[12](
    1u, 9937u, 14971u, 5153u, 11037u, 4649u, 10271u, 7731u, 2869u, 13763u, 7855u, 14181u);
#endif

// The shift of one dimension per component.
struct LatticeShift {
    uvec4 first;
    uvec4 second;
    uvec4 third;
};

// Of `randomisation`, for one pixel of one image. The 2 keeps its counters apart from those of paths.
VKFV_FUNCTION LatticeShift lattice_shift(uint seed, uint image, uint pixel, uint randomisation) {
    LatticeShift shift;
    shift.first = philox_4x32_10(uvec4(pixel, randomisation, 0u, 2u), seed, image);
    shift.second = philox_4x32_10(uvec4(pixel, randomisation, 1u, 2u), seed, image);
    shift.third = philox_4x32_10(uvec4(pixel, randomisation, 2u, 2u), seed, image);
    return shift;
}

// In (0, 1). radical_inverse: the bits of the point's index in reverse order.
VKFV_FUNCTION real lattice_coordinate(uint radical_inverse, uint dimension, uint shift) {
    uint bits = radical_inverse * lattice_generator[dimension] + shift;
    return (real(bits >> 9) + real(0.5)) * real(1.1920928955078125e-7);
}
