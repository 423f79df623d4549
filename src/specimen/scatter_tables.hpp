// What a scatter model has the host work out of its parameters (shaders/physics/scatter_basis.glsl).
#pragma once

#include "physics/physics.hpp"

namespace vkfv::specimen {

// With the table that its model wants: such a lobe has no density before.
physics::f64::Lobe tabulated(physics::f64::Lobe lobe);

// N(theta_i, g) to 1e-10 of itself. p is Poisson's kernel of the unit ball, so N is the harmonic function with the
// values max(cos(theta), 0) on the sphere, taken at g times the mirror direction. With z that point's height over the
// surface, N = max(z, 0) + I, where I is what the kernel of the point (|z|) gives the hemisphere away from it: small
// and smooth where the lobe is sharp. I is an integral over mu = |cos(theta_o)|, the one over the azimuth being
//   4 E(m) / ((a - b) sqrt(a + b)),  a + b = (s + rho)^2 + (mu + |z|)^2,  a - b = (s - rho)^2 + (mu + |z|)^2,
// s = sqrt(1 - mu^2), rho the point's distance from the normal, 1 - m = (a - b) / (a + b), E the complete elliptic
// integral. It changes over the point's distance from the horizon, hence mu = distance sinh(t), in panels of three
// Gauss points.
double henyey_greenstein_exact_norm(double g, double cosine);

} // namespace vkfv::specimen
