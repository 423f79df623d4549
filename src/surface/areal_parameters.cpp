#include "surface/areal_parameters.hpp"

#include <future>

namespace vkfv::surface {

ArealParameters areal_parameters(const HeightMap& map) {
    // The groups of parameters are independent, so they are computed in parallel.
    auto spatial = std::async(std::launch::async, [&] { return spatial_parameters(map); });
    auto hybrid = std::async(std::launch::async, [&] { return hybrid_parameters(map); });
    auto feature = std::async(std::launch::async, [&] { return feature_parameters(map); });
    const MaterialRatioCurve curve(map);
    return {.height = height_parameters(map),
            .hybrid = hybrid.get(),
            .spatial = spatial.get(),
            .core = core_parameters(curve),
            .volume = volume_parameters(curve),
            .ratio = ratio_parameters(curve),
            .feature = feature.get()};
}

std::vector<NamedParameter> named_parameters(const ArealParameters& p) {
    return {{"Sq", p.height.sq},
            {"Ssk", p.height.ssk},
            {"Sku", p.height.sku},
            {"Sp", p.height.sp},
            {"Sv", p.height.sv},
            {"Sz", p.height.sz},
            {"Sa", p.height.sa},
            {"Sal", p.spatial.sal},
            {"Str", p.spatial.str},
            {"Sdq", p.hybrid.sdq},
            {"Sdq_loss", p.hybrid.sdq_loss},
            {"Sdr", p.hybrid.sdr},
            {"Sk", p.core.sk},
            {"Spk", p.core.spk},
            {"Svk", p.core.svk},
            {"Smr1", p.core.smr1},
            {"Smr2", p.core.smr2},
            {"Vmp", p.volume.vmp},
            {"Vmc", p.volume.vmc},
            {"Vvc", p.volume.vvc},
            {"Vvv", p.volume.vvv},
            {"Std", p.spatial.std_angle},
            {"Sxp", p.ratio.sxp},
            {"Sdc", p.ratio.sdc},
            {"S10z", p.feature.s10z},
            {"S5p", p.feature.s5p},
            {"S5v", p.feature.s5v},
            {"Spd", p.feature.spd},
            {"Spc", p.feature.spc}};
}

} // namespace vkfv::surface
