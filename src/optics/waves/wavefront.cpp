#include "optics/waves/wavefront.hpp"

#include "core/mathematics/units.hpp"
#include "core/threads/parallel_list.hpp"
#include "optics/aim/detector_view.hpp"
#include "optics/aim/farthest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace vkfv::optics {

namespace {

constexpr std::size_t azimuths = 144;

double axial(double index, glm::dvec2 p) {
    return std::sqrt(std::max(0.0, index * index - glm::dot(p, p)));
}

// The centroid of the light that passes; none if a ray there does not pass.
std::optional<glm::dvec2> middle_of_light(const DetectorView& view) {
    constexpr int steps = 32; // from the axis to the largest direction cosine
    glm::dvec2 sum(0);
    int count = 0;
    for (int j = -steps; j <= steps; ++j) {
        for (int i = -steps; i <= steps; ++i) {
            const glm::dvec2 p = view.index / steps * glm::dvec2(i, j);
            if (i * i + j * j < steps * steps && view.trace(p, 1)) {
                sum += p;
                ++count;
            }
        }
    }
    const glm::dvec2 middle = sum / std::max(1.0, static_cast<double>(count));
    return count > 0 && view.trace(middle, 1) ? std::optional(middle) : std::nullopt;
}

double horner(const std::vector<double>& coefficients, double at) {
    double sum = 0;
    for (std::size_t k = coefficients.size(); k-- > 0;) {
        sum = sum * at + coefficients[k];
    }
    return sum;
}

double slope_of_horner(const std::vector<double>& coefficients, double at) {
    double sum = 0;
    for (std::size_t k = coefficients.size(); k-- > 1;) {
        sum = sum * at + static_cast<double>(k) * coefficients[k];
    }
    return sum;
}

// The factor of Wavefront::defocus() that, when subtracted, leaves the least variance.
double defocus_of(const std::vector<double>& path, const std::vector<double>& defocus,
                  const std::vector<double>& weights) {
    const auto weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
    double count = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        count += weight(i);
    }
    double mean_path = 0;
    double mean_defocus = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        mean_path += weight(i) * path[i] / count;
        mean_defocus += weight(i) * defocus[i] / count;
    }
    double both = 0;
    double square = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        both += weight(i) * (path[i] - mean_path) * (defocus[i] - mean_defocus);
        square += weight(i) * (defocus[i] - mean_defocus) * (defocus[i] - mean_defocus);
    }
    return square > 0 ? both / square : 0;
}

} // namespace

Wavefront::Wavefront(const Instrument& instrument, const SpectralNode& wavelength, glm::dvec2 field, double height)
    : Wavefront(imaging_of(instrument), instrument.first_order.magnification, instrument.first_order.best_focus_offset,
                wavelength, field, height) {}

