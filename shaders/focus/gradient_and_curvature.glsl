// Gradient and curvature: first differences along x and y as Sobel's operators take them, with second differences of
// the same weights across at half their energy. First differences pass frequencies that the optics resolve best and
// little of a camera's noise, second differences finer texture, of which a window has more grains. The response is
// gathered as a magnitude, in which a bright grain counts less than in an energy: a window's height is then nearer to
// that of its whole surface.

VKFV_SCENE_FUNCTION real gradient_and_curvature_energy(VKFV_SCENE_PARAMETER FocusPlan plan, int channel, int column,
                                                       int row) {
    real left = real(0.0);
    real middle = real(0.0);
    real right = real(0.0);
    real below = real(0.0);
    real level = real(0.0);
    real above = real(0.0);
    for (int side = -1; side <= 1; ++side) {
        real weight = side == 0 ? real(2.0) : real(1.0);
        left = left + weight * neighbour(VKFV_SCENE plan, channel, column - 1, row + side);
        middle = middle + weight * neighbour(VKFV_SCENE plan, channel, column, row + side);
        right = right + weight * neighbour(VKFV_SCENE plan, channel, column + 1, row + side);
        below = below + weight * neighbour(VKFV_SCENE plan, channel, column + side, row - 1);
        level = level + weight * neighbour(VKFV_SCENE plan, channel, column + side, row);
        above = above + weight * neighbour(VKFV_SCENE plan, channel, column + side, row + 1);
    }
    real along_x = right - left;
    real along_y = above - below;
    real bend_x = real(2.0) * middle - left - right;
    real bend_y = real(2.0) * level - below - above;
    return along_x * along_x + along_y * along_y + real(0.5) * (bend_x * bend_x + bend_y * bend_y);
}
