// Saturation capacity and the charge at which a pixel clips.
#pragma once

namespace vkfv::camera {

// The charge at which a pixel clips, a whole number of electrons: the least one at which the temporal variance still
// grows at `capacity`. EMVA Standard 1288 (release 4.0 linear, section 6.6) defines the saturation capacity as the mean
// charge at which the temporal variance, averaged over pixels, is largest. Clipping reduces the variance long before
// the mean reaches the clip, so that the capacity lies some three standard deviations of the charge below it, and
// further if pixels differ in response. capacity: e-; photo_response: standard deviation of the pixels' response,
// relative.
//
// With N a Poisson variable of mean m and c = min(N, C), d E[f(N)] / dm = E[f(N + 1) - f(N)] gives
//   d Var[c] / dm = sum over n < C of (2 n + 1) p(n)  -  2 E[c] P(N < C),
// which is averaged over normally distributed responses.
double clip_of_capacity(double capacity, double photo_response);

// The derivative d Var[c] / dm for one response: > 0 below the capacity. mean, clip: e-, the clip a whole number.
double variance_slope(double mean, double clip);

} // namespace vkfv::camera