Wavefront::Wavefront(const Imaging& imaging, double magnification, double focus, const SpectralNode& wavelength,
                     glm::dvec2 field, double height)
    : wavelength_(wavelength.wavelength_um * mm_per_um), weight_(wavelength.weight), height_(height),
      detector_point_(magnification * field), rims_(azimuths, 0.0) {
    if (imaging.symmetric && field.y != 0) {
        along_ = glm::normalize(field);
        field = {glm::length(field), 0};
    }
    const Imaging alone = at_wavelength(imaging, wavelength.spectral);
    index_ = alone.train.front().index_before;
    chief_ = index_ * imaging.chief_cosines(field);
    axial_chief_ = axial(index_, chief_);
    DetectorView view{.imaging = alone,
                      .index = index_,
                      .magnification = magnification,
                      .plane = focus,
                      .detector = magnification * field,
                      .guess = field};
    const auto chief = view.trace(chief_, 0);
    object_point_ = view.guess = chief ? chief->object_point : field;
    // A symmetric train's pupil is round on the axis, and mirror symmetric at a point of the x axis.
    round_ = imaging.symmetric && field == glm::dvec2(0);
    mirrored_ = imaging.symmetric;
    if (!view.trace(chief_, 1)) {
        if (const auto middle = middle_of_light(view)) {
            chief_ = {middle->x, mirrored_ ? 0 : middle->y};
            axial_chief_ = axial(index_, chief_);
            object_point_ = view.trace(chief_, 0)->object_point;
        }
    }
    // Images depend on the last bit of the rim on the axis; in the field a relative 5e-10 of the search range is
    // enough.
    const int bisections = field == glm::dvec2(0) ? 45 : 26;
    const auto rim_at = [&](int azimuth, double limit) {
        const glm::dvec2 direction = direction_of(2 * pi * azimuth / static_cast<double>(azimuths));
        const auto excess = [&](double radius) { return view.excess(chief_ + radius * direction); };
        const double all = index_ + glm::length(chief_);
        if (limit < all) { // the limit may lie inside the region that passes
            if (const auto near = farthest(limit, excess, bisections); near && *near < limit) {
                return *near;
            }
        }
        return farthest(all, excess, bisections).value_or(0);
    };
    // Most pupils have similar rims, so the first one limits the search for the others; rims further out are also
    // found, in more steps.
    constexpr double further_out = 1.25;
    const double first_rim = rim_at(0, index_ + glm::length(chief_));
    const auto other_rims = parallel_list(round_      ? 0
                                          : mirrored_ ? static_cast<int>(azimuths / 2)
                                                      : static_cast<int>(azimuths - 1),
                                          [&](int other) { return rim_at(other + 1, further_out * first_rim); });
    std::vector<double> own_rims = {first_rim};
    own_rims.insert(own_rims.end(), other_rims.begin(), other_rims.end());
    for (std::size_t i = 0; i < azimuths; ++i) {
        rims_[i] = own_rims[round_ ? 0 : mirrored_ ? std::min(i, azimuths - i) : i];
    }
    largest_rim_ = *std::ranges::max_element(rims_);
    smallest_rim_ = *std::ranges::min_element(rims_);
    if (smallest_rim_ > 0) {
        fit(view.imaging, view.detector, magnification, focus);
    } else {
        largest_rim_ = 0;
        std::ranges::fill(rims_, 0.0);
    }
}

struct Wavefront::Samples {
    std::vector<glm::dvec2> places; // in the unit disc
    std::vector<double> defocus;
    std::vector<double> weights{}; // empty: equal weights
    std::vector<double> path{};    // W, mm
    std::vector<double> slope_x{};
    std::vector<double> slope_y{};
};

// Rays that fill the pupil, denser towards its rim as the fit needs them. In a mirror-symmetric pupil the rays of one
// half count twice; in a round pupil rays on the x axis are enough.
Wavefront::Samples Wavefront::sample(const DetectorView& view, int rings, int spokes, double turn) const {
    Samples samples;
    const auto chief = view.trace(chief_, 0);
    const bool half = mirrored_ && !round_;
    if (round_) {
        spokes = 2;
        turn = 0;
    }
    for (int spoke = 0; chief && spoke < spokes; ++spoke) {
        const double place = spoke + turn;
        if (half && 2 * place > spokes) {
            break;
        }
        const double azimuth = 2 * pi * place / spokes;
        // The factor keeps the ray within the rim, which is interpolated linearly between azimuths.
        const double rim = (1 - 1e-9) * own_rim(azimuth);
        for (int ring = 0; ring < rings; ++ring) {
            const glm::dvec2 p = chief_ + rim * std::cos(pi * ring / (2.0 * rings)) * direction_of(azimuth);
            if (const auto traced = view.trace(p, 0)) {
                samples.places.push_back((p - chief_) / largest_rim_);
                samples.defocus.push_back(defocus(p));
                samples.path.push_back(chief->path_length - traced->path_length -
                                       glm::dot(p, traced->object_point - chief->object_point));
                samples.slope_x.push_back(traced->slope.x - chief->slope.x);
                samples.slope_y.push_back(traced->slope.y - chief->slope.y);
                if (half) {
                    samples.weights.push_back(place == 0 || 2 * place == spokes ? 1 : 2);
                }
            }
        }
    }
    return samples;
}

