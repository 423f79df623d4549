// Brenner's measure: squared differences of pixels two apart, here along x and along y, and placed at the pixel between
// them. J. F. Brenner, B. S. Dew, J. B. Horton, T. King, P. W. Neurath and W. D. Selles, "An automated microscope for
// cytologic research: a preliminary evaluation", 1976.

VKFV_SCENE_FUNCTION real brenner_energy(VKFV_SCENE_PARAMETER FocusPlan plan, int channel, int column, int row) {
    real along_x =
        neighbour(VKFV_SCENE plan, channel, column + 1, row) - neighbour(VKFV_SCENE plan, channel, column - 1, row);
    real along_y =
        neighbour(VKFV_SCENE plan, channel, column, row + 1) - neighbour(VKFV_SCENE plan, channel, column, row - 1);
    return along_x * along_x + along_y * along_y;
}
