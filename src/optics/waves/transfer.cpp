#include "optics/waves/transfer.hpp"

#include "core/mathematics/units.hpp"
#include "optics/waves/quadrature.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::optics {

namespace {

struct Chord {
    double from = 0;
    double to = 0;
    double length() const { return to - from; }
};

// A pupil about its chief ray, cut into chords parallel to one direction: at() is the chord at a given distance across
// it.
class Chords {
  public:
    Chords(const Wavefront& wavefront, double along) : wavefront_(wavefront), along_(along) {
        round_ = wavefront.largest_rim() == wavefront.smallest_rim();
        constexpr int steps = 720;
        for (int i = 0; i < steps; ++i) {
            const double angle = 2 * pi * i / steps;
            highest_ = across(angle) > across(highest_) ? angle : highest_;
            lowest_ = across(angle) < across(lowest_) ? angle : lowest_;
        }
        lowest_ -= lowest_ > highest_ ? 2 * pi : 0;
    }

    double top() const { return round_ ? wavefront_.largest_rim() : across(highest_); }
    double bottom() const { return round_ ? -wavefront_.largest_rim() : across(lowest_); }

    Chord at(double height) const {
        if (round_) {
            const double rim = wavefront_.largest_rim();
            const double half = std::sqrt(std::max(0.0, (rim - height) * (rim + height)));
            return {.from = -half, .to = half};
        }
        return {.from = side(height, lowest_ + 2 * pi, highest_), .to = side(height, lowest_, highest_)};
    }

  private:
    double across(double angle) const { return wavefront_.rim(along_ + angle) * std::sin(angle); }

    double side(double height, double low, double high) const {
        for (int i = 0; i < 48; ++i) {
            const double middle = 0.5 * (low + high);
            (across(middle) < height ? low : high) = middle;
        }
        return wavefront_.rim(along_ + low) * std::cos(low);
    }

    const Wavefront& wavefront_;
    double along_;
    bool round_ = false;
    double highest_ = pi / 2; // rad, from `along_` to the direction in which the pupil reaches highest
    double lowest_ = -pi / 2;
};

// The farthest height between `inside` and `outside` at which the pupil and its copy shifted by `shift` overlap.
double reach_of_overlap(const Chords& chords, double shift, double inside, double outside) {
    if (chords.at(outside).length() >= shift) {
        return outside;
    }
    for (int i = 0; i < 48; ++i) {
        const double middle = 0.5 * (inside + outside);
        (chords.at(middle).length() >= shift ? inside : outside) = middle;
    }
    return inside;
}

} // namespace

std::complex<double> transfer(const Wavefront& wavefront, glm::dvec2 frequency) {
    const double length = glm::length(frequency);
    if (length == 0 || wavefront.largest_rim() == 0) {
        return length == 0 ? 1 : 0;
    }
    const glm::dvec2 along = frequency / length;
    const glm::dvec2 across(-along.y, along.x);
    const double shift = wavefront.wavelength() * length;
    const Chords chords(wavefront, std::atan2(along.y, along.x));
    // If pupils overlap at all, they do so at the widest chord.
    constexpr int heights = 64;
    double widest = 0.5 * (chords.bottom() + chords.top());
    for (int i = 1; i < heights; ++i) {
        const double height = chords.bottom() + (chords.top() - chords.bottom()) * i / heights;
        widest = chords.at(height).length() > chords.at(widest).length() ? height : widest;
    }
    if (chords.at(widest).length() <= shift) {
        return 0;
    }
    const double top = reach_of_overlap(chords, shift, widest, chords.top());
    const double bottom = reach_of_overlap(chords, shift, widest, chords.bottom());
    // The nodes resolve the phase, whose range is at most twice that of W; with this number Gauss' rule converges fast.
    constexpr int fewest = 16;
    const int count = std::min(400, fewest + static_cast<int>(7 * wavefront.range() / wavefront.wavelength()));
    const auto nodes = gauss_legendre(count);
    const double wave_number = 2 * pi / wavefront.wavelength();
    std::complex<double> sum = 0;
    for (const QuadratureNode& row : nodes) {
        // The substitution by the sine of an angle removes the square root at a round pupil's ends.
        const double half = 0.5 * (top - bottom);
        const double height = 0.5 * (top + bottom) + half * std::sin(0.5 * pi * row.place);
        const double row_weight = row.weight * 0.5 * pi * half * std::cos(0.5 * pi * row.place);
        const Chord chord = chords.at(height);
        const double width = 0.5 * (chord.length() - shift);
        const glm::dvec2 middle = wavefront.chief() + height * across + 0.5 * (chord.from + chord.to) * along;
        for (const QuadratureNode& node : nodes) {
            const glm::dvec2 p = middle + width * node.place * along;
            const double difference = wavefront.path(p + 0.5 * shift * along) - wavefront.path(p - 0.5 * shift * along);
            sum += row_weight * node.weight * width * std::polar(1.0, -wave_number * difference);
        }
    }
    return sum / wavefront.area();
}

} // namespace vkfv::optics