void Wavefront::fit(const Imaging& imaging, glm::dvec2 detector, double magnification, double focus) {
    const DetectorView view{.imaging = imaging,
                            .index = index_,
                            .magnification = magnification,
                            .plane = focus,
                            .detector = detector,
                            .guess = object_point_};
    const auto chief = view.trace(chief_, 0);
    chief_slope_ = chief ? chief->slope : glm::dvec2(0);
    constexpr int degrees[] = {8, 12, 16, 20, 24};
    for (const int degree : degrees) {
        Samples samples = sample(view, degree / 2 + 3, 2 * degree + 4, 0);
        defocus_ = defocus_of(samples.path, samples.defocus, samples.weights);
        for (std::size_t i = 0; i < samples.places.size(); ++i) {
            samples.path[i] -= defocus_ * samples.defocus[i];
        }
        const std::size_t terms = round_      ? static_cast<std::size_t>(degree + 1)
                                  : mirrored_ ? static_cast<std::size_t>((degree / 2 + 1) * (degree / 2 + 1))
                                              : PlanePolynomial::terms(degree);
        if (samples.places.size() < terms) {
            break;
        }
        if (samples.weights.empty()) {
            auto fitted = fit_polynomials(degree, samples.places, {samples.path, samples.slope_x, samples.slope_y},
                                          round_ ? Parity::none : Parity::any);
            path_ = std::move(fitted[0]);
            slope_x_ = std::move(fitted[1]);
            slope_y_ = std::move(fitted[2]);
        } else {
            auto even =
                fit_polynomials(degree, samples.places, {samples.path, samples.slope_x}, Parity::even, samples.weights);
            auto odd = fit_polynomials(degree, samples.places, {samples.slope_y}, Parity::odd, samples.weights);
            path_ = std::move(even[0]);
            slope_x_ = std::move(even[1]);
            slope_y_ = std::move(odd[0]);
        }
        // Piston and tilt are 0 by definition.
        const auto coefficients = path_.coefficients();
        coefficients[0] = coefficients[1] = coefficients[static_cast<std::size_t>(degree) + 1] = 0;
        // Rays that were not fitted test whether the degree suffices.
        constexpr double enough = 1e-6;       // wavelengths
        constexpr double enough_slope = 5e-6; // relative to the largest slope
        const Samples others = sample(view, degree / 2 + 1, 2 * degree + 1, 0.5);
        double path_error = 0;
        double slope_error = 0;
        double largest_slope = 0;
        for (std::size_t i = 0; i < others.places.size(); ++i) {
            const glm::dvec2 place = others.places[i];
            const glm::dvec2 slope(others.slope_x[i], others.slope_y[i]);
            path_error =
                std::max(path_error, std::abs(path_.value(place) + defocus_ * others.defocus[i] - others.path[i]));
            slope_error =
                std::max(slope_error, glm::length(glm::dvec2(slope_x_.value(place), slope_y_.value(place)) - slope));
            largest_slope = std::max(largest_slope, glm::length(slope));
        }
        if (path_error < enough * wavelength_ && slope_error < enough_slope * largest_slope) {
            break;
        }
    }
    // The coefficient of (x^2 + y^2)^k is that of x^(2 k).
    for (std::size_t k = 0; 2 * k < path_.along_x().size(); ++k) {
        round_path_.push_back(path_.along_x()[2 * k]);
    }
    for (std::size_t k = 0; 2 * k + 1 < slope_x_.along_x().size(); ++k) {
        round_slope_.push_back(slope_x_.along_x()[2 * k + 1]);
    }
}

Wavefront Wavefront::at_height(double height) const {
    Wavefront other = *this;
    other.height_ = height;
    return other;
}

double Wavefront::rim(double azimuth) const {
    return own_rim(along_.y == 0 ? azimuth : azimuth - std::atan2(along_.y, along_.x));
}

