#include "trace/device/device_mixture.hpp"

#include "trace/interface/image_sum.hpp"
#include "trace/interface/light_sources.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace vkfv::trace {

namespace {

// Tracer of a mixture of lights. Its units and numbers are those of the first light, then those of the next, and so on.
class DeviceMixture final : public DeviceExposures {
  public:
    explicit DeviceMixture(std::vector<std::unique_ptr<DeviceExposures>> tracers) : tracers_(std::move(tracers)) {
        for (const auto& tracer : tracers_) {
            units_.push_back(tracer->units());
        }
    }

    std::string description() const override { return description_of(tracers_); }
    TracerIdentity identity() const override { return identity_of(tracers_); }
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
        std::uint64_t first = 0; // index of its first unit among those of all lights
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
            // The device has not cleared the numbers of exposures that were not begun; they are zeros.
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

} // namespace

std::unique_ptr<DeviceExposures> mix_on_device(std::vector<std::unique_ptr<DeviceExposures>> tracers) {
    return std::make_unique<DeviceMixture>(std::move(tracers));
}

} // namespace vkfv::trace
