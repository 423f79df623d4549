#include "trace/ledger.hpp"

#include <cmath>
#include <utility>

namespace vkfv::trace {

namespace {

using namespace physics::f64;

// The splitter's passes that a ray has behind it which ends at a surface: 0, 1 or 2.
std::vector<std::size_t> splitter_passes(const optics::Instrument& instrument) {
    const auto& constants = instrument.constants;
    std::vector<std::size_t> passes;
    for (int surface = 0; surface < static_cast<int>(instrument.surfaces.size()); ++surface) {
        if (surface < constants.illumination_first + constants.illumination_count) {
            const int place = surface - constants.illumination_first;
            passes.push_back(place < instrument.illumination_surfaces_before_splitter ? 0 : 1);
        } else {
            const int place = surface - constants.imaging_first;
            passes.push_back(place < instrument.imaging_surfaces_before_splitter ? 1 : 2);
        }
    }
    return passes;
}

// Surfaces that a ray has met which ends at a surface, that one included.
std::vector<int> crossings_up_to(const optics::Instrument& instrument) {
    const auto& constants = instrument.constants;
    std::vector<int> crossings;
    for (int surface = 0; surface < static_cast<int>(instrument.surfaces.size()); ++surface) {
        crossings.push_back(surface < constants.imaging_first
                                ? surface - constants.illumination_first + 1
                                : constants.illumination_count + surface - constants.imaging_first + 1);
    }
    return crossings;
}

} // namespace

double Ledger::residual() const {
    double sum = 0;
    for (const Entry& entry : entries) {
        sum += entry.power;
    }
    return emitted - sum;
}

Accounts::Accounts(const optics::Instrument& instrument)
    : flux_(instrument.flux), aimed_(instrument.constants.emission_sine * instrument.constants.emission_sine),
      left_{1.0, instrument.splitter_reflectance,
            instrument.splitter_reflectance * instrument.splitter_transmittance},
      pixels_(instrument.constants.detector_pixels) {
    const auto& constants = instrument.constants;
    add_slots(instrument.surface_names, splitter_passes(instrument), crossings_up_to(instrument),
              constants.illumination_count, constants.illumination_count + constants.imaging_count);
}

Accounts::Accounts(const optics::Instrument& instrument, const std::vector<std::string>& element_names)
    : flux_(instrument.flux), aimed_(instrument.constants.emission_sine * instrument.constants.emission_sine),
      pixels_(instrument.constants.detector_pixels) {
    add_slots(element_names, std::vector<std::size_t>(element_names.size(), 0),
              std::vector<int>(element_names.size(), 0), 0, 0);
}

void Accounts::add_slots(const std::vector<std::string>& names, const std::vector<std::size_t>& passes,
                         const std::vector<int>& crossings, int illumination, int both) {
    const std::array<Slot, PATH_VIGNETTED> plain = {{
        {"under way", 0, 0},
        {"detected", 2, both},
        {"beside the specimen", 1, illumination},
        {"escaped outside the pupil", 1, illumination},
        {"bounce limit", 1, illumination},
        {"beside the detector", 2, both},
        {"numerical", 1, illumination},
        {"absorbed by the specimen", 1, illumination},
        {"interaction limit", 1, 0},
    }};
    slots_.assign(plain.begin(), plain.end());
    slots_.resize(PATH_STATUS_COUNT); // statuses that belong to surfaces count there
    const std::array<const char*, SURFACE_STATUS_COUNT> kinds = {"vignetted", "missed", "totally reflected",
                                                                "lost in reflection"};
    for (std::size_t surface = 0; surface < names.size(); ++surface) {
        for (const char* kind : kinds) {
            slots_.push_back({std::string(kind) + " at " + names[surface], passes[surface], crossings[surface]});
        }
    }
}

Ledger Accounts::ledger(std::span<const std::uint64_t> counts, std::uint64_t rays) const {
    const double per_ray = flux_ * aimed_ / static_cast<double>(rays);
    Ledger ledger;
    ledger.emitted = flux_;
    const auto add = [&](std::string name, double share, std::uint64_t count) {
        ledger.entries.push_back({std::move(name), per_ray * share * static_cast<double>(count), count});
    };
    const auto add_slot = [&](std::size_t slot) {
        add(slots_[slot].name, left_[slots_[slot].splitter_passes], counts[slot]);
    };
    add_slot(PATH_DETECTED);
    ledger.entries.push_back({"not aimed at", flux_ * (1.0 - aimed_), 0});
    // The splitter takes its share of every ray that passes it, known from the fates beyond.
    std::array<std::uint64_t, 2> passed = {0, 0};
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        for (std::size_t pass = 0; pass < slots_[slot].splitter_passes; ++pass) {
            passed[pass] += counts[slot];
        }
    }
    add("beam splitter, towards the specimen", left_[0] - left_[1], passed[0]);
    add("beam splitter, towards the detector", left_[1] - left_[2], passed[1]);
    for (std::size_t slot = PATH_DETECTED + 1; slot < slots_.size(); ++slot) {
        if (slot < PATH_VIGNETTED || slot >= PATH_STATUS_COUNT) {
            add_slot(slot);
        }
    }
    return ledger;
}

Image Accounts::image(std::span<const std::uint64_t> pixel_counts, std::span<const std::uint64_t> ledger_counts,
                      std::uint64_t rays) const {
    const double per_ray = flux_ * aimed_ * left_[2] / static_cast<double>(rays);
    Image image;
    image.flux = Grid<double>(pixels_, pixels_);
    image.standard_error = Grid<double>(pixels_, pixels_);
    for (std::size_t pixel = 0; pixel < pixel_counts.size(); ++pixel) {
        const double count = static_cast<double>(pixel_counts[pixel]);
        image.flux.values[pixel] = per_ray * count;
        image.standard_error.values[pixel] = per_ray * std::sqrt(count * (1.0 - count / static_cast<double>(rays)));
    }
    image.ledger = ledger(ledger_counts, rays);
    image.rays = rays;
    image.detected = ledger_counts[PATH_DETECTED];
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        image.crossings += static_cast<double>(ledger_counts[slot]) * slots_[slot].crossings;
    }
    return image;
}

} // namespace vkfv::trace
