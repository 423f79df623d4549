// Records that host and kernels/estimate_light.comp share besides the rule: the addresses of the counted numbers and of
// the estimates.

const uint ESTIMATE_WORKGROUP = 128u;

struct EstimatedPixels {
    EstimateRule rule;
    double waves_scale; // W for each unit of the wave image
    double waves_noise; // factor of the standard error that filtering leaves
    uint64_t numbers;   // address of 64-bit numbers, pixel after pixel, randomisation after randomisation
    uint64_t waves;     // address of the wave image in float; 0: fluxes are those of rays
    uint64_t estimates; // address of doubles: all standard errors, then all fluxes, then, if by_rays, fluxes of rays
    uint pixels;
    uint stride;  // numbers from one randomisation to the next
    uint by_rays; // 1: fluxes of rays are wanted besides those of the wave image
};
