// Light sources. Frame: the source's own, light towards +z, origin at its centre, mm.

// A flat Lambertian disc. Radiance is uniform, so position is uniform over the area and the direction has the
// density cos(theta) / (pi sin^2(theta_max)) within the cone sin(theta) <= emission_sine: the unit disc of
// (l, m), scaled. With emission_sine = 1 this is the whole hemisphere; less aims at a cone, which holds the
// share emission_sine^2 of the flux, exactly and from every point.
VKFV_FUNCTION Ray emit_from_disc(real radius, real emission_sine, real u0, real u1, real u2, real u3) {
    real rho = radius * sqrt(u0);
    real phi = real(6.283185307179586477) * u1;
    real sine_squared = emission_sine * emission_sine * u2;
    real sine = sqrt(sine_squared);
    real psi = real(6.283185307179586477) * u3;
    Ray ray;
    ray.position = real3(rho * cos(phi), rho * sin(phi), real(0.0));
    ray.direction = real3(sine * cos(psi), sine * sin(psi), sqrt(real(1.0) - sine_squared));
    ray.path_length = real(0.0);
    return ray;
}
