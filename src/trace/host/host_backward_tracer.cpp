#include "trace/host/host_backward_tracer.hpp"

#include "core/messages/heartbeat.hpp"
#include "core/threads/threads.hpp"
#include "specimen/description.hpp"
#include "trace/host/host_scene.hpp"
#include "trace/interface/backward_image.hpp"
#include "trace/interface/exposure_record.hpp"
#include "trace/interface/wave_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <span>
#include <vector>

namespace vkfv::trace {

namespace {

using namespace physics::f64;

// The backward estimator in double, with the same points and random numbers as on a device.
class HostBackwardTracer final : public Tracer {
  public:
    HostBackwardTracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                       const TraceOptions& options)
        : instrument_(instrument), turned_(optics::turned_round(instrument)),
          record_(specimen::record(specimen, options.max_bounces)), intersector_(specimen), seed_(options.seed),
          plan_(backward_plan(options.rays, instrument.detector_pixels())),
          filter_(filter_for_waves(instrument, options)) {}

    Image expose(FocalPosition position, std::uint32_t image) const override {
        const auto start = std::chrono::steady_clock::now();
        const Exposure exposure = make_exposure(instrument_, record_, position, seed_, image);
        const HostScene scene{turned_.scene(), &intersector_};
        const ImageSize pixels = turned_.detector_pixels();
        const auto workers = static_cast<std::size_t>(core_count());
        std::vector<std::uint64_t> sums(plan_.randomisations * pixels.count());
        CellLight light(filter_, pixels);
        for (std::uint32_t randomisation = 0; randomisation < plan_.randomisations; ++randomisation) {
            const std::span own = std::span(sums).subspan(randomisation * pixels.count(), pixels.count());
            on_threads(core_count(), [&](int thread) {
                for (auto pixel = static_cast<std::size_t>(thread); pixel < own.size(); pixel += workers) {
                    own[pixel] = sum_of_pixel(scene, exposure, static_cast<std::uint32_t>(pixel), randomisation, light);
                    advance_work(1 / static_cast<double>(sums.size()));
                }
            });
        }
        PixelLight found = estimate_pixels(accounts_.rule(), pixels, sums, pixels.count());
        const double detected = sum_of(found.flux.values);
        if (filter_) {
            found = with_waves(std::move(found), light.image(), accounts_.power_per_number(), *filter_);
        }
        Image exposed = accounts_.image(std::move(found), detected);
        exposed.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return exposed;
    }

    std::string description() const override {
        return fmt::format("host reference in double on {} threads; backward", core_count());
    }

    TracerIdentity identity() const override { return host_identity(turned_, LightSorting::of(filter_)); }
    std::vector<optics::PupilFilter> pupil_filters() const override { return filters_of(filter_); }

  private:
    std::uint64_t sum_of_pixel(const HostScene& scene, const Exposure& exposure, std::uint32_t pixel,
                               std::uint32_t randomisation, CellLight& light) const {
        const auto columns = static_cast<std::uint32_t>(turned_.constants.detector_columns);
        const LatticeShift shift = lattice_shift(exposure.seed, exposure.image, pixel, randomisation);
        const int column = static_cast<int>(pixel % columns);
        const int row = static_cast<int>(pixel / columns);
        double sum = 0;
        for (std::uint32_t point = 0; point < plan_.points; ++point) {
            const double value = trace_backward(scene, turned_.constants, optics_, record_, exposure, column, row,
                                                randomisation, lattice_, shift, point);
            sum += value;
            if (filter_) {
                light.add(
                    backward_place(optics_, filter_->cells(), column, row, backward_start(lattice_, shift, point)),
                    static_cast<std::uint64_t>(value * BACKWARD_UNIT + 0.5));
            }
        }
        return static_cast<std::uint64_t>(sum * BACKWARD_UNIT + 0.5);
    }

    optics::Instrument instrument_;
    optics::Instrument turned_;
    SpecimenRecord record_;
    specimen::Intersector intersector_;
    std::uint32_t seed_;
    BackwardPlan plan_;
    BackwardAccounts accounts_{instrument_, plan_};
    std::optional<optics::PupilFilter> filter_;
    Lattice lattice_ = plan_.lattice();
    BackwardOptics optics_ = backward_optics(instrument_, record_.material, plan_);
};

} // namespace

std::unique_ptr<Tracer> make_host_backward_tracer(const optics::Instrument& instrument,
                                                  const specimen::Specimen& specimen, const TraceOptions& options) {
    return std::make_unique<HostBackwardTracer>(instrument, specimen, options);
}

} // namespace vkfv::trace
