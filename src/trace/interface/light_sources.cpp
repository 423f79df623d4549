#include "trace/interface/light_sources.hpp"

#include "core/files/digest.hpp"
#include "trace/interface/backward_image.hpp"
#include "trace/interface/traced_instrument.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace vkfv::trace {

namespace {

// The combined digest of the lights; for a single source it is that of its instrument.
std::string digest_of_lights(const std::vector<std::string>& instruments) {
    if (instruments.size() == 1) {
        return instruments.front();
    }
    Digest digest;
    for (const std::string& one : instruments) {
        digest.add(one);
    }
    return digest.text();
}

} // namespace

std::vector<std::uint64_t> rays_of_sources(std::uint64_t rays, std::span<const double> shares) {
    const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
    std::vector<std::uint64_t> parts;
    std::uint64_t sum = 0;
    for (const double share : shares) {
        parts.push_back(
            std::max<std::uint64_t>(1, static_cast<std::uint64_t>(share / all * static_cast<double>(rays))));
        sum += parts.back();
    }
    // The largest part takes up the difference of the sum that rounding, or the minimum of one ray each, makes.
    const auto largest = std::ranges::max_element(parts);
    *largest = *largest + rays > sum ? *largest + rays - sum : 1;
    return parts;
}

std::uint64_t launched_rays(const TraceOptions& options, const optics::InstrumentDescription& instrument) {
    const std::vector<double> equal(instrument.sources().size(), 1.0);
    std::uint64_t all = 0;
    for (const std::uint64_t rays : rays_of_sources(options.rays, equal)) { // forward any shares give this sum
        all += options.estimator == Estimator::backward ? backward_rays(rays, instrument.detector_pixels) : rays;
    }
    return all;
}

std::vector<OneLight> one_by_one(const optics::Instrument& instrument, const TraceOptions& options) {
    const auto lights = instrument.lights();
    std::vector<double> shares;
    for (const auto* light : lights) {
        shares.push_back(options.estimator == Estimator::backward ? 1 : light->flux * light->aimed_share());
    }
    const auto rays = rays_of_sources(options.rays, shares);
    std::vector<OneLight> alone;
    for (std::size_t k = 0; k < lights.size(); ++k) {
        constexpr std::uint32_t golden = 0x9E3779B9u; // keeps the seeds from those of other images
        OneLight one{.instrument = *lights[k], .options = options};
        one.instrument.further_lights.clear();
        one.options.rays = rays[k];
        one.options.seed += golden * static_cast<std::uint32_t>(k);
        if (one.options.waves) {
            one.options.waves->sharers = static_cast<int>(lights.size());
        }
        alone.push_back(std::move(one));
    }
    return alone;
}

TracerIdentity mixed_identity(const std::vector<TracerIdentity>& identities) {
    TracerIdentity identity = identities.front();
    std::vector<std::string> instruments;
    for (const TracerIdentity& one : identities) {
        instruments.push_back(one.instrument);
        if (instruments.size() > 1 && one.sorting.pupil_cells != 0) {
            identity.further_sortings.push_back(one.sorting);
        }
    }
    identity.instrument = digest_of_lights(instruments);
    return identity;
}

std::string traced_digest(const optics::Instrument& instrument, const TraceOptions& options) {
    std::vector<std::string> instruments;
    for (const OneLight& light : one_by_one(as_traced(instrument, options), options)) {
        instruments.push_back(instrument_digest(
            options.estimator == Estimator::backward ? optics::turned_round(light.instrument) : light.instrument));
    }
    return digest_of_lights(instruments);
}

} // namespace vkfv::trace
