#include "scan/stage.hpp"

#include "core/mathematics/units.hpp"
#include "physics/physics.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::scan {

namespace {

// Purposes of random numbers; vibrations use the numbers from `phase` on.
enum Purpose : std::uint32_t { jitter, reading, lamp, moment, phase };
// Number of sines of equal power that represent a spectrum; their sum is nearly normal: its excess is -1.5 over this
// number.
constexpr std::size_t lines_of_spectrum = 256;
constexpr std::uint32_t of_stage = 3; // keeps these counters apart from those of paths and lattices

physics::f64::Draws draws_of(std::uint32_t seed, std::uint32_t image, std::uint32_t purpose) {
    using namespace physics::f64;
    return draws_of_bits(philox_4x32(uvec4(purpose, 0, 0, of_stage), seed, image, PHILOX_ROUNDS));
}

double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
    const auto after = std::ranges::upper_bound(x, at);
    if (after == x.begin() || after == x.end()) {
        return x.empty() ? 0 : after == x.begin() ? y.front() : y.back();
    }
    const auto k = static_cast<std::size_t>(after - x.begin());
    return std::lerp(y[k - 1], y[k], (at - x[k - 1]) / (x[k] - x[k - 1]));
}

} // namespace

bool Stage::still() const {
    Stage quiet;
    quiet.downwards = downwards;
    quiet.interval = interval;
    quiet.exposure_time = exposure_time;
    quiet.moments = moments;
    quiet.evaluate_read = evaluate_read;
    quiet.seed = seed;
    return *this == quiet;
}

StageMotion::StageMotion(const Stage& stage, std::vector<double> positions)
    : stage_(stage), positions_(std::move(positions)) {
    add_spectrum();
}

// Each line has a random place in its own part of the power, so that no two seeds have the same frequencies. The lines'
// power adds up to the spectrum's integral.
void StageMotion::add_spectrum() {
    const auto& f = stage_.vibration_frequencies;
    const auto& density = stage_.vibration_densities;
    std::vector<double> below = {0}; // power up to each point
    for (std::size_t k = 1; k < f.size(); ++k) {
        below.push_back(below.back() + 0.5 * (density[k - 1] + density[k]) * (f[k] - f[k - 1]));
    }
    if (!(below.back() > 0)) {
        return;
    }
    const double a_line = below.back() / static_cast<double>(lines_of_spectrum);
    for (std::size_t line = 0; line < lines_of_spectrum; ++line) {
        const auto purpose = static_cast<std::uint32_t>(Purpose::phase + stage_.vibrations.size());
        const double wanted = a_line * (static_cast<double>(line) + draws_of(stage_.seed, 0, purpose).u1);
        const auto after = std::ranges::upper_bound(below, wanted);
        const auto k = std::min(static_cast<std::size_t>(after - below.begin()), f.size() - 1);
        // Within a trapezium the power is quadratic in the frequency; this form of the root loses no digits.
        const double rest = wanted - below[k - 1];
        const double slope = (density[k] - density[k - 1]) / (f[k] - f[k - 1]);
        const double root = std::sqrt(std::max(density[k - 1] * density[k - 1] + 2 * slope * rest, 0.0));
        const double beyond = rest > 0 ? 2 * rest / (density[k - 1] + root) : 0;
        stage_.vibrations.push_back({.amplitude = std::sqrt(2 * a_line), .frequency = f[k - 1] + beyond});
    }
}

int StageMotion::moments() const {
    return !stage_.vibrations.empty() && stage_.exposure_time > 0 ? stage_.moments : 1;
}

double StageMotion::time_of(std::uint32_t image) const {
    const double last = positions_.empty() ? 0 : static_cast<double>(positions_.size() - 1);
    return stage_.interval * (stage_.downwards ? last - image : static_cast<double>(image));
}

double StageMotion::uniform(std::uint32_t image, std::uint32_t purpose) const {
    return draws_of(stage_.seed, image, purpose).u0;
}

// A normal random number: G. E. P. Box and M. E. Muller, Ann. Math. Statist. 29 (1958) 610.
double StageMotion::normal(std::uint32_t image, std::uint32_t purpose) const {
    const auto draws = draws_of(stage_.seed, image, purpose);
    return std::sqrt(-2 * std::log(draws.u0)) * std::cos(2 * pi * draws.u1);
}

double StageMotion::settled(double nominal, std::uint32_t image) const {
    double height = nominal;
    if (stage_.downwards && image < positions_.size()) {
        // The stage comes to the topmost position from below; downward motion begins when the slack is taken up.
        height = std::min(nominal + stage_.backlash, positions_.back());
    }
    return height + stage_.jitter * normal(image, Purpose::jitter);
}

trace::FocalPosition StageMotion::at(double nominal, std::uint32_t image, int moment) const {
    const double should_read = settled(nominal, image);
    const double periodic = stage_.periodic_amplitude == 0
                                ? 0
                                : stage_.periodic_amplitude *
                                      std::sin(2 * pi * should_read / stage_.periodic_period + stage_.periodic_phase);
    const double errors = interpolated(stage_.linearity_positions, stage_.linearity_errors, should_read) + periodic;
    trace::FocalPosition position((should_read - errors) / (1 + stage_.scale_error));
    double time = time_of(image);
    position.height += stage_.drift * time;
    // The exposure is stratified in time about its middle.
    const int count = moments();
    if (count > 1) {
        const auto number =
            static_cast<std::uint32_t>(image * static_cast<std::uint32_t>(count) + static_cast<std::uint32_t>(moment));
        time += stage_.exposure_time * ((moment + uniform(number, Purpose::moment)) / count - 0.5);
    }
    for (std::size_t k = 0; k < stage_.vibrations.size(); ++k) {
        const auto& vibration = stage_.vibrations[k];
        const double start = uniform(0, static_cast<std::uint32_t>(Purpose::phase + k));
        position.height += vibration.amplitude * std::sin(2 * pi * (vibration.frequency * time + start));
    }
    position.beside = stage_.lateral_drift * time_of(image) + stage_.tilt * nominal;
    if (stage_.runout > 0) {
        const double turn = 2 * pi * nominal / stage_.runout_period;
        position.beside += stage_.runout * glm::dvec2(std::cos(turn), std::sin(turn));
    }
    return position;
}

trace::FocalPosition StageMotion::mean(double nominal, std::uint32_t image) const {
    const int count = moments();
    trace::FocalPosition sum = at(nominal, image);
    for (int moment = 1; moment < count; ++moment) {
        sum.height += at(nominal, image, moment).height;
    }
    sum.height /= count;
    return sum;
}

double StageMotion::farthest(std::span<const double> nominal) const {
    double most = 0;
    for (std::size_t k = 0; k < nominal.size(); ++k) {
        const auto image = static_cast<std::uint32_t>(std::min(k, positions_.size()));
        for (int moment = 0; moment < moments(); ++moment) {
            most = std::max(most, std::abs(at(nominal[k], image, moment).height - nominal[k]));
        }
    }
    return most;
}

double StageMotion::reading(double nominal, std::uint32_t image) const {
    return settled(nominal, image) + stage_.reading_noise * normal(image, Purpose::reading);
}

double StageMotion::light(std::uint32_t image) const {
    return std::max(0.0, 1 + stage_.light_noise * normal(image, Purpose::lamp));
}

} // namespace vkfv::scan
