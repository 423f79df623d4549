#include "trace/host/host_tracer.hpp"

#include "core/messages/heartbeat.hpp"
#include "core/threads/threads.hpp"
#include "optics/instrument/room.hpp"
#include "specimen/description.hpp"
#include "specimen/intersector.hpp"
#include "trace/host/host_backward_tracer.hpp"
#include "trace/host/host_mixture.hpp"
#include "trace/host/host_scene.hpp"
#include "trace/interface/exposure_record.hpp"
#include "trace/interface/ledger.hpp"
#include "trace/interface/light_sources.hpp"
#include "trace/interface/traced_instrument.hpp"
#include "trace/interface/wave_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace vkfv::trace {

namespace {

using namespace physics::f64;

// Paths of a thread between two reports of progress, of which there are several a second.
constexpr std::uint64_t paths_between_words = 4096;

uvec2 path_of(std::uint64_t index) {
    return {static_cast<uint>(index), static_cast<uint>(index >> 32)};
}

// The ends of a path's light: of its own light, and with directed scatter of a survivor beside it, with its weight.
struct HostPath {
    Fate own{}; // fate of its own light; PATH_ALIVE: the survivor stands for it
    bool survives = false;
    Survivor survivor{};
    Detection end{}; // detection of the survivor, or the fate of its own light
};

HostPath trace_host_path(const HostScene& scene, const physics::f64::Instrument& constants,
                         const SpecimenRecord& record, const Exposure& exposure, const optics::Room& room,
                         bool nonsequential, std::uint64_t index) {
    HostPath path;
    if (nonsequential) {
        path.end = trace_nonsequential(scene, constants, record, exposure, room.source, path_of(index));
        path.own = path.end.fate;
        return path;
    }
    const Departure departure = trace_to_departure(scene, constants, record, exposure, path_of(index));
    path.own = departure.fate;
    path.end.fate = departure.fate;
    path.survives = departure.survives == 1u;
    if (path.survives) {
        path.survivor = departure.survivor;
        path.end = image_survivor(scene, constants, record, exposure, departure.survivor);
    }
    return path;
}

// The instrument's trains with the features that the trace adds.
optics::TrainScene trains_of(const optics::Instrument& instrument, const TraceOptions& options) {
    optics::TrainScene trains = instrument.scene();
    trains.present |= options.directed_scatter ? FEATURE_DIRECTED_SCATTER : 0u;
    return trains;
}

class HostTracer final : public Tracer {
  public:
    HostTracer(const optics::Instrument& instrument, const specimen::Specimen& specimen, const TraceOptions& options)
        : instrument_(instrument), record_(specimen::record(specimen, options.max_bounces)), intersector_(specimen),
          options_(options), accounts_(instrument, options.directed_scatter),
          filter_(filter_for_waves(instrument, options)) {
        if (options.nonsequential) {
            room_ = optics::furnish(instrument);
            room_.grow_facet_tree();
            accounts_ = Accounts(instrument, room_.names);
        } else {
            order_ = EmissionOrder(instrument, options.rays, options.seed);
        }
    }

    Image expose(FocalPosition position, std::uint32_t image) const override {
        const auto start = std::chrono::steady_clock::now();
        const Exposure exposure = make_exposure(instrument_, record_, position, options_.seed, image);
        const EmissionCells emission(order_, image);
        const HostScene scene{trains_of(instrument_, options_), &intersector_, &room_, &emission};
        const auto workers = static_cast<std::size_t>(core_count());
        std::vector<std::vector<std::uint64_t>> counts(workers, std::vector<std::uint64_t>(accounts_.pixel_numbers()));
        std::vector<std::vector<std::uint64_t>> fates(workers, std::vector<std::uint64_t>(accounts_.ledger_numbers()));
        CellLight light(filter_, instrument_.detector_pixels());
        on_threads(core_count(), [&](int thread) {
            const auto worker = static_cast<std::size_t>(thread);
            std::uint64_t told = worker;
            for (std::uint64_t path = worker; path < options_.rays; path += workers) {
                trace_path(scene, exposure, path, counts[worker], fates[worker], light);
                if (path - told >= paths_between_words * workers) {
                    advance_work(static_cast<double>(path - told) / static_cast<double>(workers) /
                                 static_cast<double>(options_.rays));
                    told = path;
                }
            }
        });
        for (std::size_t worker = 1; worker < workers; ++worker) {
            std::ranges::transform(counts[0], counts[worker], counts[0].begin(), std::plus<>());
            std::ranges::transform(fates[0], fates[worker], fates[0].begin(), std::plus<>());
        }
        PixelLight pixels = estimate_pixels(accounts_.rule(options_.rays), instrument_.detector_pixels(), counts[0]);
        if (filter_) {
            pixels = with_waves(std::move(pixels), light.image(), accounts_.power_per_number(options_.rays), *filter_);
        }
        Image result = accounts_.image(std::move(pixels), fates[0], options_.rays);
        result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return result;
    }

