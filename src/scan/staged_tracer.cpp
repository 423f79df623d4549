#include "scan/staged_tracer.hpp"

#include "scan/plan.hpp"
#include "trace/interface/image_sum.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vkfv::scan {

namespace {

void scale(trace::Image& image, double flux) {
    for (Grid<double>* grid : {&image.flux, &image.standard_error}) {
        for (double& value : grid->values) {
            value *= flux;
        }
    }
    image.ledger.emitted *= flux;
    image.ledger.residual_error *= flux;
    for (auto& entry : image.ledger.entries) {
        entry.power *= flux;
    }
}

class StagedTracer final : public trace::Tracer {
  public:
    StagedTracer(std::unique_ptr<trace::Tracer> tracer, StageMotion motion)
        : tracer_(std::move(tracer)), motion_(std::move(motion)) {}

    trace::Image expose(trace::FocalPosition position, std::uint32_t image) const override {
        return begin(position, image).get();
    }

    std::future<trace::Image> begin(trace::FocalPosition position, std::uint32_t image,
                                    std::shared_ptr<const trace::Checkpoints> checkpoints = nullptr) const override {
        const int moments = motion_.moments();
        if (moments == 1) {
            auto under_way = tracer_->begin(motion_.at(position.height, image), image, std::move(checkpoints));
            return std::async(std::launch::deferred, [this, image, under_way = std::move(under_way)]() mutable {
                trace::Image exposed = under_way.get();
                scale(exposed, motion_.light(image));
                return exposed;
            });
        }
        return std::async(std::launch::deferred, [this, position, image, moments] {
            // Further moments have image numbers of their own, beyond those of all images.
            const auto index = [&](int moment) {
                return image + static_cast<std::uint32_t>(moment) * static_cast<std::uint32_t>(most_positions + 1);
            };
            trace::Image sum = tracer_->expose(motion_.at(position.height, image), image);
            for (int moment = 1; moment < moments; ++moment) {
                add(sum, tracer_->expose(motion_.at(position.height, image, moment), index(moment)));
            }
            scale(sum, motion_.light(image) / moments);
            return sum;
        });
    }

    int most_under_way() const override { return motion_.moments() == 1 ? tracer_->most_under_way() : 1; }
    std::string description() const override { return tracer_->description(); }
    trace::TracerIdentity identity() const override { return tracer_->identity(); }
    std::shared_ptr<const vulkan::Device> device() const override { return tracer_->device(); }
    std::vector<optics::PupilFilter> pupil_filters() const override { return tracer_->pupil_filters(); }

  private:
    std::unique_ptr<trace::Tracer> tracer_;
    StageMotion motion_;
};

} // namespace

std::unique_ptr<trace::Tracer> make_staged_tracer(std::unique_ptr<trace::Tracer> tracer, StageMotion motion) {
    return std::make_unique<StagedTracer>(std::move(tracer), std::move(motion));
}

} // namespace vkfv::scan
