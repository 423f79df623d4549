#include "trace/ledger.hpp"

#include <algorithm>
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

Accounts::Accounts(const optics::Instrument& instrument, bool directed_scatter)
    : flux_(instrument.flux), aimed_(instrument.constants.emission_sine * instrument.constants.emission_sine),
      left_{1.0, instrument.splitter_reflectance, instrument.splitter_reflectance * instrument.splitter_transmittance},
      pixels_(instrument.constants.detector_pixels), weighted_(directed_scatter) {
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

Ledger Accounts::ledger(std::span<const std::uint64_t> numbers, std::uint64_t rays) const {
    const double per_ray = flux_ * aimed_ / static_cast<double>(rays);
    const auto counts = numbers.first(slots_.size());
    // In rays of weight 1.
    const auto amount = [&](std::size_t slot) {
        return weighted_ ? static_cast<double>(numbers[slots_.size() + slot]) / WEIGHT_ONE
                         : static_cast<double>(counts[slot]);
    };
    Ledger ledger;
    ledger.emitted = flux_;
    const auto add_slot = [&](std::size_t slot) {
        ledger.entries.push_back(
            {slots_[slot].name, per_ray * left_[slots_[slot].splitter_passes] * amount(slot), counts[slot]});
    };
    add_slot(PATH_DETECTED);
    ledger.entries.push_back({"not aimed at", flux_ * (1.0 - aimed_), 0});
    // The splitter takes its share of every ray that passes it, known from the fates beyond.
    std::array<double, 2> passed = {0, 0};
    std::array<std::uint64_t, 2> rays_passed = {0, 0};
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        for (std::size_t pass = 0; pass < slots_[slot].splitter_passes; ++pass) {
            passed[pass] += amount(slot);
            rays_passed[pass] += counts[slot];
        }
    }
    ledger.entries.push_back(
        {"beam splitter, towards the specimen", per_ray * (left_[0] - left_[1]) * passed[0], rays_passed[0]});
    ledger.entries.push_back(
        {"beam splitter, towards the detector", per_ray * (left_[1] - left_[2]) * passed[1], rays_passed[1]});
    for (std::size_t slot = PATH_DETECTED + 1; slot < slots_.size(); ++slot) {
        if (slot < PATH_VIGNETTED || slot >= PATH_STATUS_COUNT) {
            add_slot(slot);
        }
    }
    if (weighted_) {
        // A path adds 1 in the mean.
        const double mean_square = static_cast<double>(numbers.back()) / 262144.0 / static_cast<double>(rays);
        ledger.residual_error = flux_ * aimed_ * std::sqrt(std::max(mean_square - 1, 0.0) / static_cast<double>(rays));
    }
    return ledger;
}

Image Accounts::image(std::span<const std::uint64_t> pixel_numbers, std::span<const std::uint64_t> ledger_numbers,
                      std::uint64_t rays) const {
    const double per_ray = flux_ * aimed_ * left_[2] / static_cast<double>(rays);
    Image image;
    image.flux = Grid<double>(pixels_, pixels_);
    image.standard_error = Grid<double>(pixels_, pixels_);
    for (std::size_t pixel = 0; pixel < image.flux.values.size(); ++pixel) {
        // In rays of weight 1; the square of a count's weight is the weight.
        const double sum = weighted_ ? static_cast<double>(pixel_numbers[2 * pixel]) / WEIGHT_ONE
                                     : static_cast<double>(pixel_numbers[pixel]);
        const double squares = weighted_ ? static_cast<double>(pixel_numbers[2 * pixel + 1]) / 16777216.0 : sum;
        image.flux.values[pixel] = per_ray * sum;
        image.standard_error.values[pixel] =
            per_ray * std::sqrt(std::max(squares - sum * sum / static_cast<double>(rays), 0.0));
    }
    image.ledger = ledger(ledger_numbers, rays);
    image.rays = rays;
    image.detected = ledger_numbers[PATH_DETECTED];
    double counted = 0;
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        counted += static_cast<double>(ledger_numbers[slot]);
        image.crossings += static_cast<double>(ledger_numbers[slot]) * slots_[slot].crossings;
    }
    if (weighted_) {
        // A path's own light and its survivor, both counted, have crossed the illumination once.
        image.crossings -= (counted - static_cast<double>(rays)) * slots_[PATH_ESCAPED].crossings;
    }
    return image;
}

} // namespace vkfv::trace
