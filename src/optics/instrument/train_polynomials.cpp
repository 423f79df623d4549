#include "optics/instrument/train_polynomials.hpp"

#include "core/threads/parallel_list.hpp"
#include "core/threads/parallel_rows.hpp"
#include "optics/train/train.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <future>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace vkfv::optics {

using physics::f64::EdgePolynomial;
using physics::f64::Polynomial;
using physics::f64::POLYNOMIAL_DEGREE;
using physics::f64::POLYNOMIAL_EDGES;
using physics::f64::POLYNOMIAL_TERMS;
using physics::f64::PolynomialPassage;
using physics::f64::Ray;
using physics::f64::Surface;
using physics::f64::TrainPolynomials;
using physics::f64::TrainResult;

namespace {

constexpr double largest_place_error = 2e-4; // mm
constexpr double largest_share_of_field = 2.5e-4;
constexpr double largest_direction_error = 2e-5;
// Error bounds in units of the square of an edge's radius. Light nearer to an edge than the error is traced, and a GPU
// then spends that time for all paths traced beside it.
constexpr double wanted_edge_error = 1e-4;
constexpr double largest_traced_share = 5e-3;
// Margins in units of the square of an edge's radius: the rounding of a float, and the distance that light must keep
// from edges without a polynomial.
constexpr double float_margin = 4e-6;
constexpr double clear_of_edge = 2e-3;

// The path of one ray through the train. By symmetry its place at the source can be on the x axis.
struct Sample {
    glm::dvec3 invariants{0}; // u, v, w of shaders/physics/train_polynomials.glsl
    glm::dvec2 place{0};      // position at the source in units of its radius
    glm::dvec2 across{0};     // direction at the source from its middle, in units of the aim's sine
    glm::dvec2 end{0};        // mm, on the plane
    glm::dvec2 direction{0};
    std::vector<double> filled; // squared height at each edge over its squared radius; infinite if not reached
    int ended = -1;             // index of the surface that stops the ray; -1: it passes
};

class Train {
  public:
    Train(const Instrument& instrument, double plane)
        : instrument_(instrument), plane_(plane),
          radius_((instrument.features & physics::f64::FEATURE_RECTANGLE) != 0
                      ? std::hypot(instrument.constants.source_half_width, instrument.constants.source_half_height)
                      : instrument.constants.source_radius) {}

    double radius() const { return radius_; }
    double sine() const { return instrument_.constants.emission_sine; }
    double shift() const { return instrument_.constants.emission_shift; }
    int surfaces() const { return instrument_.constants.illumination_count; }
    const Surface& surface(int k) const { return instrument_.surfaces[static_cast<std::size_t>(k)]; }
    bool has_edge(int k) const { return (surface(k).flags & physics::f64::SURFACE_CLIPPED) != 0; }

    // Traces the ray of the invariants u and w; turn: the angle (rad) between place and direction.
    Sample sample(double u, double w, double turn) const {
        Sample result;
        result.place = {std::sqrt(u), 0};
        result.across = std::sqrt(w) * glm::dvec2(std::cos(turn), std::sin(turn));
        result.invariants = {u, glm::dot(result.place, result.across), w};
        const glm::dvec2 sine = result.place * radius_ * shift() + result.across * this->sine();
        Ray ray{};
        ray.position = {result.place.x * radius_, 0, -instrument_.constants.source_distance};
        ray.direction = {sine.x, sine.y, std::sqrt(std::max(0.0, 1 - glm::dot(sine, sine)))};
        TrainResult light = physics::f64::enter_train(ray, 1);
        result.filled.assign(static_cast<std::size_t>(surfaces()), 0.0);
        for (int k = 0; k < surfaces(); ++k) {
            const TrainResult before = light;
            light = physics::f64::trace_surface(surface(k), k, before, true, {}, instrument_.features);
            const glm::dvec2 at = meeting_place(surface(k), before, light, {}, instrument_.features);
            const bool met = light.status == physics::f64::PATH_ALIVE || light.status == physics::f64::PATH_VIGNETTED;
            result.filled[static_cast<std::size_t>(k)] = !met ? std::numeric_limits<double>::infinity()
                                                         : has_edge(k)
                                                             ? glm::dot(at, at) / surface(k).semi_diameter_squared
                                                             : 0;
        }
        const Ray down = physics::f64::fly_to_plane(light.ray, plane_, light.index);
        result.end = glm::dvec2(down.position);
        result.direction = glm::dvec2(down.direction);
        result.ended = light.status == physics::f64::PATH_ALIVE ? -1 : light.surface;
        return result;
    }

