// The share of light that facets of ggx reflect once and that gets away, by another program.
#pragma once

namespace vkfv::test {

struct KeptByGgx {
    double alpha, degrees, share; // degrees: angle of incidence
};
// scipy's dblquad of the textbook formula over the facets' slopes, to 1e-8.
inline constexpr KeptByGgx kept_by_ggx[] = {{0.1, 0, 0.98830406}, {0.1, 60, 0.96920498}, {0.1, 80, 0.89551875},
                                            {0.3, 0, 0.87735842}, {0.3, 60, 0.82171100}, {0.3, 80, 0.84823238},
                                            {0.5, 0, 0.68784852}, {0.5, 60, 0.69825070}, {0.5, 80, 0.80532284},
                                            {0.7, 0, 0.50371745}, {0.7, 60, 0.58990089}, {0.7, 80, 0.75088832}};

} // namespace vkfv::test
