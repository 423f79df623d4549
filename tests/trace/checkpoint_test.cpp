// An exposure that goes on from a checkpoint, or that several devices counted, has the bits of one that was traced at
// once.
#include "trace/interface/checkpoint.hpp"

#include "trace/device/device_tracer.hpp"
#include "trace/interface/tracer_pool.hpp"
#include "trace/microscope.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

namespace vkfv::test {
namespace {

// Keeps checkpoints as often as it is given one, or gives the one with which it was made.
class InMemory final : public trace::Checkpoints {
  public:
    InMemory() = default;
    explicit InMemory(trace::Checkpoint found) : found_(std::move(found)) {}

    double interval() const override { return 0; }
    std::optional<trace::Checkpoint> load(std::uint32_t /*image*/) const override { return found_; }
    void save(std::uint32_t /*image*/, const trace::Checkpoint& checkpoint) const override {
        kept.push_back(checkpoint);
    }

    mutable std::vector<trace::Checkpoint> kept;

  private:
    std::optional<trace::Checkpoint> found_;
};

struct Form {
    std::string name;
    bool nonsequential = false;
    bool directed = false;
    bool waves = false;
    bool backward = false;
    bool mixed = false; // light of a disc and a ring
};

void PrintTo(const Form& form, std::ostream* to) {
    *to << form.name;
}

std::unique_ptr<trace::Tracer> tracer_of(const Form& form) {
    auto description = ideal_microscope_description();
    description.detector_pixels = ImageSize::square(32);
    description.detector_width = 0.4; // so that waves take few parts of a pixel
    description.turned = form.backward;
    if (form.mixed) {
        optics::SourceDescription ring;
        ring.ring = optics::RingLightDescription{
            .distance = 25, .elevation = 0.8, .width = 1, .segments = 1, .fill = 1, .on = {true}, .lit_radius = 0.1};
        description.further_sources = {ring};
    }
    static std::vector<std::unique_ptr<optics::Instrument>> instruments;
    instruments.push_back(std::make_unique<optics::Instrument>(optics::assemble(description)));
    trace::TraceOptions options;
    options.estimator = form.backward ? trace::Estimator::backward : trace::Estimator::forward;
    options.rays = 1 << 15;
    options.batch = 2500;
    options.nonsequential = form.nonsequential;
    options.directed_scatter = form.directed;
    if (form.waves) {
        options.waves = optics::WaveOptions{};
    }
    return trace::make_device_tracer(*instruments.back(), rough_specimen(), options);
}

void expect_same(const trace::Image& one, const trace::Image& other) {
    EXPECT_EQ(one.flux.values, other.flux.values);
    EXPECT_EQ(one.standard_error.values, other.standard_error.values);
    EXPECT_EQ(one.detected, other.detected);
    EXPECT_EQ(one.ledger.residual_error, other.ledger.residual_error);
    ASSERT_EQ(one.ledger.entries.size(), other.ledger.entries.size());
    for (std::size_t k = 0; k < one.ledger.entries.size(); ++k) {
        EXPECT_EQ(one.ledger.entries[k].power, other.ledger.entries[k].power);
    }
}

class Checkpoint : public testing::TestWithParam<Form> {};

TEST_P(Checkpoint, GoesOnToTheSameBits) {
    const auto tracer = tracer_of(GetParam());
    const trace::Image whole = tracer->expose(0.002, 3);
    const auto keeper = std::make_shared<InMemory>();
    expect_same(whole, tracer->begin(0.002, 3, keeper).get());
    ASSERT_FALSE(keeper->kept.empty());
    // The numbers that other exposures leave in the device's memory do not count.
    tracer->expose(-0.001, 1);
    const auto& kept = keeper->kept;
    const auto later = tracer_of(GetParam());
    for (const auto* found : {&kept.front(), &kept[kept.size() / 2], &kept.back()}) {
        const auto another = std::make_shared<InMemory>(*found);
        expect_same(whole, later->begin(0.002, 3, another).get());
        if (!another->kept.empty()) {
            EXPECT_GT(another->kept.front().done, found->done); // it did not begin anew
        }
    }
    // The checkpoint's counts are taken up: the wrong twin, whose pixels have more, makes another image.
    trace::Checkpoint twin = kept.front();
    for (auto& number : twin.numbers) {
        number += 1000;
    }
    EXPECT_NE(whole.flux.values, tracer->begin(0.002, 3, std::make_shared<InMemory>(twin)).get().flux.values);
    // A checkpoint of another detector is not taken up.
    twin.numbers.pop_back();
    expect_same(whole, tracer->begin(0.002, 3, std::make_shared<InMemory>(twin)).get());
}

TEST_P(Checkpoint, PartsOfSeveralDevicesGiveTheSameBits) {
    const auto tracer = tracer_of(GetParam());
    const trace::Image whole = tracer->expose(0.002, 3);
    // Each part counts its own paths.
    const auto first = tracer->count(0.002, 3, 0, tracer->units() / 3);
    const auto second = tracer->count(0.002, 3, tracer->units() / 3, tracer->units());
    EXPECT_NE(first.numbers, second.numbers);
    EXPECT_GT(first.device_seconds, 0);
    std::vector<std::unique_ptr<trace::Tracer>> tracers;
    for (int k = 0; k < 2; ++k) {
        tracers.push_back(tracer_of(GetParam()));
    }
    const auto pool = trace::make_tracer_pool(std::move(tracers), 1);
    auto other = pool->begin(-0.001, 1);
    auto same = pool->begin(0.002, 3);
    EXPECT_NE(whole.flux.values, other.get().flux.values);
    const trace::Image joined = same.get();
    expect_same(whole, joined);
    EXPECT_GT(joined.device_seconds, 0);
    EXPECT_GE(joined.seconds, joined.device_seconds); // both are times of the whole exposure, not of its last step
}

INSTANTIATE_TEST_SUITE_P(
    OfEveryForm, Checkpoint,
    testing::Values(Form{.name = "forward"}, Form{.name = "nonsequential", .nonsequential = true},
                    Form{.name = "directed", .directed = true}, Form{.name = "waves", .waves = true},
                    Form{.name = "backward", .backward = true},
                    Form{.name = "backward_waves", .waves = true, .backward = true},
                    Form{.name = "mixed", .mixed = true},
                    Form{.name = "mixed_backward_waves", .waves = true, .backward = true, .mixed = true}),
    [](const auto& form) { return form.param.name; });

TEST(CheckpointClock, WithoutCheckpointsNoneIsDue) {
    EXPECT_FALSE(trace::CheckpointClock(nullptr).due());
    const InMemory often;
    trace::CheckpointClock clock(&often);
    EXPECT_TRUE(clock.due());
    // A checkpoint that took a second to keep is not due again for twenty.
    clock.kept(trace::CheckpointClock::Clock::now() - std::chrono::seconds(1));
    EXPECT_FALSE(clock.due());
}

} // namespace
} // namespace vkfv::test
