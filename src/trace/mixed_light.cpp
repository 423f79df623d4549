#include "trace/mixed_light.hpp"

#include "core/digest.hpp"
#include "trace/backward_image.hpp"
#include "trace/image_sum.hpp"
#include "trace/traced_instrument.hpp"
#include "trace/wave_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

namespace vkfv::trace {

namespace {

// What tracers of all lights have in common.
template <class AnyTracer>
std::vector<TracerIdentity> identities_of(const std::vector<std::unique_ptr<AnyTracer>>& tracers) {
    std::vector<TracerIdentity> identities;
    for (const auto& tracer : tracers) {
        identities.push_back(tracer->identity());
    }
    return identities;
}

template <class AnyTracer>
std::string description_of(const std::vector<std::unique_ptr<AnyTracer>>& tracers) {
    return fmt::format("{}; {} sources", tracers.front()->description(), tracers.size());
}

template <class AnyTracer>
std::vector<optics::PupilFilter> all_filters_of(const std::vector<std::unique_ptr<AnyTracer>>& tracers) {
    std::vector<optics::PupilFilter> all;
    for (const auto& tracer : tracers) {
        std::ranges::copy(tracer->pupil_filters(), std::back_inserter(all));
    }
    return all;
}

class HostMixture final : public Tracer {
  public:
    explicit HostMixture(std::vector<std::unique_ptr<Tracer>> tracers) : tracers_(std::move(tracers)) {}

    Image expose(FocalPosition position, std::uint32_t image) const override {
        Image sum = tracers_.front()->expose(position, image);
        for (std::size_t light = 1; light < tracers_.size(); ++light) {
            add(sum, tracers_[light]->expose(position, image));
        }
        return sum;
    }
    std::string description() const override { return description_of(tracers_); }
    TracerIdentity identity() const override { return mixed_identity(identities_of(tracers_)); }
    std::vector<optics::PupilFilter> pupil_filters() const override { return all_filters_of(tracers_); }

  private:
    std::vector<std::unique_ptr<Tracer>> tracers_;
};

// Its units and numbers are those of the first light, then those of the next, and so on.
class DeviceMixture final : public DeviceExposures {
  public:
    explicit DeviceMixture(std::vector<std::unique_ptr<DeviceExposures>> tracers) : tracers_(std::move(tracers)) {
        for (const auto& tracer : tracers_) {
            units_.push_back(tracer->units());
        }
    }

    std::string description() const override { return description_of(tracers_); }
    TracerIdentity identity() const override { return mixed_identity(identities_of(tracers_)); }
    std::shared_ptr<const vulkan::Device> device() const override { return tracers_.front()->device(); }
    std::vector<optics::PupilFilter> pupil_filters() const override { return all_filters_of(tracers_); }
    std::uint64_t units() const override { return std::accumulate(units_.begin(), units_.end(), std::uint64_t{0}); }
    std::uint64_t rays_per_unit() const override { return tracers_.front()->rays_per_unit(); }

    std::size_t slots() const override {
        std::size_t least = most_exposures;
        for (const auto& tracer : tracers_) {
            least = std::min(least, tracer->slots());
        }
        return least;
    }
    std::unique_ptr<DeviceExposure> prepare(FocalPosition position, std::uint32_t image,
                                            std::size_t slot) const override;

  private:
    class Exposure;

    std::vector<std::unique_ptr<DeviceExposures>> tracers_;
    std::vector<std::uint64_t> units_;
};

class DeviceMixture::Exposure final : public DeviceExposure {
  public:
    struct Part {
        std::unique_ptr<DeviceExposure> exposure;
        std::uint64_t first = 0; // of its units, among all
        std::uint64_t units = 0;
        bool begun = false;
    };
    explicit Exposure(std::vector<Part> parts) : parts_(std::move(parts)) {}

    void set_out(std::span<const std::uint64_t> numbers) override {
        for (Part& part : parts_) {
            part.begun = !numbers.empty();
            const auto own = numbers.first(part.begun ? part.exposure->number_count() : 0);
            numbers = numbers.subspan(own.size());
            part.exposure->set_out(own);
        }
    }

    std::size_t number_count() const override {
        std::size_t count = 0;
        for (const Part& part : parts_) {
            count += part.exposure->number_count();
        }
        return count;
    }

    std::uint64_t submit(std::uint64_t first, std::uint64_t end) override {
        const auto part = std::ranges::find_if(parts_, [&](const Part& one) { return first < one.first + one.units; });
        part->begun = true;
        return part->first + part->exposure->submit(first - part->first, std::min(end - part->first, part->units));
    }

    std::vector<std::uint64_t> numbers() override {
        std::vector<std::uint64_t> all;
        for (const Part& part : parts_) {
            // The device has not cleared what was not begun.
            const auto own =
                part.begun ? part.exposure->numbers() : std::vector<std::uint64_t>(part.exposure->number_count());
            all.insert(all.end(), own.begin(), own.end());
        }
        return all;
    }

    void hand_over() override {
        for (const Part& part : parts_) {
            part.exposure->hand_over();
        }
    }

    Image finish() override {
        Image sum = parts_.front().exposure->finish();
        for (std::size_t light = 1; light < parts_.size(); ++light) {
            add(sum, parts_[light].exposure->finish());
        }
        return sum;
    }

    std::vector<ExposureWork*> works() override {
        std::vector<ExposureWork*> all;
        for (const Part& part : parts_) {
            std::ranges::copy(part.exposure->works(), std::back_inserter(all));
        }
        return all;
    }

  private:
    std::vector<Part> parts_;
};

std::unique_ptr<DeviceExposure> DeviceMixture::prepare(FocalPosition position, std::uint32_t image,
                                                       std::size_t slot) const {
    std::vector<Exposure::Part> parts;
    std::uint64_t first = 0;
    for (std::size_t light = 0; light < tracers_.size(); ++light) {
        parts.push_back(
            {.exposure = tracers_[light]->prepare(position, image, slot), .first = first, .units = units_[light]});
        first += units_[light];
    }
    return std::make_unique<Exposure>(std::move(parts));
}

// One is itself.
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
    // What rounding leaves, or one each has taken, is the largest part's.
    const auto largest = std::ranges::max_element(parts);
    *largest = *largest + rays > sum ? *largest + rays - sum : 1;
    return parts;
}

std::uint64_t launched_rays(const TraceOptions& options, const optics::InstrumentDescription& instrument) {
    const std::vector<double> equal(instrument.sources().size(), 1.0);
    std::uint64_t all = 0;
    for (const std::uint64_t rays : rays_of_sources(options.rays, equal)) { // forward the sum is that of any shares
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
        constexpr std::uint32_t golden = 0x9E3779B9u; // no small seeds of other images are met
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

std::unique_ptr<Tracer> mix_on_host(std::vector<std::unique_ptr<Tracer>> tracers) {
    return std::make_unique<HostMixture>(std::move(tracers));
}

std::unique_ptr<DeviceExposures> mix_on_device(std::vector<std::unique_ptr<DeviceExposures>> tracers) {
    return std::make_unique<DeviceMixture>(std::move(tracers));
}

} // namespace vkfv::trace