double Wavefront::own_rim(double azimuth) const {
    const double turns = azimuth / (2 * pi);
    const double place = (turns - std::floor(turns)) * azimuths;
    const auto before = std::min(static_cast<std::size_t>(place), azimuths - 1);
    const double share = place - static_cast<double>(before);
    return (1 - share) * rims_[before] + share * rims_[(before + 1) % azimuths];
}

bool Wavefront::passes(glm::dvec2 p) const {
    const glm::dvec2 from_chief = own(p) - chief_;
    const double square = glm::dot(from_chief, from_chief);
    if (square > largest_rim_ * largest_rim_) {
        return false;
    }
    // Most points lie within the smallest rim and need no interpolation.
    if (square <= smallest_rim_ * smallest_rim_) {
        return true;
    }
    const double rim = own_rim(std::atan2(from_chief.y, from_chief.x));
    return square <= rim * rim;
}

double Wavefront::area() const {
    double sum = 0;
    for (std::size_t i = 0; i < azimuths; ++i) {
        // The mean of the square of a radius that is linear in the azimuth.
        const double a = rims_[i];
        const double b = rims_[(i + 1) % azimuths];
        sum += (a * a + a * b + b * b) / 3;
    }
    return sum * pi / azimuths;
}

double Wavefront::range() const {
    constexpr int spokes = 24;
    double least = 0;
    double most = 0;
    for (int i = 0; i < spokes; ++i) {
        const double azimuth = 2 * pi * i / spokes;
        for (const double share : {0.25, 0.5, 0.75, 0.9, 1.0}) {
            const double path = own_path(chief_ + share * own_rim(azimuth) * direction_of(azimuth));
            least = std::min(least, path);
            most = std::max(most, path);
        }
    }
    return most - least;
}

double Wavefront::defocus(glm::dvec2 p) const {
    return axial(index_, p) - axial_chief_ + glm::dot(chief_, p - chief_) / axial_chief_;
}

glm::dvec2 Wavefront::object_point() const {
    return turned(object_point_ + height_ / axial_chief_ * chief_);
}

double Wavefront::path(glm::dvec2 p) const {
    return own_path(own(p));
}

double Wavefront::own_path(glm::dvec2 p) const {
    const glm::dvec2 place = (p - chief_) / largest_rim_;
    const double rest = round_ ? horner(round_path_, glm::dot(place, place)) : path_.value(place);
    return rest + (defocus_ + height_) * defocus(p);
}

double Wavefront::path_of_height(glm::dvec2 p) const {
    return defocus(own(p));
}

glm::dvec2 Wavefront::displacement_of_height(glm::dvec2 of) const {
    const glm::dvec2 p = own(of);
    return turned(chief_ / axial_chief_ - p / axial(index_, p));
}

glm::dvec2 Wavefront::displacement(glm::dvec2 of) const {
    const glm::dvec2 p = own(of);
    const glm::dvec2 place = (p - chief_) / largest_rim_;
    const glm::dvec2 rest =
        round_ ? 2 * slope_of_horner(round_path_, glm::dot(place, place)) * place : path_.gradient(place);
    return turned(rest / largest_rim_ - (defocus_ + height_) * (p / axial(index_, p) - chief_ / axial_chief_));
}

glm::dvec2 Wavefront::image_slope(glm::dvec2 p) const {
    const glm::dvec2 place = (own(p) - chief_) / largest_rim_;
    return turned(round_ ? horner(round_slope_, glm::dot(place, place)) * place
                         : glm::dvec2(slope_x_.value(place), slope_y_.value(place)));
}

std::vector<Wavefront> wavefronts_of(const Instrument& instrument, std::span<const SpectralNode> wavelengths,
                                     glm::dvec2 field) {
    auto traced = parallel_list(static_cast<int>(wavelengths.size()), [&](int k) {
        return std::optional<Wavefront>(std::in_place, instrument, wavelengths[static_cast<std::size_t>(k)], field);
    });
    std::vector<Wavefront> wavefronts;
    wavefronts.reserve(traced.size());
    for (auto& one : traced) {
        wavefronts.push_back(*std::move(one));
    }
    return wavefronts;
}

} // namespace vkfv::optics
