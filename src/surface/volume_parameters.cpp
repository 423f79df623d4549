#include "surface/volume_parameters.hpp"

namespace vkfv::surface {

VolumeParameters volume_parameters(const MaterialRatioCurve& curve) {
    const double peaks = curve.height(0.1), dales = curve.height(0.8);
    VolumeParameters result;
    result.vmp = curve.material_volume(peaks);
    result.vmc = curve.material_volume(dales) - result.vmp;
    result.vvv = curve.void_volume(dales);
    result.vvc = curve.void_volume(peaks) - result.vvv;
    return result;
}

} // namespace vkfv::surface
