// Reflectance of an interface: Born and Wolf, "Principles of Optics" (7th edition), sections 1.5.2 and 1.6.4. Light is
// unpolarised: the mean of both polarisations at each interface. Cosines are of the angles to the normal, > 0.

VKFV_FUNCTION real fresnel_reflectance(real index_before, real index_after, real cosine) {
    real cosine_after_squared = real(1.0) - refracted_sine_squared(index_before, index_after, cosine);
    real cosine_after = sqrt(max(cosine_after_squared, real(0.0)));
    real s =
        (index_before * cosine - index_after * cosine_after) / (index_before * cosine + index_after * cosine_after);
    real p =
        (index_after * cosine - index_before * cosine_after) / (index_after * cosine + index_before * cosine_after);
    return cosine_after_squared > real(0.0) ? real(0.5) * (s * s + p * p) : real(1.0);
}

// The reflectance of an absorbing medium, for n + i k, its index over that of the medium before: Fresnel's equations
// with a complex index (section 14.2), a + i b being the square root of (n + i k)^2 - sin^2.
VKFV_FUNCTION real absorbing_reflectance(real n, real k, real cosine) {
    real cosine_squared = cosine * cosine;
    real sine_squared = max(real(1.0) - cosine_squared, real(0.0));
    real real_part = (n - k) * (n + k) - sine_squared;
    real imaginary_part = real(2.0) * n * k;
    real magnitude = sqrt(real_part * real_part + imaginary_part * imaginary_part); // a^2 + b^2
    real a_squared = real(0.5) * (magnitude + real_part);
    if (real_part < real(0.0)) { // this form avoids cancellation
        a_squared = real(0.5) * imaginary_part * imaginary_part / (magnitude - real_part);
    }
    real cross_term = real(2.0) * sqrt(a_squared) * cosine;
    real s = (magnitude + cosine_squared - cross_term) / (magnitude + cosine_squared + cross_term);
    real even = cosine_squared * magnitude + sine_squared * sine_squared;
    real p = s * (even - cross_term * sine_squared) / (even + cross_term * sine_squared);
    return real(0.5) * (s + p);
}

// The reflectance of one layer for one polarisation, by the amplitudes of its two interfaces and the cosine of the
// phase between them.
VKFV_FUNCTION real two_interface_reflectance(real first, real second, real cosine_phase) {
    real cross_term = real(2.0) * first * second * cosine_phase;
    return (first * first + second * second + cross_term) / (real(1.0) + first * first * second * second + cross_term);
}

// The reflectance of a thin layer. layer_thickness and 1 / wave_number have the same unit. Total reflection is at the
// layer's far side or before it: the medium beyond has the lower index of the two.
VKFV_FUNCTION real layer_reflectance(real index_before, real layer_index, real index_after, real cosine,
                                     real layer_thickness, real wave_number) {
    real axial_before = index_before * cosine; // n cos(theta), in each medium
    real layer_squared =
        layer_index * layer_index * (real(1.0) - refracted_sine_squared(index_before, layer_index, cosine));
    real after_squared =
        index_after * index_after * (real(1.0) - refracted_sine_squared(index_before, index_after, cosine));
    real axial_layer = sqrt(max(layer_squared, real(1e-12)));
    real axial_after = sqrt(max(after_squared, real(0.0)));
    real s_first = (axial_before - axial_layer) / (axial_before + axial_layer);
    real s_second = (axial_layer - axial_after) / (axial_layer + axial_after);
    // For p, n^2 / (n cos(theta)) takes the place of n cos(theta).
    real p_before = axial_before / (index_before * index_before);
    real p_layer = axial_layer / (layer_index * layer_index);
    real p_after = axial_after / (index_after * index_after);
    real p_first = (p_layer - p_before) / (p_layer + p_before);
    real p_second = (p_after - p_layer) / (p_after + p_layer);
    // The phase is that of two passages across the layer.
    real cosine_phase = turn_of(real(2.0) * layer_thickness * axial_layer * wave_number).cosine;
    bool total = layer_squared <= real(0.0) || after_squared <= real(0.0);
    return total ? real(1.0)
                 : real(0.5) * (two_interface_reflectance(s_first, s_second, cosine_phase) +
                                two_interface_reflectance(p_first, p_second, cosine_phase));
}

// The reflectance of a surface's interface, from either side. wave_number: 1/um.
VKFV_FUNCTION real interface_reflectance(Surface surface, real index_before, real index_after, real cosine,
                                         real wave_number) {
    real reflectance = real(0.0);
    if ((surface.flags & SURFACE_LAYER) != 0u) {
        reflectance = layer_reflectance(index_before, surface.layer_index, index_after, cosine, surface.layer_thickness,
                                        wave_number);
    } else if ((surface.flags & SURFACE_FRESNEL) != 0u) {
        reflectance = fresnel_reflectance(index_before, index_after, cosine);
    }
    return reflectance;
}