  private:
    const Instrument& instrument_;
    double plane_;
    double radius_;
};

// Samples spread over all the light, each computed from its index by the additive recurrence of powers of the root of
// x^4 = x + 1. Every tenth is on the rim of each coordinate, where polynomials have their largest errors.
std::vector<Sample> trials_of(const Train& train) {
    constexpr int trials = 1 << 15;
    constexpr double root = 1.2207440846057596;
    std::vector<Sample> samples(trials);
    parallel_bands(trials, 512, [&](int first, int end) {
        for (int k = first; k < end; ++k) {
            const auto uniform = [&](double step) {
                const double place = (k + 0.5) * step - std::floor((k + 0.5) * step);
                return std::clamp(1.1 * place - 0.05, 0.0, 1.0);
            };
            samples[static_cast<std::size_t>(k)] = train.sample(uniform(1 / root), uniform(1 / (root * root)),
                                                                std::numbers::pi * uniform(1 / (root * root * root)));
        }
    });
    return samples;
}

double value_at(const Polynomial& polynomial, const Sample& sample) {
    return value_of(polynomial, sample.invariants.x, sample.invariants.y, sample.invariants.z);
}

// For each column of values (one value a sample), the polynomial of that degree with the least weighted sum of squared
// errors.
std::vector<Polynomial> fit(int degree, const std::vector<Sample>& samples, const std::vector<double>& weights,
                            const std::vector<std::vector<double>>& values) {
    std::vector<int> places;
    std::vector<std::array<int, 3>> powers;
    int place = 0;
    for (int i = 0; i <= POLYNOMIAL_DEGREE; ++i) {
        for (int j = 0; i + j <= POLYNOMIAL_DEGREE; ++j) {
            for (int k = 0; i + j + k <= POLYNOMIAL_DEGREE; ++k, ++place) {
                if (i + j + k <= degree) {
                    places.push_back(place);
                    powers.push_back({i, j, k});
                }
            }
        }
    }
    const auto rows = static_cast<Eigen::Index>(samples.size());
    Eigen::MatrixXd matrix(rows, static_cast<Eigen::Index>(places.size()));
    Eigen::MatrixXd right(rows, static_cast<Eigen::Index>(values.size()));
    for (Eigen::Index row = 0; row < rows; ++row) {
        const auto k = static_cast<std::size_t>(row);
        const glm::dvec3 at = samples[k].invariants;
        for (std::size_t term = 0; term < powers.size(); ++term) {
            matrix(row, static_cast<Eigen::Index>(term)) = weights[k] * std::pow(at.x, powers[term][0]) *
                                                           std::pow(at.y, powers[term][1]) *
                                                           std::pow(at.z, powers[term][2]);
        }
        for (std::size_t column = 0; column < values.size(); ++column) {
            right(row, static_cast<Eigen::Index>(column)) = weights[k] * values[column][k];
        }
    }
    const Eigen::MatrixXd solution = matrix.householderQr().solve(right);
    std::vector<Polynomial> result(values.size());
    for (std::size_t column = 0; column < values.size(); ++column) {
        result[column].degree = degree;
        for (std::size_t term = 0; term < places.size(); ++term) {
            result[column].terms[places[term]] =
                solution(static_cast<Eigen::Index>(term), static_cast<Eigen::Index>(column));
        }
    }
    return result;
}

// True if the ray reaches a surface, where edges before are enlarged a little.
bool comes_to(const Sample& sample, int surface) {
    constexpr double a_little = 1.002;
    return std::all_of(sample.filled.begin(), sample.filled.begin() + surface,
                       [](double filled) { return filled < a_little; });
}

// Samples that reach a surface, at Chebyshev nodes, where a polynomial fit has the least error in between.
std::vector<Sample> nodes_coming_to(const Train& train, int surface, const std::vector<Sample>& trials) {
    glm::dvec3 widest(0);
    for (const Sample& trial : trials) {
        widest = comes_to(trial, surface) ? glm::max(widest, trial.invariants) : widest;
    }
    constexpr int nodes = 14; // in each coordinate
    constexpr int sheet = nodes * nodes;
    const auto node = [](int k) { return 0.5 - 0.5 * std::cos(std::numbers::pi * (k + 0.5) / nodes); };
    std::vector<Sample> samples = parallel_list(nodes * sheet, [&](int k) {
        return train.sample(widest.x * node(k / sheet), widest.z * node(k % sheet / nodes),
                            std::numbers::pi * (k % nodes + 0.5) / nodes);
    });
    std::erase_if(samples, [&](const Sample& node) { return !comes_to(node, surface); });
    return samples;
}

// The surfaces whose edges stop most of the light, in ascending order. Edges that stop little are left out: testing one
// costs a GPU as much as tracing its light.
std::vector<int> stopping_edges(const Train& train, const std::vector<Sample>& trials) {
    const auto rare = static_cast<int>(1.5e-3 * static_cast<double>(trials.size()));
    std::vector<int> stopped(static_cast<std::size_t>(train.surfaces()));
    for (const Sample& trial : trials) {
        if (trial.ended >= 0) {
            ++stopped[static_cast<std::size_t>(trial.ended)];
        }
    }
    std::vector<int> edges;
    for (int k = 0; k < train.surfaces(); ++k) {
        if (train.has_edge(k) && stopped[static_cast<std::size_t>(k)] > rare) {
            edges.push_back(k);
        }
    }
    std::ranges::stable_sort(edges, std::greater(), [&](int k) { return stopped[static_cast<std::size_t>(k)]; });
    edges.resize(std::min(edges.size(), std::size_t{POLYNOMIAL_EDGES}));
    std::ranges::sort(edges);
    return edges;
}

// The largest error (mm^2) of the polynomial among samples that reach the edge near its rim.
double error_at_edge(const Polynomial& polynomial, const Surface& edge, int surface,
                     const std::vector<Sample>& samples) {
    double largest = 0;
    for (const Sample& sample : samples) {
        const double filled = sample.filled[static_cast<std::size_t>(surface)];
        if (comes_to(sample, surface) && std::abs(filled - 1) < 0.1) {
            largest = std::max(largest, std::abs(value_at(polynomial, sample) - filled * edge.semi_diameter_squared));
        }
    }
    return largest;
}

EdgePolynomial fit_edge(const Train& train, int surface, const std::vector<Sample>& trials) {
    const Surface& edge = train.surface(surface);
    std::vector<Sample> coming = nodes_coming_to(train, surface, trials);
    std::erase_if(coming,
                  [&](const Sample& node) { return !std::isfinite(node.filled[static_cast<std::size_t>(surface)]); });
    std::vector<double> squares;
    squares.reserve(coming.size());
    for (const Sample& node : coming) {
        squares.push_back(node.filled[static_cast<std::size_t>(surface)] * edge.semi_diameter_squared);
    }
    EdgePolynomial result{};
    result.surface = surface;
    double error = 0;
    for (int degree = 1; degree <= POLYNOMIAL_DEGREE; ++degree) {
        result.distance_squared = fit(degree, coming, std::vector<double>(coming.size(), 1.0), {squares}).front();
        error = error_at_edge(result.distance_squared, edge, surface, trials);
        if (error < wanted_edge_error * edge.semi_diameter_squared) {
            break;
        }
    }
    // Offsets from the middle carry the rounding of the whole direction.
    const double whole = 1 + std::abs(train.shift()) * train.radius() / train.sine();
    const double margin = 2 * error + float_margin * whole * edge.semi_diameter_squared;
    result.inside_below = edge.semi_diameter_squared - margin;
    result.ends_from = edge.semi_diameter_squared + margin;
    result.ends_below = std::numeric_limits<float>::max();
    return result;
}

// The factors of place and direction at the source in the sum that gives an end position or direction.
using Factors = std::array<Polynomial, 2>;

glm::dvec2 sum_at(const Factors& factors, const Sample& sample) {
    return sample.place * value_at(factors[0], sample) + sample.across * value_at(factors[1], sample);
}

// Factors of the least degree whose sum has an error within `allowed` on all passing samples, else of the highest
// degree, and the largest error.
std::pair<Factors, double> fit_factors(const std::vector<Sample>& passing, const std::vector<Sample>& passed,
                                       glm::dvec2 (*value)(const Sample&), double allowed) {
    // The place lies along x, so the y component determines the direction's factor alone.
    std::vector<double> of_place, of_direction, by_place, by_direction;
    for (std::vector<double>* column : {&of_place, &of_direction, &by_place, &by_direction}) {
        column->reserve(passing.size());
    }
    for (const Sample& sample : passing) {
        const glm::dvec2 wanted = value(sample);
        of_direction.push_back(wanted.y / sample.across.y);
        of_place.push_back((wanted.x - of_direction.back() * sample.across.x) / sample.place.x);
        by_place.push_back(sample.place.x);
        by_direction.push_back(glm::length(sample.across));
    }
    Factors factors{};
    double error = std::numeric_limits<double>::infinity();
    for (int degree = 1; degree <= POLYNOMIAL_DEGREE && error > allowed; ++degree) {
        factors = {fit(degree, passing, by_place, {of_place}).front(),
                   fit(degree, passing, by_direction, {of_direction}).front()};
        error = 0;
        for (const Sample& sample : passed) {
            error = std::max(error, glm::length(sum_at(factors, sample) - value(sample)));
            if (error > 10 * allowed) {
                break; // hopeless at this degree
            }
        }
    }
    return {factors, error};
}

PolynomialPassage told_of(const TrainPolynomials& polynomials, const Sample& sample) {
    return meet_edges(polynomials, sample.invariants.x, sample.invariants.y, sample.invariants.z);
}

// True if the polynomials predict the traced end and no untested edge is close.
bool is_true(const Train& train, const TrainPolynomials& polynomials, const PolynomialPassage& told,
             const Sample& sample) {
    const int end = told.surface < 0 ? train.surfaces() : told.surface;
    for (int k = 0; k < end; ++k) {
        const bool asked = std::any_of(polynomials.edge, polynomials.edge + polynomials.edges,
                                       [&](const EdgePolynomial& edge) { return edge.surface == k; });
        if (!asked && !(sample.filled[static_cast<std::size_t>(k)] < 1 - clear_of_edge)) {
            return false;
        }
    }
    return told.surface == sample.ended;
}

// Shrinks the valid region to exclude a mispredicted sample.
void withhold(const Train& train, TrainPolynomials& polynomials, const Sample& sample) {
    const PolynomialPassage told = told_of(polynomials, sample);
    if (!told.known || is_true(train, polynomials, told, sample)) {
        return;
    }
    EdgePolynomial* nearest = nullptr;
    double fullest = -1;
    for (EdgePolynomial* edge = polynomials.edge; edge != polynomials.edge + polynomials.edges; ++edge) {
        const double filled =
            value_at(edge->distance_squared, sample) / train.surface(edge->surface).semi_diameter_squared;
        if (told.surface < 0 ? filled > fullest : told.surface == edge->surface) {
            nearest = edge;
            fullest = filled;
        }
    }
    if (nearest == nullptr) {
        return; // the misprediction remains; fit_illumination() then returns none
    }
    double& bound = told.surface < 0 ? nearest->inside_below : nearest->ends_below;
    bound = (fullest - clear_of_edge) * train.surface(nearest->surface).semi_diameter_squared;
}

} // namespace

