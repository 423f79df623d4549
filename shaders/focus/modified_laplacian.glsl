// Modified Laplacian: second differences whose signs cannot cancel. S. K. Nayar and Y. Nakagawa, "Shape from focus",
// 1994. It is blind to linear gradients of brightness.

VKFV_SCENE_FUNCTION real modified_laplacian(VKFV_SCENE_PARAMETER FocusPlan plan, int channel, int column, int row) {
    real twice = real(2.0) * image_value(VKFV_SCENE channel, column, row);
    return abs(twice - neighbour(VKFV_SCENE plan, channel, column - 1, row) -
               neighbour(VKFV_SCENE plan, channel, column + 1, row)) +
           abs(twice - neighbour(VKFV_SCENE plan, channel, column, row - 1) -
               neighbour(VKFV_SCENE plan, channel, column, row + 1));
}
