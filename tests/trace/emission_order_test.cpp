// Paths in an order are what independent paths are, and stand close together.
#include "trace/interface/emission_order.hpp"
#include "trace/microscope.hpp"

#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

namespace vkfv::trace {
namespace {

using namespace physics::f64;

constexpr std::uint32_t seed = 11;

// Pearson's chi-square of the cells' paths in many images, less its mean, over its standard deviation.
template <class Counts>
double excess_of(std::size_t cells, double paths, int images, const Counts& counts_of) {
    double chi = 0;
    for (int image = 0; image < images; ++image) {
        for (const double count : counts_of(static_cast<std::uint32_t>(image))) {
            const double expected = paths / static_cast<double>(cells);
            chi += (count - expected) * (count - expected) / expected;
        }
    }
    const double freedom = static_cast<double>(images) * static_cast<double>(cells - 1);
    return (chi - freedom) / std::sqrt(2 * freedom);
}

optics::Instrument ring_microscope() {
    auto description = test::microscope_description();
    description.source.ring = optics::RingLightDescription{.distance = 25,
                                                           .elevation = 0.6,
                                                           .width = 2,
                                                           .segments = 4,
                                                           .fill = 1,
                                                           .on = {true, false, true, true},
                                                           .lit_radius = 0.3};
    return optics::assemble(description);
}

optics::Instrument aimed_microscope() {
    auto description = test::microscope_description();
    description.greatest_defocus = 0.01;
    description.single_scatter = true;
    auto instrument = optics::aimed_for_single_scatter(optics::assemble(description));
    EXPECT_NE(instrument.features & FEATURE_AIMED_RECTANGLE, 0u);
    return instrument;
}

Arrival arrival(const optics::Instrument& instrument, const Draws& draws) {
    Exposure exposure{};
    exposure.top_distance = instrument.front_vertex_height;
    return illuminate(instrument.scene(), instrument.constants, SpecimenRecord{}, exposure,
                      emit(instrument.scene(), instrument.constants, draws));
}

// The mean distance in mm of light that arrives from that of the next path that does, in stretches of an image of 1E9
// paths.
template <class DrawsOf>
double mean_step(const optics::Instrument& instrument, const DrawsOf& draws_of) {
    constexpr std::uint32_t stretches = 200, between = 5000000, paths = 100;
    double sum = 0;
    int steps = 0;
    for (std::uint32_t stretch = 0; stretch < stretches; ++stretch) {
        std::optional<real3> last;
        for (std::uint32_t path = stretch * between; path < stretch * between + paths; ++path) {
            const Arrival next = arrival(instrument, draws_of(path));
            if (next.fate.status == PATH_ALIVE) {
                sum += last ? glm::length(next.position - *last) : 0.0;
                steps += last ? 1 : 0;
                last = next.position;
            }
        }
    }
    return sum / steps;
}

} // namespace

TEST(EmissionOrder, CellsHaveAsManyPathsAsIndependentOnesWouldBring) {
    const auto instrument = test::microscope();
    for (const std::uint64_t paths : {60, 3000, 100000}) {
        const EmissionOrder order(instrument, paths, seed);
        const int images = 400;
        const auto counts = [&](std::uint32_t image) {
            const auto first = order.first_paths(image);
            EXPECT_EQ(first.size(), order.cells() + 1);
            EXPECT_EQ(first.front(), 0U);
            EXPECT_EQ(first.back(), paths);
            std::vector<double> result;
            for (std::size_t cell = 0; cell < order.cells(); ++cell) {
                result.push_back(static_cast<double>(first[cell + 1]) - static_cast<double>(first[cell]));
            }
            return result;
        };
        const double all = static_cast<double>(paths);
        EXPECT_LT(std::abs(excess_of(order.cells(), all, images, counts)), 4) << paths;
        // The number of paths in half of the field has the variance of a binomial number.
        const auto halves = [&](std::uint32_t image) {
            const auto cells = counts(image);
            const double half =
                std::accumulate(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(cells.size() / 2), 0.0);
            return std::vector{half, all - half};
        };
        EXPECT_LT(std::abs(excess_of(2, all, images, halves)), 4) << paths;
        // In the wrong twin paths are shared out evenly, and the rest in turn.
        const auto even = [&](std::uint32_t image) {
            std::vector<double> result(order.cells(), std::floor(all / static_cast<double>(order.cells())));
            const auto rest = static_cast<std::size_t>(all - std::accumulate(result.begin(), result.end(), 0.0));
            for (std::size_t k = 0; k < rest; ++k) {
                result[(image + k) % result.size()] += 1;
            }
            return result;
        };
        EXPECT_GT(std::abs(excess_of(order.cells(), all, images, even)), 10) << paths;
    }
}

TEST(EmissionOrder, ImagesAndSeedsDifferAndTheSameAreTheSame) {
    const auto instrument = test::microscope();
    const EmissionOrder order(instrument, 10000, seed);
    EXPECT_EQ(order.first_paths(3), EmissionOrder(instrument, 10000, seed).first_paths(3));
    EXPECT_NE(order.first_paths(3), order.first_paths(4));
    EXPECT_NE(order.first_paths(3), EmissionOrder(instrument, 10000, seed + 1).first_paths(3));
}

TEST(EmissionOrder, CellsAreAllOfTheCubeAndApart) {
    for (const auto& instrument : {test::microscope(), ring_microscope()}) {
        const EmissionOrder order(instrument, 1000000, seed);
        ASSERT_EQ(order.cells(), 4096U);
        std::set<std::array<std::uint32_t, 4>> seen;
        for (const glm::uvec4& given : order.given()) {
            seen.insert({given.x, given.y, given.z, given.w});
            EXPECT_EQ(given & order.drawn(), glm::uvec4(0));
            // Cells are given the sixteen upper bits of 21, as the kernels have them.
            EXPECT_EQ(given & ~glm::uvec4(0x1FFFE0), glm::uvec4(0));
        }
        EXPECT_EQ(seen.size(), order.cells());
    }
}

TEST(EmissionOrder, APathIsInTheCellOfItsNumber) {
    const EmissionOrder order(test::microscope(), 5000, seed);
    const EmissionCells cells(order, 2);
    const auto first = order.first_paths(2);
    for (std::uint64_t path = 0; path < 5000; ++path) {
        std::size_t cell = 0;
        while (first[cell + 1] <= path) {
            ++cell;
        }
        EXPECT_EQ(cells.of(path).given, order.given()[cell]) << path;
    }
    EXPECT_EQ(cells.of(1000000).given, order.given().back());
    EXPECT_EQ(EmissionCells(EmissionOrder(), 0).of(7).drawn, all_emission().drawn);
}

TEST(EmissionOrder, NumbersAreUniformOverAllPaths) {
    constexpr std::uint32_t paths = 200000;
    constexpr int bins = 64;
    const EmissionOrder order(test::microscope(), paths, seed);
    const EmissionCells cells(order, 5);
    // The excess of chi-square of each of the six numbers.
    const auto excesses = [&](std::uint32_t first_paths) {
        std::array<std::vector<double>, 6> counts;
        counts.fill(std::vector<double>(bins));
        for (std::uint32_t path = 0; path < first_paths; ++path) {
            const Draws draws = draw_in_cell(seed, 5, {path, 0}, cells.of(path));
            const std::array numbers{draws.u0, draws.u1, draws.u2, draws.u3, draws.u4, draws.u5};
            for (std::size_t k = 0; k < numbers.size(); ++k) {
                counts[k][static_cast<std::size_t>(numbers[k] * bins)] += 1;
            }
        }
        std::vector<double> result;
        result.reserve(counts.size());
        for (const auto& of_number : counts) {
            result.push_back(std::abs(excess_of(bins, first_paths, 1, [&](std::uint32_t) { return of_number; })));
        }
        return result;
    };
    EXPECT_LT(std::ranges::max(excesses(paths)), 4);
    EXPECT_GT(std::ranges::max(excesses(paths / 2)), 100); // wrong twin: half of the cells, half of the field
}

TEST(EmissionOrder, ConsecutivePathsArriveCloseTogether) {
    // There are 2^17 cells, of which 2^15 divide the disc's field. In a ring light place and direction both say where
    // light arrives: 2^(17 / 4) pieces of each of the four numbers, all of which move it. A quarter of the cells would
    // be too few: steps of 0.06 and 0.23.
    for (const auto& [instrument, most] : {std::pair(test::microscope(), 0.03), std::pair(aimed_microscope(), 0.03),
                                           std::pair(ring_microscope(), 0.2)}) {
        const EmissionOrder order(instrument, 1000000000, seed);
        const EmissionCells cells(order, 0);
        const auto ordered = [&](std::uint32_t path) { return draw_in_cell(seed, 0, {path, 0}, cells.of(path)); };
        const auto free = [](std::uint32_t path) { return draw(seed, 0, {path, 0}, 0); };
        EXPECT_LT(mean_step(instrument, ordered), most * mean_step(instrument, free));
    }
}

} // namespace vkfv::trace
