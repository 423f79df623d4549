#include "specimen/tabulated_bsdf.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "core/parsing/number_table.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <string_view>
#include <tuple>

namespace vkfv::specimen {

namespace {

// The limit on numbers: a float indexes them exactly, and every ray searches them.
constexpr std::size_t most_numbers = 8000000;

struct Between {
    std::size_t point;
    double share;
};

Between between(const std::vector<double>& points, double value) {
    const auto next = std::upper_bound(points.begin() + 1, points.end() - 1, value) - points.begin();
    const auto point = static_cast<std::size_t>(next - 1);
    return {point, std::clamp((value - points[point]) / (points[point + 1] - points[point]), 0.0, 1.0)};
}

// The integral of f sin cos over [a, b], where f is linear from `lower` at a to `upper` at b.
double integral_of_linear(double a, double b, double lower, double upper) {
    const double even = 0.5 * std::sin(b - a) * std::sin(b + a);
    const double rising = -(b - a) * std::cos(2 * b) / 4 + (std::sin(2 * b) - std::sin(2 * a)) / 8;
    return lower * even + (upper - lower) / (b - a) * rising;
}

// The points, extended to the ends of their range, where the outermost values hold.
std::vector<double> widened(std::vector<double> points, double first, double last) {
    if (points.front() > first) {
        points.insert(points.begin(), first);
    }
    if (points.back() < last) {
        points.push_back(last);
    }
    return points;
}

class BsdfFile {
  public:
    BsdfFile(const std::filesystem::path& file, std::string key) : file_(file), key_(std::move(key)) {
        std::string head;
        std::ifstream(file) >> head;
        has_azimuth_ = head.find("azimuth_deg") != std::string::npos;
        std::vector<std::string_view> columns = {"incidence_deg", "scatter_deg", "azimuth_deg", "bsdf_per_sr"};
        if (!has_azimuth_) {
            columns.erase(columns.begin() + 2);
        }
        for (const NumberRow& row : read_number_table(file, columns, key_, "value")) {
            add(row);
        }
        require_grid();
    }

    TabulatedBsdf bsdf() const {
        TabulatedBsdf result;
        result.given_incidences = incidences_.size();
        result.incidences = incidences_;
        if (incidences_.size() == 1) {
            result.incidences.push_back(pi / 2);
        }
        result.scatters = widened(scatters_, 0, pi / 2);
        result.azimuths = widened(azimuths_, 0, pi);
        for (const double incidence : result.incidences) {
            for (const double scatter : result.scatters) {
                for (const double azimuth : result.azimuths) {
                    const double i = std::min(incidence, incidences_.back());
                    const double s = std::clamp(scatter, scatters_.front(), scatters_.back());
                    result.values.push_back(i > 0 ? held(i, s, azimuth) : mean_over_azimuth(s));
                }
            }
        }
        return result;
    }

    // The line of the file with the first value at an incidence.
    int line(double incidence) const { return values_.lower_bound({incidence, -1, -1})->second.line; }

    [[noreturn]] void fail(int line, std::string found, std::string expected, std::string remedy) const {
        throw InputError({.where = {.file = file_, .line = line, .column = line > 0 ? 1 : 0},
                          .key = key_,
                          .found = std::move(found),
                          .expected = std::move(expected),
                          .remedy = std::move(remedy)});
    }

  private:
    struct Entry {
        double value;
        int line;
    };

    void add(const NumberRow& row) {
        const double incidence = row.values[0], scatter = row.values[1], azimuth = has_azimuth_ ? row.values[2] : 0;
        const double value = row.values.back();
        const auto require = [&](bool holds, const char* name, double found, const char* expected) {
            if (!holds) {
                fail(row.line, fmt::format("{} {}", name, found), expected, "Correct this field.");
            }
        };
        require(incidence >= 0 && incidence < 90, "incidence_deg", incidence, "an angle in [0, 90) degrees");
        require(scatter >= 0 && scatter <= 90, "scatter_deg", scatter, "an angle in [0, 90] degrees");
        require(azimuth >= 0 && azimuth <= 180, "azimuth_deg", azimuth,
                "an angle in [0, 180] degrees from the mirror direction's");
        require(value >= 0 && value < 1e30, "bsdf_per_sr", value, "a number of 0 or more");
        const std::tuple at(incidence * radians_per_degree, scatter * radians_per_degree, azimuth * radians_per_degree);
        const auto [place, is_new] = values_.insert({at, {value, row.line}});
        if (!is_new) {
            fail(row.line, "a second value at these angles",
                 fmt::format("each combination of angles once; line {} has it", place->second.line),
                 "Remove one of them.");
        }
    }

