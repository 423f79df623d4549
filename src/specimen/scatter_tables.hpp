// Constants of scatter models that the host computes from their parameters (shaders/physics/scatter_basis.glsl).
#pragma once

#include "physics/physics.hpp"

namespace vkfv::specimen {

// The lobe with the table that its model needs; without the table it has no density.
physics::f64::Lobe tabulated(physics::f64::Lobe lobe);

// The norm N(theta_i, g) with a relative error of 1e-10. p is Poisson's kernel of the unit ball, so N is the harmonic
// function with the values max(cos(theta), 0) on the sphere, taken at g times the mirror direction. With z that point's
// height over the surface, N = max(z, 0) + I, where I is the kernel's contribution, seen from the point at |z|, of the
// opposite hemisphere: small and smooth for a sharp lobe. I is an integral over mu = |cos(theta_o)|; that over the
// azimuth is
//   4 E(m) / ((a - b) sqrt(a + b)),  a + b = (s + rho)^2 + (mu + |z|)^2,  a - b = (s - rho)^2 + (mu + |z|)^2,
// s = sqrt(1 - mu^2), rho the point's distance from the normal, 1 - m = (a - b) / (a + b), E the complete elliptic
// integral. The integrand varies over the point's distance from the horizon, hence the substitution
// mu = distance sinh(t), in panels of three Gauss points.
double henyey_greenstein_exact_norm(double g, double cosine);

// The share of light at this cosine of incidence that facets of ggx reflect once and that escapes, to 2e-9 (to 4e-7 for
// alpha below 0.05): the integral of f cos(theta). Over the azimuth it has a closed form: with f = (1/(2 pi)) (alpha
// ratio)^2 / shadowed of ggx.glsl, ratio = 1 + d / (c + b cos(phi)), the integrals of 1, 1/(c + b cos(phi)) and its
// square are 2 pi, 2 pi / r and 2 pi c / r^3, r = sqrt(c^2 - b^2). The integral over the angle of scatter is computed
// at Gauss points in the inverse hyperbolic sine of the distance from the mirror direction, in units of alpha and the
// cosine.
double ggx_kept(double alpha, double cosine);

// The total integrated scatter at normal incidence of a surface of the root mean square height sq (mm, over the spatial
// wavelengths that scatter) at a wavelength (um): 1 - exp(-(4 pi sq / wavelength)^2), H. Davies, Proc. IEE 101 (1954)
// 209; H. E. Bennett and J. O. Porteus, J. Opt. Soc. Am. 51 (1961) 123.
double total_scatter(double sq, double wavelength_um);

} // namespace vkfv::specimen
