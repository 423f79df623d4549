// Cosine and sine of an angle in turns, by sums and products alone: Vulkan lets a device's own be off by 2^-11. Within
// 2e-7.

VKFV_FUNCTION real2 turned(real turns) {
    real quarter = floor(real(4.0) * turns + real(0.5)); // the nearest quarter of a turn
    real angle = (turns - real(0.25) * quarter) * real(6.28318531);
    real square = angle * angle;
    // Taylor's series within an eighth of a turn.
    real sine =
        angle * (real(1.0) +
                 square * (real(-1.0 / 6.0) + square * (real(1.0 / 120.0) + square * (real(-1.0 / 5040.0) +
                                                                                      square * real(1.0 / 362880.0)))));
    real cosine =
        real(1.0) +
        square * (real(-0.5) + square * (real(1.0 / 24.0) +
                                         square * (real(-1.0 / 720.0) +
                                                   square * (real(1.0 / 40320.0) - square * real(1.0 / 3628800.0)))));
    int place = int(quarter - real(4.0) * floor(real(0.25) * quarter));
    return place == 0   ? real2(cosine, sine)
           : place == 1 ? real2(-sine, cosine)
           : place == 2 ? real2(-cosine, -sine)
                        : real2(sine, -cosine);
}