    std::string description() const override {
        return fmt::format("host reference in double on {} threads", core_count());
    }

    TracerIdentity identity() const override { return host_identity(instrument_, LightSorting::of(filter_)); }
    std::vector<optics::PupilFilter> pupil_filters() const override { return filters_of(filter_); }

  private:
    void trace_path(const HostScene& scene, const Exposure& exposure, std::uint64_t index,
                    std::vector<std::uint64_t>& pixels, std::vector<std::uint64_t>& fates, CellLight& light) const {
        const HostPath path =
            trace_host_path(scene, instrument_.constants, record_, exposure, room_, options_.nonsequential, index);
        const Fate fate = path.end.fate;
        const auto pixel =
            static_cast<std::size_t>(path.end.row * instrument_.constants.detector_columns + path.end.column);
        if (filter_ && fate.status == PATH_DETECTED) {
            light.add(detection_place(instrument_.constants, filter_->cells(), path.end),
                      options_.directed_scatter ? survivor_weight(path.survivor) : 1u);
        }
        if (!options_.directed_scatter) {
            pixels[pixel] += fate.status == PATH_DETECTED ? 1 : 0;
            fates[static_cast<std::size_t>(ledger_slot(fate))] += 1;
            return;
        }
        std::uint32_t sum = 0;
        const auto count = [&](const Fate& counted, std::uint32_t weight) {
            const auto slot = static_cast<std::size_t>(ledger_slot(counted));
            fates[slot] += 1;
            fates[accounts_.slots() + slot] += weight;
            sum += weight;
        };
        if (path.own.status != PATH_ALIVE) {
            count(path.own, WEIGHT_ONE);
        }
        if (path.survives && fate.status != PATH_ALIVE) {
            const std::uint32_t weight = survivor_weight(path.survivor);
            count(fate, weight);
            if (fate.status == PATH_DETECTED) {
                pixels[2 * pixel] += weight;
                pixels[2 * pixel + 1] += (std::uint64_t{weight} * weight) >> 20;
            }
        }
        fates.back() += weight_square(sum);
    }

    optics::Instrument instrument_;
    SpecimenRecord record_;
    specimen::Intersector intersector_;
    TraceOptions options_;
    optics::Room room_;
    EmissionOrder order_;
    Accounts accounts_;
    std::optional<optics::PupilFilter> filter_;
};

} // namespace

std::unique_ptr<Tracer> make_host_tracer(const optics::Instrument& described, const specimen::Specimen& specimen,
                                         const TraceOptions& options) {
    std::vector<std::unique_ptr<Tracer>> tracers;
    for (const auto& light : one_by_one(as_traced(described, options), options)) {
        if (options.estimator == Estimator::backward) {
            tracers.push_back(make_host_backward_tracer(light.instrument, specimen, light.options));
        } else {
            tracers.push_back(std::make_unique<HostTracer>(light.instrument, specimen, light.options));
        }
    }
    return tracers.size() == 1 ? std::move(tracers.front()) : mix_on_host(std::move(tracers));
}

std::vector<PathEnd> host_paths(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                const TraceOptions& options, FocalPosition position, std::uint32_t image,
                                std::uint64_t first, std::uint64_t count, double source_scale) {
    const specimen::Intersector intersector(specimen);
    optics::Room room;
    if (options.nonsequential) {
        room = optics::furnish(instrument);
        room.grow_facet_tree();
    }
    const EmissionOrder order =
        options.nonsequential ? EmissionOrder() : EmissionOrder(instrument, options.rays, options.seed);
    const EmissionCells emission(order, image);
    const HostScene scene{trains_of(instrument, options), &intersector, &room, &emission};
    const SpecimenRecord record = specimen::record(specimen, options.max_bounces);
    const Exposure exposure = make_exposure(instrument, record, position, options.seed, image);
    physics::f64::Instrument constants = instrument.constants;
    constants.source_radius *= source_scale;
    constants.source_half_width *= source_scale;
    constants.source_half_height *= source_scale;
    constants.emission_sine = std::min(1.0, constants.emission_sine * source_scale);
    constants.emission_half_width *= source_scale;
    constants.emission_half_height *= source_scale;
    std::vector<PathEnd> ends(count);
    for (std::uint64_t index = 0; index < count; ++index) {
        const HostPath path =
            trace_host_path(scene, constants, record, exposure, room, options.nonsequential, first + index);
        const Detection& end = path.end;
        const bool weighted = options.directed_scatter && path.survives;
        ends[index] = {end.fate.status, end.fate.surface, end.x, end.y,
                       weighted ? double(survivor_weight(path.survivor)) / WEIGHT_ONE : 1.0};
    }
    return ends;
}

} // namespace vkfv::trace
