// The image that is evaluated, seen by pixels and their neighbours.

#ifdef __cplusplus
template <class Scene>
real image_value(const Scene& scene, int channel, int column, int row) {
    return scene.image_value(channel, column, row);
}
#else
real image_value(int channel, int column, int row); // the kernel's bindings say where images are kept
#endif

// Mirrors an index at the border; the outermost pixels lie on the mirror's line.
VKFV_FUNCTION int mirrored(int k, int count) {
    int folded = k < 0 ? -k : (k >= count ? 2 * (count - 1) - k : k);
    return min(max(folded, 0), count - 1); // a single row or column has no neighbour but itself
}

VKFV_SCENE_FUNCTION real neighbour(VKFV_SCENE_PARAMETER FocusPlan plan, int channel, int column, int row) {
    return image_value(VKFV_SCENE channel, mirrored(column, plan.columns), mirrored(row, plan.rows));
}

// The mean over the channels.
VKFV_SCENE_FUNCTION real brightness_at(VKFV_SCENE_PARAMETER FocusPlan plan, int column, int row) {
    real sum = real(0.0);
    for (int channel = 0; channel < plan.channels; ++channel) {
        sum = sum + image_value(VKFV_SCENE channel, column, row);
    }
    return quotient(sum, real(plan.channels));
}
