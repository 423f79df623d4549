#include "surface/height_parameters.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::surface {

HeightParameters height_parameters(const HeightMap& map) {
    double count = 0, sum = 0;
    for (const double z : map.height.values)
        if (std::isfinite(z)) {
            count += 1;
            sum += z;
        }
    HeightParameters result;
    if (count == 0) {
        result.mean = result.sa = result.sq = result.ssk = result.sku = result.sp = result.sv = result.sz = undefined;
        return result;
    }
    result.mean = sum / count;
    // A second pass removes the sum's rounding: the mean of a constant is that constant.
    double off = 0;
    for (const double z : map.height.values)
        if (std::isfinite(z))
            off += z - result.mean;
    result.mean += off / count;
    result.measured_share = count / static_cast<double>(map.height.values.size());

    double absolute = 0, second = 0, third = 0, fourth = 0;
    for (const double z : map.height.values)
        if (std::isfinite(z)) {
            const double d = z - result.mean;
            absolute += std::abs(d);
            second += d * d;
            third += d * d * d;
            fourth += d * d * d * d;
            result.sp = std::max(result.sp, d);
            result.sv = std::max(result.sv, -d);
        }
    result.sa = absolute / count;
    result.sq = std::sqrt(second / count);
    result.ssk = second > 0 ? third / count / (result.sq * result.sq * result.sq) : undefined;
    result.sku = second > 0 ? fourth / count / std::pow(result.sq, 4) : undefined;
    result.sz = result.sp + result.sv;
    return result;
}

} // namespace vkfv::surface