std::optional<FittedTrain> fit_illumination(const Instrument& instrument) {
    constexpr std::uint32_t others = physics::f64::FEATURE_PLACEMENT | physics::f64::FEATURE_LOSSES |
                                     physics::f64::FEATURE_SPECTRUM | physics::f64::FEATURE_RING |
                                     physics::f64::FEATURE_LIGHT_FIELD;
    if ((instrument.features & others) != 0 || !(instrument.constants.emission_sine < 1)) {
        return std::nullopt;
    }
    const Train train(instrument, instrument.front_vertex_height);
    const std::vector<Sample> trials = trials_of(train);
    const std::vector<Sample> passing = nodes_coming_to(train, train.surfaces(), trials);
    std::vector<Sample> passed;
    std::ranges::copy_if(trials, std::back_inserter(passed), [](const Sample& trial) { return trial.ended < 0; });
    if (passing.size() < 2 * std::size_t{POLYNOMIAL_TERMS}) {
        return std::nullopt;
    }
    double field = 0;
    for (const Sample& sample : passed) {
        field = std::max(field, glm::length(sample.end));
    }

    FittedTrain result;
    TrainPolynomials& polynomials = result.polynomials;
    polynomials.per_radius = 1 / train.radius();
    polynomials.shift = train.shift();
    polynomials.per_sine = 1 / train.sine();
    polynomials.plane = instrument.front_vertex_height;
    const auto end = +[](const Sample& sample) { return sample.end; };
    const auto direction = +[](const Sample& sample) { return sample.direction; };
    const double place_allowed = std::min(largest_place_error, largest_share_of_field * field);
    auto direction_fit = std::async(std::launch::async,
                                    [&] { return fit_factors(passing, passed, direction, largest_direction_error); });
    const std::vector<int> stops = stopping_edges(train, trials);
    auto edge_fits = std::async(std::launch::async, [&] {
        return parallel_list(static_cast<int>(stops.size()),
                             [&](int i) { return fit_edge(train, stops[static_cast<std::size_t>(i)], trials); });
    });
    const auto [place_factors, place_error] = fit_factors(passing, passed, end, place_allowed);
    const auto [direction_factors, direction_error] = direction_fit.get();
    result.place_error = place_error;
    result.direction_error = direction_error;
    polynomials.place_r = place_factors[0];
    polynomials.place_s = place_factors[1];
    polynomials.direction_r = direction_factors[0];
    polynomials.direction_s = direction_factors[1];
    for (const EdgePolynomial& edge : edge_fits.get()) {
        polynomials.edge[polynomials.edges++] = edge;
    }
    for (const Sample& trial : trials) {
        withhold(train, polynomials, trial);
    }
    std::size_t traced = 0;
    for (const Sample& trial : trials) {
        const PolynomialPassage told = told_of(polynomials, trial);
        if (told.known && !is_true(train, polynomials, told, trial)) {
            return std::nullopt;
        }
        traced += told.known ? 0 : 1;
    }
    result.traced_share = static_cast<double>(traced) / static_cast<double>(trials.size());
    const bool good = result.place_error <= place_allowed && result.direction_error <= largest_direction_error &&
                      result.traced_share <= largest_traced_share;
    return good ? std::optional(result) : std::nullopt;
}

} // namespace vkfv::optics
