// The response of a focus measure at one pixel, before it is gathered over the window. The energies (squared responses)
// of all channels are added. Some measures are sums of magnitudes, so the root is taken at the pixel; all others are
// energies, and the root is taken after the window. The standard deviation has no response of its own: it is made in
// the window (standard_deviation.glsl).

// True if the window adds magnitudes.
VKFV_FUNCTION bool focus_adds_magnitudes(int measure) {
    return measure == FOCUS_MODIFIED_LAPLACIAN || measure == FOCUS_GRADIENT_AND_CURVATURE;
}

VKFV_SCENE_FUNCTION real focus_response(VKFV_SCENE_PARAMETER FocusPlan plan, int column, int row) {
    real energy = real(0.0);
    for (int channel = 0; channel < plan.channels; ++channel) {
        if (plan.measure == FOCUS_TENENGRAD) {
            energy = energy + tenengrad_energy(VKFV_SCENE plan, channel, column, row);
        } else if (plan.measure == FOCUS_MODIFIED_LAPLACIAN) {
            real magnitude = modified_laplacian(VKFV_SCENE plan, channel, column, row);
            energy = energy + magnitude * magnitude;
        } else if (plan.measure == FOCUS_BRENNER) {
            energy = energy + brenner_energy(VKFV_SCENE plan, channel, column, row);
        } else if (plan.measure == FOCUS_WAVELET) {
            energy = energy + wavelet_energy(VKFV_SCENE plan, channel, column, row);
        } else if (plan.measure == FOCUS_GRADIENT_AND_CURVATURE) {
            energy = energy + gradient_and_curvature_energy(VKFV_SCENE plan, channel, column, row);
        }
    }
    return focus_adds_magnitudes(plan.measure) ? root(energy) : energy;
}

// False if the window alone makes the measure from the channels.
VKFV_FUNCTION bool focus_responds(FocusPlan plan) { return plan.measure != FOCUS_STANDARD_DEVIATION; }

// Number of fields that the window gathers apart: each channel for the standard deviation, else the response of all
// channels.
VKFV_FUNCTION int focus_fields(FocusPlan plan) { return focus_responds(plan) ? 1 : plan.channels; }
