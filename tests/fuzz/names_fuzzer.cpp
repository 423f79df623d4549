// Any names of files, one a line, have an order with a height each, or are in doubt.
#include "scan/image_order.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace {

void demand(bool holds) {
    if (!holds) {
        std::abort();
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vkfv;
    std::vector<std::string> names;
    std::string_view rest(reinterpret_cast<const char*>(data), size);
    while (!rest.empty()) {
        const auto end = std::min(rest.find('\n'), rest.size());
        names.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    demand(scan::of_one_series(names).size() == names.size());
    const auto found = scan::order_of_names(names);
    auto order = found.order;
    std::sort(order.begin(), order.end());
    std::vector<std::size_t> places(names.size());
    std::iota(places.begin(), places.end(), 0);
    demand(order == places && found.heights.size() == names.size());
    demand(std::is_sorted(found.heights.begin(), found.heights.end()));
    demand(!found.step || (std::isfinite(*found.step) && *found.step > 0));
    demand(!found.first || std::isfinite(*found.first));
    return 0;
}
