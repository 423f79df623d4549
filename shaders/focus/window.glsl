// The focus measure from the responses: weighted means over the window, first along rows, then along columns, cut off
// at the border. The standard deviation (standard_deviation.glsl) is gathered with them.

struct WindowSums {
    real level;  // mean brightness
    real energy; // mean response; for the standard deviation: variance
};

#ifdef __cplusplus
template <class Scene>
real window_weight(const Scene& scene, int distance) {
    return scene.window_weight(distance);
}
// Brightness (for the standard deviation: of the channel) and response of a field at a pixel.
template <class Scene>
WindowSums window_source(const Scene& scene, int field, int column, int row) {
    return scene.window_source(field, column, row);
}
// The result of window_along_row() at this pixel.
template <class Scene>
WindowSums window_row(const Scene& scene, int field, int column, int row) {
    return scene.window_row(field, column, row);
}
#else
real window_weight(int distance);
WindowSums window_source(int field, int column, int row);
WindowSums window_row(int field, int column, int row);
#endif

VKFV_SCENE_FUNCTION WindowSums window_along_row(VKFV_SCENE_PARAMETER FocusPlan plan, int field, int column, int row) {
    int first = max(-plan.window_radius, -column);
    int last = min(plan.window_radius, plan.columns - 1 - column);
    real total = real(0.0);
    WindowSums sums;
    sums.level = real(0.0);
    sums.energy = real(0.0);
    for (int d = first; d <= last; ++d) {
        real weight = window_weight(VKFV_SCENE abs(d));
        WindowSums source = window_source(VKFV_SCENE field, column + d, row);
        total = total + weight;
        sums.level = sums.level + weight * source.level;
        sums.energy = sums.energy + weight * source.energy;
    }
    sums.level = quotient(sums.level, total);
    if (plan.measure == FOCUS_STANDARD_DEVIATION) {
        sums.energy = real(0.0);
        for (int d = first; d <= last; ++d) {
            real level = window_source(VKFV_SCENE field, column + d, row).level;
            sums.energy = sums.energy + window_weight(VKFV_SCENE abs(d)) * squared_deviation(level, sums.level);
        }
    }
    sums.energy = quotient(sums.energy, total);
    return sums;
}

VKFV_SCENE_FUNCTION WindowSums window_along_column(VKFV_SCENE_PARAMETER FocusPlan plan, int field, int column,
                                                   int row) {
    int first = max(-plan.window_radius, -row);
    int last = min(plan.window_radius, plan.rows - 1 - row);
    real total = real(0.0);
    WindowSums sums;
    sums.level = real(0.0);
    sums.energy = real(0.0);
    for (int d = first; d <= last; ++d) {
        real weight = window_weight(VKFV_SCENE abs(d));
        WindowSums of_row = window_row(VKFV_SCENE field, column, row + d);
        total = total + weight;
        sums.level = sums.level + weight * of_row.level;
        sums.energy = sums.energy + weight * of_row.energy;
    }
    sums.level = quotient(sums.level, total);
    if (plan.measure == FOCUS_STANDARD_DEVIATION) {
        for (int d = first; d <= last; ++d) {
            real level = window_row(VKFV_SCENE field, column, row + d).level;
            sums.energy = sums.energy + window_weight(VKFV_SCENE abs(d)) * squared_deviation(level, sums.level);
        }
    }
    sums.energy = quotient(sums.energy, total);
    return sums;
}

// The focus measure at a pixel: the root of the mean energy over brightness, so that a slowly varying illumination
// cancels. C channels of the same grey give the value of one: their energy is C times as large, and so is C
// brightness^2.
VKFV_SCENE_FUNCTION real focus_value(VKFV_SCENE_PARAMETER FocusPlan plan, int column, int row) {
    int fields = focus_fields(plan);
    real level = real(0.0);
    real energy = real(0.0);
    for (int field = 0; field < fields; ++field) {
        WindowSums sums = window_along_column(VKFV_SCENE plan, field, column, row);
        level = level + quotient(sums.level, real(fields));
        energy = energy + sums.energy;
    }
    real amplitude = focus_adds_magnitudes(plan.measure) ? energy : root(energy);
    return level > real(0.0) ? quotient(amplitude, level * root(real(plan.channels))) : real(0.0);
}
