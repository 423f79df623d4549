// Stateless random numbers: Philox4x32, J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel random numbers:
// as easy as 1, 2, 3", SC11 (2011), doi:10.1145/2063384.2063405. A draw is a function of (seed, image, path, block), so
// host and device trace the same path and any path can be replayed alone.

// Seven rounds pass all of TestU01's BigCrush (the same paper, table 2); the authors' ten are their margin.
const int PHILOX_ROUNDS = 7;

VKFV_FUNCTION uvec4 philox_4x32(uvec4 counter, uint key_0, uint key_1, int rounds) {
    for (int round = 0; round < rounds; ++round) {
        uint high_0 = multiply_high(0xD2511F53u, counter.x);
        uint low_0 = 0xD2511F53u * counter.x;
        uint high_1 = multiply_high(0xCD9E8D57u, counter.z);
        uint low_1 = 0xCD9E8D57u * counter.z;
        counter = uvec4(high_1 ^ counter.y ^ key_0, low_1, high_0 ^ counter.w ^ key_1, low_0);
        key_0 += 0x9E3779B9u;
        key_1 += 0xBB67AE85u;
    }
    return counter;
}

// Six independent numbers, uniform in (0, 1).
struct Draws {
    real u0;
    real u1;
    real u2;
    real u3;
    real u4;
    real u5;
};

// 21 bits to the middle of one of 2^21 equal cells: exact in float, never 0 or 1.
VKFV_FUNCTION real uniform_from_21_bits(uint bits) {
    return (real(bits & 0x1FFFFFu) + real(0.5)) * real(4.76837158203125e-7);
}

// 128 bits cut into six numbers of 21.
VKFV_FUNCTION Draws draws_of_bits(uvec4 bits) {
    Draws draws;
    draws.u0 = uniform_from_21_bits(bits.x);
    draws.u1 = uniform_from_21_bits(bits.y);
    draws.u2 = uniform_from_21_bits(bits.z);
    draws.u3 = uniform_from_21_bits(bits.w);
    draws.u4 = uniform_from_21_bits((bits.x >> 21) | ((bits.y >> 21) << 11));
    draws.u5 = uniform_from_21_bits((bits.z >> 21) | ((bits.w >> 21) << 11));
    return draws;
}

// A path's random numbers of one block; its blocks are 0, 1, 2, ...
VKFV_FUNCTION Draws draw(uint seed, uint image, uvec2 path, uint block) {
    return draws_of_bits(philox_4x32(uvec4(path.x, path.y, block, 0u), seed, image, PHILOX_ROUNDS));
}
