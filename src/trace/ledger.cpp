#include "trace/ledger.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace vkfv::trace {

namespace {

using namespace physics::f64;

struct Slot {
    std::string name;
    std::size_t splitter_passes = 0; // that a ray with this fate has behind it
    double weight = 0;               // of the power a ray starts with: what passed the splitter
};

// The splitter's passes that a ray with this fate has behind it: 0, 1 or 2.
std::size_t splitter_passes(const optics::Instrument& instrument, int surface) {
    const auto& constants = instrument.constants;
    if (surface < constants.illumination_first + constants.illumination_count) {
        return surface - constants.illumination_first < instrument.illumination_surfaces_before_splitter ? 0 : 1;
    }
    return surface - constants.imaging_first < instrument.imaging_surfaces_before_splitter ? 1 : 2;
}

std::vector<Slot> slots_of(const optics::Instrument& instrument) {
    const double reflected = instrument.splitter_reflectance;
    const std::array<double, 3> weight = {1.0, reflected, reflected * instrument.splitter_transmittance};
    std::vector<Slot> slots(ledger_slot_count(instrument));
    const std::array<std::pair<const char*, std::size_t>, PATH_VIGNETTED> plain = {{
        {"under way", 0},
        {"detected", 2},
        {"beside the specimen", 1},
        {"escaped outside the pupil", 1},
        {"bounce limit", 1},
        {"beside the detector", 2},
        {"numerical", 1},
        {"absorbed by the specimen", 1},
        {"interaction limit", 1},
    }};
    for (std::size_t status = 0; status < plain.size(); ++status) {
        const auto& [name, passes] = plain[status];
        slots[status] = {name, passes, weight[passes]};
    }
    const std::array<const char*, SURFACE_STATUS_COUNT> kinds = {"vignetted", "missed", "totally reflected",
                                                                "lost in reflection"};
    for (std::size_t surface = 0; surface < instrument.surfaces.size(); ++surface) {
        for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
            const std::size_t passes = splitter_passes(instrument, static_cast<int>(surface));
            slots[PATH_STATUS_COUNT + SURFACE_STATUS_COUNT * surface + kind] = {
                std::string(kinds[kind]) + " at " + instrument.surface_names[surface], passes, weight[passes]};
        }
    }
    return slots;
}

double aimed_share(const optics::Instrument& instrument) {
    return instrument.constants.emission_sine * instrument.constants.emission_sine;
}

} // namespace

double Ledger::residual() const {
    double sum = 0;
    for (const Entry& entry : entries) {
        sum += entry.power;
    }
    return emitted - sum;
}

std::size_t ledger_slot_count(const optics::Instrument& instrument) {
    return PATH_STATUS_COUNT + SURFACE_STATUS_COUNT * instrument.surfaces.size();
}

double detected_power_per_ray(const optics::Instrument& instrument, std::uint64_t rays) {
    return instrument.flux * aimed_share(instrument) * instrument.splitter_reflectance *
           instrument.splitter_transmittance / static_cast<double>(rays);
}

Ledger make_ledger(const optics::Instrument& instrument, std::span<const std::uint64_t> counts, std::uint64_t rays) {
    const std::vector<Slot> slots = slots_of(instrument);
    const double per_ray = instrument.flux * aimed_share(instrument) / static_cast<double>(rays);
    const double reflected = instrument.splitter_reflectance;
    Ledger ledger;
    ledger.emitted = instrument.flux;
    const auto add = [&](std::string name, double share, std::uint64_t count) {
        ledger.entries.emplace_back(std::move(name), per_ray * share * static_cast<double>(count), count);
    };
    add("detected", slots[PATH_DETECTED].weight, counts[PATH_DETECTED]);
    ledger.entries.emplace_back(std::string("not aimed at"), instrument.flux * (1.0 - aimed_share(instrument)), 0u);
    // The splitter takes its share of every ray that passes it, known from the fates beyond.
    std::uint64_t first_pass = 0;
    std::uint64_t second_pass = 0;
    for (std::size_t slot = 0; slot < slots.size(); ++slot) {
        first_pass += slots[slot].splitter_passes > 0 ? counts[slot] : 0;
        second_pass += slots[slot].splitter_passes > 1 ? counts[slot] : 0;
    }
    add("beam splitter, towards the specimen", 1.0 - reflected, first_pass);
    add("beam splitter, towards the detector", reflected * (1.0 - instrument.splitter_transmittance), second_pass);
    for (std::size_t slot = PATH_DETECTED + 1; slot < slots.size(); ++slot) {
        if (slot >= PATH_VIGNETTED && slot < PATH_STATUS_COUNT) {
            continue; // these statuses belong to surfaces, which have slots of their own
        }
        add(slots[slot].name, slots[slot].weight, counts[slot]);
    }
    return ledger;
}

Image make_image(const optics::Instrument& instrument, std::span<const std::uint64_t> pixel_counts,
                 std::span<const std::uint64_t> ledger_counts, std::uint64_t rays) {
    const int side = instrument.constants.detector_pixels;
    const double per_ray = detected_power_per_ray(instrument, rays);
    Image image;
    image.flux = Grid<double>(side, side);
    image.standard_error = Grid<double>(side, side);
    for (std::size_t pixel = 0; pixel < pixel_counts.size(); ++pixel) {
        const double count = static_cast<double>(pixel_counts[pixel]);
        image.flux.values[pixel] = per_ray * count;
        image.standard_error.values[pixel] = per_ray * std::sqrt(count * (1.0 - count / static_cast<double>(rays)));
    }
    image.ledger = make_ledger(instrument, ledger_counts, rays);
    image.rays = rays;
    image.detected = ledger_counts[PATH_DETECTED];
    return image;
}

} // namespace vkfv::trace
