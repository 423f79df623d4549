// Tenengrad: the squared gradient by Sobel's operators. J. M. Tenenbaum, "Accommodation in computer vision", 1970; E.
// Krotkov, "Focusing", 1987. There is no threshold, since the noise of a pixel is judged on its whole curve.

VKFV_SCENE_FUNCTION real tenengrad_energy(VKFV_SCENE_PARAMETER FocusPlan plan, int channel, int column, int row) {
    real along_x = real(0.0);
    real along_y = real(0.0);
    for (int side = -1; side <= 1; ++side) {
        real weight = side == 0 ? real(2.0) : real(1.0);
        along_x = along_x + weight * (neighbour(VKFV_SCENE plan, channel, column + 1, row + side) -
                                      neighbour(VKFV_SCENE plan, channel, column - 1, row + side));
        along_y = along_y + weight * (neighbour(VKFV_SCENE plan, channel, column + side, row + 1) -
                                      neighbour(VKFV_SCENE plan, channel, column + side, row - 1));
    }
    return along_x * along_x + along_y * along_y;
}
