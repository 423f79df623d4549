// Parameters of the virtual instrument and its specimen from a real or virtual stack: the configuration's numbers with
// which it makes stacks of the same statistics, and how well these tell them.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/progress.hpp"
#include "measurement/fit/free_parameter.hpp"
#include "measurement/fit/moment_search.hpp"
#include "measurement/fit/stack_statistics.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vkfv::measurement {

struct FitRequest {
    std::filesystem::path stack; // folder of a stack of vkfv; or images, as scan::ImageSeries reads them
    // The configuration that is fitted; none: the stack.toml of the stack. Images of another instrument need one.
    std::optional<std::filesystem::path> configuration{};
    std::vector<TomlOverride> overrides{};
    std::vector<std::string> keys{};        // of the free parameters
    std::map<std::string, double> starts{}; // by key; others begin at the configuration's value
    int replicates = 0;                     // stacks by which scatter is known; statistics::least_seeds() at least
    bool descending = false;                // the first of the images is the highest
    std::string program{};                  // version of the program, as the fit names it
};

// A parameter as it was found, in the unit of its key.
struct FittedParameter {
    FreeParameter parameter{};
    // Whether the stack tells it: the search has settled, and its standard uncertainty is at most a third of the range
    // known beforehand.
    bool told = false;
    bool determined = false; // false: the stack holds no information, and the numbers below are NaN
    double estimate = 0;
    double standard_uncertainty = 0;
    double low = 0, high = 0;     // ends of the 95 % interval, by Student's distribution on the parameter's scale
    double bound = 0;             // Cramer-Rao: the least standard uncertainty; NaN: not known
    double uncertainty_ratio = 0; // standard uncertainty, before it is enlarged, over the bound
};

struct Fit {
    std::string program;                // version and commit
    std::string stack;                  // as the request names it
    std::string title;                  // name of the configuration
    std::vector<std::string> devices{}; // that traced the model's stacks
    std::uint32_t first_seed = 0;
    int replicates = 0;
    int stacks = 0;                  // of the model
    std::vector<double> positions{}; // of the images, mm
    StatisticsLayout layout{};
    std::vector<FreeParameter> parameters{};
    std::vector<double> measured{}; // statistics
    MomentSearch search{};

    // The probability of a misfit below which the model counts as one that does not describe the stack.
    static constexpr double least_probability = 0.05;
    bool describes() const { return !(search.fit.misfit > 1 && search.fit.misfit_probability < least_probability); }
    // The factor by which standard uncertainties are enlarged: the square root of the misfit of a model that does not
    // describe the stack, else 1.
    double enlargement() const;
    std::vector<FittedParameter> fitted() const;
    // Correlation of two parameters; NaN if one is not determined.
    double correlation(std::size_t first, std::size_t second) const;
    // Covariance of two parameters in the units of their keys, enlarged; NaN if one is not determined.
    double covariance(std::size_t first, std::size_t second) const;
};

struct FitResult {
    nlohmann::ordered_json document; // fit.json
    std::filesystem::path folder;
};

// Reads the stack, makes the model's stacks that the output folder lacks, and writes fit.json and fit.html there.
// Throws InputError before the first stack is traced, also for images that the configuration does not make; afterwards
// only for numbers far from the start that it refuses. Throws what a stack throws; the same call continues.
FitResult fit(const FitRequest& request, Progress& progress);

// The fit as lines of text, the verdict first.
std::string summary(const FitResult& result);

} // namespace vkfv::measurement
