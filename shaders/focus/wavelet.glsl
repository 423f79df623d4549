// Wavelets: the energy of the three detail bands of one level. G. Yang and B. J. Nelson, "Wavelet-based autofocusing
// and unsupervised segmentation of microscopic images", 2003; not decimated, so that a shift of the image only shifts
// the measure, and by the symmetric filters of five and three taps of D. Le Gall and A. Tabatabai, "Sub-band coding of
// digital images using symmetric short kernel filters and arithmetic coding techniques", 1988, so that it has no side.

VKFV_FUNCTION real wavelet_low(int tap) { // -2 ... 2
    int distance = abs(tap);
    return distance == 0 ? real(0.75) : (distance == 1 ? real(0.25) : real(-0.125));
}

VKFV_FUNCTION real wavelet_high(int tap) {
    int distance = abs(tap);
    return distance == 0 ? real(1.0) : (distance == 1 ? real(-0.5) : real(0.0));
}

VKFV_SCENE_FUNCTION real wavelet_energy(VKFV_SCENE_PARAMETER FocusPlan plan, int channel, int column, int row) {
    real low_high = real(0.0); // low along x, high along y
    real high_low = real(0.0);
    real high_high = real(0.0);
    for (int j = -2; j <= 2; ++j) {
        real low = real(0.0);
        real high = real(0.0);
        for (int i = -2; i <= 2; ++i) {
            real value = neighbour(VKFV_SCENE plan, channel, column + i, row + j);
            low = low + wavelet_low(i) * value;
            high = high + wavelet_high(i) * value;
        }
        low_high = low_high + wavelet_high(j) * low;
        high_low = high_low + wavelet_low(j) * high;
        high_high = high_high + wavelet_high(j) * high;
    }
    return low_high * low_high + high_low * high_low + high_high * high_high;
}
