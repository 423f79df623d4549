// The device's images of an interferometer against the host's, and against themselves in other groups.
#include "fields/device_interferometer.hpp"
#include "fields/interferometers.hpp"
#include "vulkan/device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <vector>

namespace vkfv {
namespace {

class DeviceInterferometer : public testing::Test {
  protected:
    static constexpr fields::FocalRange range{-0.001, 0.001};

    DeviceInterferometer() : tilted_({.tilt = {0.002, -0.001}}) {}

    std::unique_ptr<trace::Tracer> made_by(fields::FieldsBy by) const {
        return fields::make_device_interferometer(opened_, instrument_, description_, step_, tilted_, range, by);
    }

    optics::InstrumentDescription description_ =
        test::interferometer(0.3, 0.5, 24, 20, optics::Spectrum::gaussian(0.55, 0.1));
    optics::Instrument instrument_ = optics::assemble(description_);
    specimen::Specimen step_ = test::step_of(0.4, 40);
    fields::ReferenceArm tilted_;
    vulkan::OpenedDevice opened_ = vulkan::begin_to_open(vulkan::DeviceOptions{});
};

TEST_F(DeviceInterferometer, HasTheHostsImages) {
    const auto host = fields::make_host_interferometer(instrument_, description_, step_, tilted_, range);
    for (const auto by : {fields::FieldsBy::device, fields::FieldsBy::host}) {
        const auto device = made_by(by);
        for (const double height : {-0.0004, 0.0, 0.0001}) {
            const auto expected = host->expose(height, 0).flux, found = device->expose(height, 0).flux;
            const double brightest = std::ranges::max(expected.values);
            double worst = 0;
            for (std::size_t k = 0; k < expected.values.size(); ++k) {
                worst = std::max(worst, std::abs(found.values[k] - expected.values[k]) / brightest);
            }
            EXPECT_LT(worst, 2e-5); // single precision: 2e-7 a sum of some 50 waves with phases of 50 turns
        }
    }
}

TEST_F(DeviceInterferometer, HasTheSameBitsInAnyGroup) {
    const auto device = made_by(fields::FieldsBy::device), again = made_by(fields::FieldsBy::device);
    std::vector<double> heights;
    for (int k = 0; k < 13; ++k) {
        heights.push_back(-0.0006 + 0.0001 * k);
    }
    std::vector<std::future<trace::Image>> under_way;
    for (const double height : heights) {
        under_way.push_back(device->begin(height, 0));
    }
    for (std::size_t k = heights.size(); k-- > 0;) { // the last is asked for first
        const auto flux = under_way[k].get().flux.values;
        EXPECT_EQ(flux, device->expose(heights[k], 0).flux.values);
        EXPECT_EQ(flux, again->expose(heights[k], 5).flux.values);
    }
    EXPECT_EQ(device->identity().toml(), again->identity().toml());
    EXPECT_NE(device->identity().toml(), made_by(fields::FieldsBy::host)->identity().toml());
}

} // namespace
} // namespace vkfv
