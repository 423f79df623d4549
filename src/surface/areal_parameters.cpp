#include "surface/areal_parameters.hpp"

#include <future>

namespace vkfv::surface {

ArealParameters areal_parameters(const HeightMap& map) {
    // None needs another.
    auto spatial = std::async(std::launch::async, [&] { return spatial_parameters(map); });
    auto hybrid = std::async(std::launch::async, [&] { return hybrid_parameters(map); });
    const MaterialRatioCurve curve(map);
    return {.height = height_parameters(map),
            .hybrid = hybrid.get(),
            .spatial = spatial.get(),
            .core = core_parameters(curve),
            .volume = volume_parameters(curve)};
}

std::vector<NamedParameter> named_parameters(const ArealParameters& p) {
    using enum ParameterUnit;
    return {{"Sq", p.height.sq, length},
            {"Ssk", p.height.ssk, number},
            {"Sku", p.height.sku, number},
            {"Sp", p.height.sp, length},
            {"Sv", p.height.sv, length},
            {"Sz", p.height.sz, length},
            {"Sa", p.height.sa, length},
            {"Sal", p.spatial.sal, length},
            {"Str", p.spatial.str, number},
            {"Sdq", p.hybrid.sdq, number},
            {"Sdr", p.hybrid.sdr, share},
            {"Sk", p.core.sk, length},
            {"Spk", p.core.spk, length},
            {"Svk", p.core.svk, length},
            {"Smr1", p.core.smr1, share},
            {"Smr2", p.core.smr2, share},
            {"Vmp", p.volume.vmp, volume_per_area},
            {"Vmc", p.volume.vmc, volume_per_area},
            {"Vvc", p.volume.vvc, volume_per_area},
            {"Vvv", p.volume.vvv, volume_per_area},
            {"Std", p.spatial.std_angle, angle}};
}

} // namespace vkfv::surface
