#include "trace/interface/emission_order.hpp"

#include "core/threads/parallel_rows.hpp"
#include "statistics/poisson.hpp"
#include "trace/interface/exposure_record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace vkfv::trace {

namespace {

using namespace physics::f64;

constexpr int bits_of_number = 21; // bits of each of the four numbers of an emission
constexpr int most_cell_bits = 17; // 2 MB of cells stay in a GPU's cache; shaders/device/emission_cell.glsl
constexpr int most_pupil_bits = 2; // most of these bits that subdivide the pupil; 4 or 6 are slower
constexpr int sector_bits = 3;     // a ring of a disc is about 4 pi times as long as the disc is wide

// Two of the four numbers, whose leading bits cut a disc, a rectangle or a ring into pieces about as wide as long.
struct Plane {
    std::array<int, 2> number; // for a disc the first is its azimuth
    int leading = 0;           // bits of the first number before the two alternate
};

Plane directions(const optics::Instrument& instrument) {
    if ((instrument.features & FEATURE_AIMED_RECTANGLE) != 0) {
        return {.number = {2, 3}};
    }
    return {.number = {3, 2}, .leading = sector_bits};
}

Plane places(const optics::Instrument& instrument) {
    if ((instrument.features & FEATURE_RING) != 0) {
        return {.number = {0, 1}, .leading = sector_bits};
    }
    if ((instrument.features & FEATURE_RECTANGLE) != 0) {
        return {.number = {0, 1}};
    }
    return {.number = {1, 0}, .leading = sector_bits};
}

// The index of the number that the k-th bit of a piece belongs to.
int number_of_bit(const Plane& plane, int k) {
    return plane.number[k < plane.leading ? 0 : static_cast<std::size_t>((k - plane.leading) % 2)];
}

// Sums of squared displacements, mm^2, of light's arrival on the specimen by a change of its place at the source or of
// its direction.
struct Displacements {
    double by_place = 0;
    double by_direction = 0;
};
Displacements displacements(const optics::Instrument& instrument) {
    constexpr std::uint32_t trials = 512;
    const SpecimenRecord plane{};
    const Exposure exposure = make_exposure(instrument, plane, 0.0, 1, 0);
    const auto arrival = [&](const Draws& draws) {
        return illuminate(instrument.scene(), instrument.constants, plane, exposure,
                          emit(instrument.scene(), instrument.constants, draws));
    };
    const auto square_between = [](const Arrival& a, const Arrival& b) {
        return dot(a.position - b.position, a.position - b.position);
    };
    Displacements all;
    for (std::uint32_t k = 0; k < trials; ++k) {
        const Draws one = draw(exposure.seed, exposure.image, {k, 0}, 0),
                    other = draw(exposure.seed, exposure.image, {k, 1}, 0);
        Draws other_place = one, other_direction = one;
        other_place.u0 = other.u0;
        other_place.u1 = other.u1;
        other_direction.u2 = other.u2;
        other_direction.u3 = other.u3;
        const Arrival from = arrival(one), moved = arrival(other_place), turned = arrival(other_direction);
        if (from.fate.status == PATH_ALIVE && moved.fate.status == PATH_ALIVE && turned.fate.status == PATH_ALIVE) {
            all.by_place += std::min(1.0, square_between(moved, from));
            all.by_direction += std::min(1.0, square_between(turned, from));
        }
    }
    return all;
}

} // namespace

EmissionOrder::EmissionOrder(const optics::Instrument& instrument, std::uint64_t paths, std::uint32_t seed)
    : paths_(std::max<std::uint64_t>(paths, 1)), seed_(seed) {
    // With 8 sqrt(paths) cells the start of a cell varies by about four cells, so that it is found near its average.
    const int bits =
        std::clamp(static_cast<int>(std::log2(8 * std::sqrt(static_cast<double>(paths_)))), 0, most_cell_bits);
    const Plane at_source = places(instrument), towards = directions(instrument);
    const auto [by_place, by_direction] = displacements(instrument);
    const bool places_first = by_place > by_direction;
    // For a ring light both place and direction decide where light arrives.
    const bool both = std::min(by_place, by_direction) > 0.1 * std::max(by_place, by_direction);
    const int pupil_bits = both ? bits / 2 : std::min(most_pupil_bits, bits / 3);
    const Plane field = places_first ? at_source : towards, pupil = places_first ? towards : at_source;

    std::vector<int> numbers; // number for each bit of a cell's index, from the highest
    numbers.reserve(static_cast<std::size_t>(bits));
    for (int k = 0; k < bits - pupil_bits; ++k) {
        numbers.push_back(number_of_bit(field, k));
    }
    for (int k = 0; k < pupil_bits; ++k) {
        numbers.push_back(number_of_bit(pupil, k));
    }
    given_.assign(std::size_t{1} << bits, glm::uvec4(0));
    for (std::size_t cell = 0; cell < given_.size(); ++cell) {
        std::array<int, 4> place{bits_of_number, bits_of_number, bits_of_number, bits_of_number};
        for (int k = 0; k < bits; ++k) {
            const auto bit = static_cast<std::uint32_t>(cell >> (bits - 1 - k)) & 1u;
            given_[cell][numbers[k]] |= bit << --place[numbers[k]];
        }
    }
    drawn_ = ~given_.back(); // all given bits of the last cell are 1
}

std::vector<std::uint64_t> EmissionOrder::first_paths(std::uint32_t image) const {
    // Poisson numbers of one mean are, given their sum, multinomial. With the paths that their sum lacks, each in a
    // cell drawn by itself, they are the multinomial numbers of all paths. If the sum exceeds all paths it is drawn
    // again.
    const auto all = static_cast<double>(paths_);
    const double mean = std::max(0.0, all - 2 * std::sqrt(all)) / static_cast<double>(cells());
    std::vector<std::uint64_t> counts(cells() + 1);
    std::uint64_t sum = 0;
    for (std::uint32_t attempt = 0; attempt == 0 || sum > paths_; ++attempt) {
        constexpr int band = 8192; // 0.3 ms
        parallel_bands(static_cast<int>(cells()), band, [&](int first, int end) {
            for (int cell = first; cell < end; ++cell) {
                statistics::RandomStream random(seed_, image, static_cast<std::uint32_t>(cell), attempt,
                                                statistics::Purpose::emission_order);
                counts[static_cast<std::size_t>(cell)] =
                    static_cast<std::uint64_t>(statistics::poisson_count(mean, random));
            }
        });
        sum = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    }
    for (std::uint64_t lacking = 0; lacking < paths_ - sum; ++lacking) {
        const auto bits = philox_4x32({static_cast<std::uint32_t>(lacking), static_cast<std::uint32_t>(lacking >> 32),
                                       0, static_cast<std::uint32_t>(statistics::Purpose::emission_order_rest)},
                                      seed_, image, PHILOX_ROUNDS);
        ++counts[bits.x & (cells() - 1)]; // the number of cells is a power of 2
    }
    std::exclusive_scan(counts.begin(), counts.end(), counts.begin(), std::uint64_t{0});
    return counts;
}

EmissionCell EmissionCells::of(std::uint64_t path) const {
    const auto after = std::upper_bound(first_paths_.begin(), first_paths_.end() - 1, path);
    EmissionCell cell{};
    cell.given = order_->given()[static_cast<std::size_t>(after - first_paths_.begin()) - 1];
    cell.drawn = order_->drawn();
    return cell;
}

} // namespace vkfv::trace
