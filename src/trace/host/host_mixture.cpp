#include "trace/host/host_mixture.hpp"

#include "core/messages/heartbeat.hpp"
#include "trace/interface/image_sum.hpp"
#include "trace/interface/light_sources.hpp"

#include <utility>

namespace vkfv::trace {

namespace {

class HostMixture final : public Tracer {
  public:
    explicit HostMixture(std::vector<std::unique_ptr<Tracer>> tracers) : tracers_(std::move(tracers)) {}

    Image expose(FocalPosition position, std::uint32_t image) const override {
        const PartOfWork of_one_light(1 / static_cast<double>(tracers_.size()));
        Image sum = tracers_.front()->expose(position, image);
        for (std::size_t light = 1; light < tracers_.size(); ++light) {
            add(sum, tracers_[light]->expose(position, image));
        }
        return sum;
    }
    std::string description() const override { return description_of(tracers_); }
    TracerIdentity identity() const override { return identity_of(tracers_); }
    std::vector<optics::PupilFilter> pupil_filters() const override { return all_filters_of(tracers_); }

  private:
    std::vector<std::unique_ptr<Tracer>> tracers_;
};

} // namespace

std::unique_ptr<Tracer> mix_on_host(std::vector<std::unique_ptr<Tracer>> tracers) {
    return std::make_unique<HostMixture>(std::move(tracers));
}

} // namespace vkfv::trace
