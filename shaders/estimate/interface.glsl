// What host and kernels/estimate_light.comp share beside the rule: where the kernel finds the numbers and puts what
// they say.

const uint ESTIMATE_WORKGROUP = 128u;

struct EstimatedPixels {
    EstimateRule rule;
    double waves_scale; // W for each unit of the light that waves make
    double waves_noise; // what filtering leaves of the standard error
    uint64_t numbers;   // addresses: of 64-bit numbers, pixel after pixel, randomisation after randomisation
    uint64_t waves;     // of float, the light as waves make it; 0: as rays bring it
    uint64_t estimates; // of double: standard errors of all pixels, then fluxes, then, if asked for, those by rays
    uint pixels;
    uint stride;  // numbers from a randomisation to the next
    uint by_rays; // 1: fluxes as rays bring them are asked for beside those of waves
};
