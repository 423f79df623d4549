#include "trace/interface/ledger.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::trace {

namespace {

using namespace physics::f64;
using Status = Ledger::Status;

static_assert(static_cast<std::uint32_t>(Status::under_way) == PATH_ALIVE &&
              static_cast<std::uint32_t>(Status::vignetted) == PATH_VIGNETTED &&
              static_cast<int>(Status::not_aimed_at) == PATH_STATUS_COUNT);

const char* name_of(Status status) {
    switch (status) {
    case Status::under_way:
        return "under way";
    case Status::detected:
        return "detected";
    case Status::beside_specimen:
        return "beside the specimen";
    case Status::outside_pupil:
        return "escaped outside the pupil";
    case Status::bounce_limit:
        return "bounce limit";
    case Status::beside_detector:
        return "beside the detector";
    case Status::numerical:
        return "numerical";
    case Status::absorbed:
        return "absorbed by the specimen";
    case Status::interaction_limit:
        return "interaction limit";
    case Status::vignetted:
        return "vignetted";
    case Status::missed:
        return "missed";
    case Status::totally_reflected:
        return "totally reflected";
    case Status::lost_in_reflection:
        return "lost in reflection"; // or absorbed there, by a mirror or a light pattern
    case Status::not_aimed_at:
        return "not aimed at";
    case Status::splitter_towards_specimen:
        return "beam splitter, towards the specimen";
    case Status::splitter_towards_detector:
        return "beam splitter, towards the detector";
    case Status::not_followed_backward:
        break;
    }
    return "not followed backward";
}

} // namespace

Ledger::Entry plain_entry(Status status, double power, std::uint64_t rays) {
    return {.name = name_of(status), .power = power, .rays = rays, .status = status};
}

std::optional<double> share_collected(const Ledger& ledger) {
    double collected = 0;
    double lost = 0;
    for (const Ledger::Entry& entry : ledger.entries) {
        const auto rays = static_cast<double>(entry.rays);
        if (entry.status == Status::detected || entry.status == Status::beside_detector ||
            entry.train == Train::imaging) {
            collected += rays;
        } else if (entry.status == Status::outside_pupil || entry.status == Status::bounce_limit) {
            lost += rays;
        }
    }
    return collected + lost > 0 ? std::optional(collected / (collected + lost)) : std::nullopt;
}

double Ledger::residual() const {
    double sum = 0;
    for (const Entry& entry : entries) {
        sum += entry.power;
    }
    return emitted - sum;
}

Accounts::Accounts(const optics::Instrument& instrument, bool directed_scatter)
    : flux_(instrument.flux),
      aimed_(instrument.aimed_share()), left_{1.0, instrument.splitter_reflectance,
                                              instrument.splitter_reflectance * instrument.splitter_transmittance},
      pixels_(instrument.detector_pixels()), weighted_(directed_scatter) {
    const auto& constants = instrument.constants;
    add_slots(surfaces_of(instrument), constants.illumination_count,
              constants.illumination_count + constants.imaging_count);
}

Accounts::Accounts(const optics::Instrument& instrument, const std::vector<std::string>& element_names)
    : flux_(instrument.flux), aimed_(instrument.aimed_share()), pixels_(instrument.detector_pixels()) {
    std::vector<Surface> elements;
    for (const std::string& name : element_names) {
        elements.push_back({.name = name, .index = static_cast<int>(elements.size())});
    }
    add_slots(elements, 0, 0);
}

std::vector<Accounts::Surface> Accounts::surfaces_of(const optics::Instrument& instrument) {
    const auto& constants = instrument.constants;
    std::vector<Surface> surfaces;
    for (const std::string& name : instrument.surface_names) {
        const int surface = static_cast<int>(surfaces.size());
        const bool illuminates = surface < constants.imaging_first;
        const int place = surface - (illuminates ? constants.illumination_first : constants.imaging_first);
        const bool before_splitter = place < (illuminates ? instrument.illumination_surfaces_before_splitter
                                                          : instrument.imaging_surfaces_before_splitter);
        const std::size_t passes = illuminates ? 0 : 1;
        surfaces.push_back({.name = name,
                            .train = illuminates ? Train::illumination : Train::imaging,
                            .index = place,
                            .splitter_passes = before_splitter ? passes : passes + 1,
                            .crossings = illuminates ? place + 1 : constants.illumination_count + place + 1});
    }
    return surfaces;
}