    void require_grid() {
        for (const auto& [at, entry] : values_) {
            incidences_.push_back(std::get<0>(at));
            scatters_.push_back(std::get<1>(at));
            azimuths_.push_back(std::get<2>(at));
        }
        for (auto* angles : {&incidences_, &scatters_, &azimuths_}) {
            std::ranges::sort(*angles);
            angles->erase(std::unique(angles->begin(), angles->end()), angles->end());
        }
        if (2 * values_.size() > most_numbers) {
            fail(0, fmt::format("{} values", values_.size()), fmt::format("at most {}", most_numbers / 2),
                 "Leave out angles.");
        }
        for (const double incidence : incidences_) {
            for (const double scatter : scatters_) {
                for (const double azimuth : azimuths_) {
                    if (!values_.contains({incidence, scatter, azimuth})) {
                        fail(line(incidence),
                             fmt::format("no value at incidence {:.6g}, scatter {:.6g}, azimuth {:.6g} degrees",
                                         incidence / radians_per_degree, scatter / radians_per_degree,
                                         azimuth / radians_per_degree),
                             "a value for each combination of the angles in the file", "Add it.");
                    }
                }
            }
        }
    }

    double held(double incidence, double scatter, double azimuth) const {
        const double a = std::clamp(azimuth, azimuths_.front(), azimuths_.back());
        return values_.at({incidence, scatter, a}).value;
    }

    double mean_over_azimuth(double scatter) const {
        const auto points = widened(azimuths_, 0, pi);
        double sum = 0;
        for (std::size_t k = 0; k + 1 < points.size(); ++k) {
            sum += 0.5 * (held(0, scatter, points[k]) + held(0, scatter, points[k + 1])) * (points[k + 1] - points[k]);
        }
        return sum / pi;
    }

    std::filesystem::path file_;
    std::string key_;
    bool has_azimuth_ = false;
    std::map<std::tuple<double, double, double>, Entry> values_;
    std::vector<double> incidences_, scatters_, azimuths_;
};

} // namespace

double TabulatedBsdf::at(double incidence, double scatter, double azimuth) const {
    const Between i = between(incidences, incidence), s = between(scatters, scatter), a = between(azimuths, azimuth);
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const auto di = static_cast<std::size_t>(corner & 1), ds = static_cast<std::size_t>((corner >> 1) & 1),
                   da = static_cast<std::size_t>(corner >> 2);
        sum += (di != 0 ? i.share : 1 - i.share) * (ds != 0 ? s.share : 1 - s.share) *
               (da != 0 ? a.share : 1 - a.share) * value(i.point + di, s.point + ds, a.point + da);
    }
    return sum;
}

double TabulatedBsdf::kept(std::size_t incidence) const {
    double sum = 0;
    for (std::size_t a = 0; a + 1 < azimuths.size(); ++a) {
        for (std::size_t s = 0; s + 1 < scatters.size(); ++s) {
            // The sum of two neighbouring azimuths is their mean times two, for both sides of the plane of incidence.
            sum += (azimuths[a + 1] - azimuths[a]) *
                   integral_of_linear(scatters[s], scatters[s + 1], value(incidence, s, a) + value(incidence, s, a + 1),
                                      value(incidence, s + 1, a) + value(incidence, s + 1, a + 1));
        }
    }
    return sum;
}

std::optional<double> TabulatedBsdf::reciprocity_deviation() const {
    if (given_incidences < 2) {
        return std::nullopt;
    }
    // The projected solid angle that an incidence represents, and likewise the range of an azimuth.
    const auto edge = [&](std::size_t k) { return 0.5 * (incidences[k] + incidences[k + 1]); };
    const auto area = [&](std::size_t k) {
        const double lower = k > 0 ? edge(k - 1) : incidences.front();
        const double upper = k + 1 < given_incidences ? edge(k) : incidences[given_incidences - 1];
        return std::sin(upper - lower) * std::sin(upper + lower);
    };
    const auto turn = [&](std::size_t k) {
        return 0.5 * (azimuths[std::min(k + 1, azimuths.size() - 1)] - azimuths[k > 0 ? k - 1 : 0]);
    };
    double apart = 0, mean = 0;
    for (std::size_t i = 0; i < given_incidences; ++i) {
        for (std::size_t o = 0; o < given_incidences; ++o) {
            for (std::size_t a = 0; a < azimuths.size(); ++a) {
                const double there = at(incidences[i], incidences[o], azimuths[a]);
                const double back = at(incidences[o], incidences[i], azimuths[a]);
                apart += area(i) * area(o) * turn(a) * std::abs(there - back);
                mean += area(i) * area(o) * turn(a) * 0.5 * (there + back);
            }
        }
    }
    return mean > 0 ? apart / mean : 0;
}

