#include "trace/interface/image_sum.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <string_view>

namespace vkfv::trace {

namespace {

void add(Ledger& sum, const Ledger& part) {
    sum.emitted += part.emitted;
    sum.residual_error = std::hypot(sum.residual_error, part.residual_error);
    // Entries are matched by name, since other light may have other surfaces. Entries with equal names are matched in
    // their order.
    std::map<std::string_view, std::size_t> seen;
    const auto known = static_cast<std::ptrdiff_t>(sum.entries.size());
    for (const Ledger::Entry& entry : part.entries) {
        std::size_t before = seen[entry.name]++;
        const auto end = sum.entries.begin() + known;
        const auto same = std::find_if(sum.entries.begin(), end, [&](const Ledger::Entry& one) {
            return one.name == entry.name && before-- == 0;
        });
        if (same == end) {
            sum.entries.push_back(entry);
        } else {
            same->power += entry.power;
            same->rays += entry.rays;
        }
    }
}

} // namespace

void add(Image& sum, const Image& part) {
    std::ranges::transform(sum.flux.values, part.flux.values, sum.flux.values.begin(), std::plus<>());
    std::ranges::transform(sum.standard_error.values, part.standard_error.values, sum.standard_error.values.begin(),
                           [](double a, double b) { return std::hypot(a, b); });
    add(sum.ledger, part.ledger);
    sum.rays += part.rays;
    sum.detected += part.detected;
    sum.crossings += part.crossings;
    sum.seconds += part.seconds;
    sum.device_seconds += part.device_seconds;
    sum.longest_submission = std::max(sum.longest_submission, part.longest_submission);
    sum.device_end = part.device_end;
}

} // namespace vkfv::trace