void Accounts::add_slots(const std::vector<Surface>& surfaces, int illumination, int both) {
    struct Plain {
        std::size_t splitter_passes;
        int crossings;
    };
    const std::array<Plain, PATH_VIGNETTED> plain = {{
        {0, 0},            // under way
        {2, both},         // detected
        {1, illumination}, // beside the specimen
        {1, illumination}, // outside the pupil
        {1, illumination}, // bounce limit
        {2, both},         // beside the detector
        {1, illumination}, // numerical
        {1, illumination}, // absorbed
        {1, 0},            // interaction limit
    }};
    for (const Plain& slot : plain) {
        slots_.push_back({plain_entry(static_cast<Status>(slots_.size()), 0, 0), slot.splitter_passes, slot.crossings});
    }
    slots_.resize(PATH_STATUS_COUNT); // statuses with a surface have slots of their own
    for (const Surface& surface : surfaces) {
        for (int kind = 0; kind < SURFACE_STATUS_COUNT; ++kind) {
            Ledger::Entry entry = plain_entry(static_cast<Status>(PATH_VIGNETTED + kind), 0, 0);
            entry.name += " at " + surface.name;
            entry.train = surface.train;
            entry.surface = surface.index;
            slots_.push_back({std::move(entry), surface.splitter_passes, surface.crossings});
        }
    }
}

Ledger Accounts::ledger(std::span<const std::uint64_t> numbers, std::uint64_t rays) const {
    const double per_ray = flux_ * aimed_ / static_cast<double>(rays);
    const auto counts = numbers.first(slots());
    // The amount of light in a slot, in rays of weight 1.
    const auto amount = [&](std::size_t slot) {
        return weighted_ ? static_cast<double>(numbers[slots() + slot]) / WEIGHT_ONE
                         : static_cast<double>(counts[slot]);
    };
    Ledger ledger;
    ledger.emitted = flux_;
    const auto add_slot = [&](std::size_t slot) {
        Ledger::Entry entry = slots_[slot].entry;
        entry.power = per_ray * left_[slots_[slot].splitter_passes] * amount(slot);
        entry.rays = counts[slot];
        ledger.entries.push_back(std::move(entry));
    };
    add_slot(PATH_DETECTED);
    ledger.entries.push_back(plain_entry(Status::not_aimed_at, flux_ * (1.0 - aimed_), 0));
    // The splitter takes its share of every ray that passes it; how many passed follows from the fates beyond it.
    std::array<double, 2> passed = {0, 0};
    std::array<std::uint64_t, 2> rays_passed = {0, 0};
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        for (std::size_t pass = 0; pass < slots_[slot].splitter_passes; ++pass) {
            passed[pass] += amount(slot);
            rays_passed[pass] += counts[slot];
        }
    }
    ledger.entries.push_back(
        plain_entry(Status::splitter_towards_specimen, per_ray * (left_[0] - left_[1]) * passed[0], rays_passed[0]));
    ledger.entries.push_back(
        plain_entry(Status::splitter_towards_detector, per_ray * (left_[1] - left_[2]) * passed[1], rays_passed[1]));
    for (std::size_t slot = PATH_DETECTED + 1; slot < slots_.size(); ++slot) {
        if (slot < PATH_VIGNETTED || slot >= PATH_STATUS_COUNT) {
            add_slot(slot);
        }
    }
    if (weighted_) {
        // A path adds 1 to the ledger on average.
        const double mean_square = static_cast<double>(numbers.back()) / 262144.0 / static_cast<double>(rays);
        ledger.residual_error = flux_ * aimed_ * std::sqrt(std::max(mean_square - 1, 0.0) / static_cast<double>(rays));
    }
    return ledger;
}

double Accounts::power_per_number(std::uint64_t rays) const {
    return flux_ * aimed_ * left_[2] / static_cast<double>(rays) / (weighted_ ? WEIGHT_ONE : 1);
}

estimate::EstimateRule Accounts::rule(std::uint64_t rays) const {
    return {.kind = weighted_ ? estimate::ESTIMATE_WEIGHTS : estimate::ESTIMATE_COUNTS,
            .scale = flux_ * aimed_ * left_[2] / static_cast<double>(rays),
            .unit = weighted_ ? 1.0 / WEIGHT_ONE : 1,
            .unit_of_squares = weighted_ ? 1.0 / 16777216.0 : 1,
            .count = static_cast<double>(rays)};
}

Image Accounts::image(PixelLight pixels, std::span<const std::uint64_t> ledger_numbers, std::uint64_t rays) const {
    Image image;
    image.flux = std::move(pixels.flux);
    image.standard_error = std::move(pixels.standard_error);
    image.ledger = ledger(ledger_numbers, rays);
    image.rays = rays;
    image.detected = ledger_numbers[PATH_DETECTED];
    double counted = 0;
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        counted += static_cast<double>(ledger_numbers[slot]);
        image.crossings += static_cast<double>(ledger_numbers[slot]) * slots_[slot].crossings;
    }
    if (weighted_) {
        // A path's own light and its survivor, counted separately, crossed the illumination together once.
        image.crossings -= (counted - static_cast<double>(rays)) * slots_[PATH_ESCAPED].crossings;
    }
    return image;
}

} // namespace vkfv::trace
