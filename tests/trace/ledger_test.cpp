// An entry of the ledger has the status, the train and the surface of which its name speaks.
#include "trace/interface/ledger.hpp"
#include "trace/microscope.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <vector>

namespace vkfv {
namespace {

using trace::Ledger;
using Status = Ledger::Status;
using trace::Train;

Ledger ledger_of(const trace::Accounts& accounts, std::uint64_t rays) {
    std::vector<std::uint64_t> numbers(accounts.ledger_numbers());
    for (std::size_t slot = 0; slot < numbers.size(); ++slot) {
        numbers[slot] = slot + 1;
    }
    return accounts.image({}, numbers, rays).ledger;
}

TEST(Ledger, TellsTrainAndSurfaceAsItsNamesDo) {
    const auto instrument = test::microscope();
    const Ledger ledger = ledger_of(trace::Accounts(instrument), 1000);
    int of_surfaces = 0;
    for (const Ledger::Entry& entry : ledger.entries) {
        const bool at_surface = entry.status >= Status::vignetted && entry.status <= Status::lost_in_reflection;
        EXPECT_EQ(entry.surface >= 0, at_surface) << entry.name;
        EXPECT_EQ(entry.train != Train::none, at_surface) << entry.name;
        if (at_surface) {
            const char* train = entry.train == Train::imaging ? "imaging" : "illumination";
            EXPECT_NE(entry.name.find(fmt::format(" at {} {} (", train, entry.surface + 1)), std::string::npos)
                << entry.name;
            ++of_surfaces;
        }
    }
    EXPECT_EQ(of_surfaces, 4 * static_cast<int>(instrument.surfaces.size()));
    EXPECT_EQ(ledger.entries.front().status, Status::detected);
    EXPECT_EQ(ledger.entries[1].status, Status::not_aimed_at);
}

TEST(Ledger, TellsElementsOfTheRoomWithoutATrain) {
    const Ledger ledger = ledger_of(trace::Accounts(test::microscope(), {"objective: 1", "objective: 2"}), 1000);
    const Ledger::Entry& last = ledger.entries.back();
    EXPECT_EQ(last.name, "lost in reflection at objective: 2");
    EXPECT_EQ(last.status, Status::lost_in_reflection);
    EXPECT_EQ(last.train, Train::none);
    EXPECT_EQ(last.surface, 1);
}

// Instruments of about as many surfaces have kernels in common; the numbers beyond an instrument's own are not read.
TEST(Ledger, HasRoomInWholeSteps) {
    const auto instrument = test::microscope();
    const std::size_t used = physics::f64::PATH_STATUS_COUNT + 4 * instrument.surfaces.size();
    for (const bool directed : {false, true}) {
        const trace::Accounts accounts(instrument, directed);
        ASSERT_EQ(accounts.slots() % 64, 0u);
        ASSERT_GE(accounts.slots(), used);
        ASSERT_LT(accounts.slots(), used + 64);
        std::vector<std::uint64_t> numbers(accounts.ledger_numbers(), 16);
        const Ledger ledger = accounts.image({}, numbers, 1000).ledger;
        for (std::size_t beyond = used; beyond < accounts.slots(); ++beyond) {
            numbers[beyond] = 1000;
            if (directed) {
                numbers[accounts.slots() + beyond] = 1000;
            }
        }
        EXPECT_EQ(accounts.image({}, numbers, 1000).ledger.residual(), ledger.residual());
        numbers[used - 1] += 1; // the twin: the last that is read
        numbers[directed ? accounts.slots() + used - 1 : used - 1] += 16;
        EXPECT_NE(accounts.image({}, numbers, 1000).ledger.residual(), ledger.residual());
    }
}

TEST(ShareCollected, CountsTheRaysThatCameThroughThePupil) {
    Ledger ledger;
    EXPECT_FALSE(trace::share_collected(ledger).has_value());
    ledger.entries = {trace::plain_entry(Status::detected, 0, 10),
                      trace::plain_entry(Status::beside_detector, 0, 5),
                      trace::plain_entry(Status::outside_pupil, 0, 60),
                      trace::plain_entry(Status::bounce_limit, 0, 20),
                      trace::plain_entry(Status::absorbed, 0, 1000),
                      {.name = "vignetted at imaging 1",
                       .rays = 5,
                       .status = Status::vignetted,
                       .train = Train::imaging,
                       .surface = 0},
                      {.name = "vignetted at illumination 1",
                       .rays = 1000,
                       .status = Status::vignetted,
                       .train = Train::illumination,
                       .surface = 0}};
    EXPECT_EQ(trace::share_collected(ledger), 0.2);
}

} // namespace
} // namespace vkfv
