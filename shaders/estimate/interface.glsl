// What host and kernels/estimate_light.comp share beside the rule: where the kernel finds the numbers and puts what they say.

struct EstimatedPixels {
    EstimateRule rule;
    double waves_scale; // W for each unit of the light that waves make
    double waves_noise; // what filtering leaves of the standard error
    uint64_t numbers;   // addresses: of 64-bit numbers, pixel after pixel, randomisation after randomisation
    uint64_t waves;     // of float, the light as waves make it; 0: as rays make it
    uint64_t estimates; // of double: fluxes of all pixels, then standard errors, then, with waves, their fluxes
    uint pixels;
    uint stride; // numbers from a randomisation to the next
};