TabulatedBsdf read_tabulated_bsdf(const std::filesystem::path& file, const std::string& key, double reciprocity_limit) {
    const BsdfFile table(file, key);
    TabulatedBsdf bsdf = table.bsdf();
    double least = 1, most = 0;
    for (std::size_t i = 0; i < bsdf.given_incidences; ++i) {
        const double kept = bsdf.kept(i);
        least = std::min(least, kept);
        most = std::max(most, kept);
        constexpr double rounding = 1e-9;
        if (kept > 1 + rounding) {
            table.fail(table.line(bsdf.incidences[i]),
                       fmt::format("{:.6g} of the light is scattered at {:.6g} degrees", kept,
                                   bsdf.incidences[i] / radians_per_degree),
                       "at most 1: the integral of bsdf * cos(scatter) over the hemisphere",
                       "Correct the values, or add angles where the lobe is sharper than the table.");
        }
    }
    const auto deviation = bsdf.reciprocity_deviation();
    if (deviation && *deviation > reciprocity_limit) {
        table.fail(table.line(bsdf.incidences.front()),
                   fmt::format("a deviation from reciprocity of {:.3g}", *deviation),
                   fmt::format("at most {:.6g}: f(i, o) and f(o, i) are equal", reciprocity_limit),
                   "Correct the values, or raise reciprocity_limit.");
    }
    spdlog::info("{}: keeps {:.4g} to {:.4g} of the light; {}", file.filename().string(), least, most,
                 deviation ? fmt::format("reciprocal to {:.3g}", *deviation)
                           : std::string("one incidence does not tell whether it is reciprocal"));
    return bsdf;
}

physics::f64::Lobe with_numbers(physics::f64::Lobe lobe, const TabulatedBsdf& bsdf, std::vector<float>& numbers) {
    const std::size_t incidences = bsdf.incidences.size(), scatters = bsdf.scatters.size(),
                      azimuths = bsdf.azimuths.size();
    lobe.table[0] = static_cast<double>(numbers.size());
    lobe.table[1] = static_cast<double>(incidences);
    lobe.table[2] = static_cast<double>(scatters);
    lobe.table[3] = static_cast<double>(azimuths);
    lobe.table[4] =
        *std::ranges::max_element(bsdf.values); // peak value, by which the backward estimator finds the sharpest lobe
    const auto add = [&](double number) { numbers.push_back(static_cast<float>(number)); };
    for (const auto* angles : {&bsdf.incidences, &bsdf.scatters, &bsdf.azimuths}) {
        std::ranges::for_each(*angles, add);
    }
    std::vector<double> proposed, cumulative;
    for (std::size_t i = 0; i < incidences; ++i) {
        add(bsdf.kept(i));
        double sum = 0;
        const std::size_t begin = cumulative.size();
        for (std::size_t s = 0; s + 1 < scatters; ++s) {
            for (std::size_t a = 0; a + 1 < azimuths; ++a) {
                const double ceiling = std::max({bsdf.value(i, s, a), bsdf.value(i, s, a + 1), bsdf.value(i, s + 1, a),
                                                 bsdf.value(i, s + 1, a + 1)});
                sum += 2 * (bsdf.azimuths[a + 1] - bsdf.azimuths[a]) *
                       integral_of_linear(bsdf.scatters[s], bsdf.scatters[s + 1], ceiling, ceiling);
                cumulative.push_back(sum);
            }
        }
        proposed.push_back(sum);
        for (std::size_t k = begin; k < cumulative.size(); ++k) {
            cumulative[k] = sum > 0 ? cumulative[k] / sum : 1;
        }
    }
    std::ranges::for_each(proposed, add);
    std::ranges::for_each(bsdf.values, add);
    std::ranges::for_each(cumulative, add);
    return lobe;
}

} // namespace vkfv::specimen
