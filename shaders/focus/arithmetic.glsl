// Division, root, logarithm and exponential of the evaluation in float, made only of sums, products and the bits of a
// number: these are rounded alike everywhere, where a device's own division may be 2.5 units in the last place off
// (Vulkan, "Precision and Operation of SPIR-V Instructions"). So host and device give the same bits. Their results are
// within two units in the last place of the exact ones, for numbers that are no nearer to the ends of float's range
// than 2^-100 and 2^100.

// a / b by Newton's iteration for 1 / b, which doubles the digits of a first guess from the exponent's bits.
VKFV_FUNCTION real quotient(real a, real b) {
    real size = abs(b);
    real inverse = intBitsToFloat(0x7ef311c7 - floatBitsToInt(size)); // off by 12 % at most
    for (int step = 0; step < 4; ++step) {
        inverse = inverse + inverse * (real(1.0) - size * inverse);
    }
    real magnitude = a * inverse;
    magnitude = magnitude + inverse * (a - magnitude * size);
    return b < real(0.0) ? -magnitude : magnitude;
}

// The root of a >= 0 by Newton's iteration for 1 / sqrt(a).
VKFV_FUNCTION real root(real a) {
    real inverse = intBitsToFloat(0x5f3759df - (floatBitsToInt(a) >> 1)); // off by 3.5 % at most
    for (int step = 0; step < 3; ++step) {
        inverse = inverse + inverse * (real(0.5) - (real(0.5) * a * inverse) * inverse);
    }
    real result = a * inverse;
    return result + real(0.5) * inverse * (a - result * result);
}

// 2 artanh t = ln((1 + t) / (1 - t)) by its series, for |t| < 0.172: the first term left out is 5E-10 of the value.
VKFV_FUNCTION real twice_artanh(real t) {
    real s = t * t;
    return real(2.0) * t *
           (real(1.0) + s * (real(1.0 / 3.0) +
                             s * (real(0.2) + s * (real(1.0 / 7.0) + s * (real(1.0 / 9.0) + s * real(1.0 / 11.0))))));
}

// ln a for a > 0: the exponent's part, and the series for the rest, which lies between the roots of 1/2 and of 2.
VKFV_FUNCTION real natural_log(real a) {
    int bits = floatBitsToInt(a);
    int exponent = (bits - 0x3f3504f3) >> 23; // the bits of sqrt(1/2)
    real fraction = intBitsToFloat(bits - exponent * 0x00800000);
    real places = real(exponent);
    // ln 2 in two parts, the first of which leaves room for the product's digits.
    return places * real(0.693359375) +
           (twice_artanh(quotient(fraction - real(1.0), fraction + real(1.0))) - places * real(2.12194440e-4));
}

// exp a for a <= 88; 0 below 2^-125.
VKFV_FUNCTION real exponential(real a) {
    real places = floor(a * real(1.44269504) + real(0.5));
    real rest = (a - places * real(0.693359375)) + places * real(2.12194440e-4); // within ln(2) / 2
    real series =
        real(1.0) +
        rest * (real(1.0) +
                rest * (real(0.5) + rest * (real(1.0 / 6.0) +
                                            rest * (real(1.0 / 24.0) +
                                                    rest * (real(1.0 / 120.0) +
                                                            rest * (real(1.0 / 720.0) + rest * real(1.0 / 5040.0)))))));
    return places < real(-125.0) ? real(0.0) : series * intBitsToFloat((int(places) + 127) * 0x00800000);
}
