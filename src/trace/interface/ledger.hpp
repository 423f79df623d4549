// The ledger of an image, made from counts of fates.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "trace/interface/pixel_estimate.hpp"
#include "trace/interface/tracer.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vkfv::trace {

// An entry that belongs to no surface.
Ledger::Entry plain_entry(Ledger::Status status, double power, std::uint64_t rays);

// The share of the rays leaving the specimen that came through the pupil; none where no ray left it. It needs a ledger
// that counts rays of equal weight: neither the backward estimator's nor that of directed scatter gives it.
std::optional<double> share_collected(const Ledger& ledger);

// Converts the counts of an image to light and its ledger.
class Accounts {
  public:
    // The sequential trace: rays pass the trains of surfaces, and the splitter's shares of them are computed.
    // directed_scatter: the numbers include sums of weights.
    explicit Accounts(const optics::Instrument& instrument, bool directed_scatter = false);
    // The non-sequential trace: every ray keeps its power to its end, at one of these elements.
    Accounts(const optics::Instrument& instrument, const std::vector<std::string>& element_names);

    // The number of slots for physics::ledger_slot(), rounded up to whole steps: a kernel is compiled for each number,
    // which takes a processor seconds, and instruments of about as many surfaces share it. Slots beyond the needed ones
    // stay 0.
    std::size_t slots() const { return (slots_.size() + slot_step - 1) / slot_step * slot_step; }

    // The numbers that a trace keeps. With directed scatter the slots' sums of weights (units of 1 / WEIGHT_ONE) follow
    // their counts, and then the sum over the paths of physics::weight_square() of each path's total; a pixel has its
    // sum of weights and the sum of their squares (units of 2^-24).
    std::size_t ledger_numbers() const { return weighted_ ? 2 * slots() + 1 : slots(); }
    std::size_t pixel_numbers() const { return pixels_.count() * (weighted_ ? 2 : 1); }

    // The rule that makes light of the pixels' numbers.
    estimate::EstimateRule rule(std::uint64_t rays) const;
    // The image with its ledger. Light that was not aimed at, and light that the splitter turns away in the sequential
    // trace, are added analytically, so the ledger closes exactly when every launched ray has one fate; with directed
    // scatter, whose paths add 1 to it in expectation, it closes within residual_error.
    Image image(PixelLight pixels, std::span<const std::uint64_t> ledger_numbers, std::uint64_t rays) const;

    // W on the detector for each unit of a pixel's number.
    double power_per_number(std::uint64_t rays) const;

  private:
    // A surface or element at which a ray may end.
    struct Surface {
        std::string name;
        Train train = Train::none;
        int index = 0;                   // as Ledger::Entry::surface
        std::size_t splitter_passes = 0; // passes of the splitter of a ray that ends here
        int crossings = 0;               // surfaces that a ray ending here has crossed in sequence, this one included
    };
    struct Slot {
        Ledger::Entry entry; // without power and rays
        std::size_t splitter_passes = 0;
        int crossings = 0;
    };
    static constexpr std::size_t slot_step = 64;

    static std::vector<Surface> surfaces_of(const optics::Instrument& instrument);
    // Adds the slots of all statuses. illumination, both: surfaces of the illumination, and of both trains together.
    void add_slots(const std::vector<Surface>& surfaces, int illumination, int both);
    Ledger ledger(std::span<const std::uint64_t> numbers, std::uint64_t rays) const;

    double flux_;  // W
    double aimed_; // share of the emitted flux
    // The share of a ray's initial power that is left after 0, 1 and 2 passes of the splitter.
    std::array<double, 3> left_ = {1.0, 1.0, 1.0};
    ImageSize pixels_;
    bool weighted_ = false;
    std::vector<Slot> slots_;
};

} // namespace vkfv::trace
