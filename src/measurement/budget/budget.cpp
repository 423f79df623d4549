#include "measurement/budget/budget.hpp"

#include "core/files/result_folder.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/heartbeat.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/warning.hpp"
#include "measurement/budget/budget_documents.hpp"
#include "measurement/budget/input_draws.hpp"
#include "measurement/calibration/certificate.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/configured_numbers.hpp"
#include "measurement/scene/known_truth.hpp"
#include "measurement/stack/stack.hpp"
#include "measurement/sweep/sweep_rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace vkfv::measurement {

namespace {
namespace of_budget { // files of a unity build share the unnamed namespace

namespace fs = std::filesystem;

// A stack of the budget: its folder's name, and what it changes.
struct Run {
    std::string name;
    std::vector<double> deviations; // of all inputs
    int repetition = 0;             // of the noise
    int texture = 0;                // 0: the configuration's
};

std::string folder_name(std::string key) {
    std::ranges::replace(key, '.', '_');
    return key;
}

// The values of the inputs in the configuration as it is read, defaults included.
std::vector<double> values_of(const Configuration& configuration) {
    std::vector<double> values;
    for (const UncertainInput& input : configuration.uncertainty.inputs) {
        const auto value = number_in(configuration, input.key);
        if (!value) {
            throw InputError({.where = configuration.places.at("uncertainty." + input.key),
                              .key = "uncertainty." + input.key,
                              .found = "an uncertainty of a key without a value",
                              .expected = "a number that this configuration has",
                              .remedy = fmt::format("Give {} a value, or remove its uncertainty.", input.key)});
        }
        values.push_back(*value);
    }
    return values;
}

// The configuration and the overrides by which it is read: among them the pitch that the instrument assumes.
struct Base {
    std::vector<TomlOverride> overrides;
    Configuration configuration;
};

Base base_of(const BudgetRequest& request) {
    Base base{.overrides = request.overrides, .configuration = load_configuration(request.file, request.overrides)};
    if (!base.configuration.assumed_pitch) {
        const double pitch = height_pitch(assemble_for_figures(base.configuration), base.configuration);
        base.overrides.push_back({"detector.assumed_pitch_um", shortest_toml(pitch * um_per_mm), "budget"});
        base.configuration = load_configuration(request.file, base.overrides);
    }
    return base;
}

// The seeds of what nobody knows of a specimen: its texture.
std::map<std::string, std::uint32_t> texture_seeds(const Configuration& configuration) {
    return seeds_in(configuration, {"specimen.roughness.seed", "specimen.reflectance.seed"});
}

// The seeds of what differs from one measurement to the next. Without a random error of the stage its seed stays, so
// that repetitions can be images of the same light.
std::map<std::string, std::uint32_t> noise_seeds(const Configuration& configuration) {
    std::map<std::string, std::uint32_t> seeds{
        {configuration.camera ? "camera.noise_seed" : "trace.seed", configuration.trace.seed}};
    const auto& stage = configuration.stage;
    if (stage && (stage->jitter > 0 || stage->light_noise > 0 || stage->reading_noise > 0 ||
                  !stage->vibrations.empty() || !stage->vibration_densities.empty())) {
        seeds.emplace("stage.seed", stage->seed);
    }
    return seeds;
}

class Runs {
  public:
    Runs(const BudgetRequest& request, const Base& base, const fs::path& folder)
        : file_(request.file), overrides_(base.overrides), base_(base.configuration), folder_(folder),
          values_(values_of(base.configuration)), noise_(noise_seeds(base.configuration)),
          textures_(texture_seeds(base.configuration)) {}

    const std::vector<double>& values() const { return values_; }

    // The configuration of a run. Repetitions of a camera's noise are images of the same light.
    Configuration of(const Run& run) const {
        auto overrides = overrides_;
        const auto& inputs = base_.uncertainty.inputs;
        for (std::size_t k = 0; k < inputs.size(); ++k) {
            if (run.deviations[k] != 0) {
                overrides.push_back({inputs[k].key, shortest_toml(values_[k] + run.deviations[k]), run.name});
            }
        }
        const auto draw = [&](const std::map<std::string, std::uint32_t>& seeds, int index) {
            for (const auto& [key, first] : seeds) {
                overrides.push_back({key, fmt::format("{}", first + static_cast<std::uint32_t>(index)), run.name});
            }
        };
        draw(noise_, run.repetition);
        draw(textures_, run.texture);
        overrides.push_back({"output.directory", toml_quoted((folder_ / run.name).string()), "budget"});
        return load_stack(file_, overrides);
    }

  private:
    fs::path file_;
    std::vector<TomlOverride> overrides_;
    const Configuration& base_;
    fs::path folder_;
    std::vector<double> values_;
    std::map<std::string, std::uint32_t> noise_, textures_;
};

// Numbers of runs of each kind, in their order.
struct Counts {
    std::size_t repeats = 0, textures = 0, inputs = 0, trials = 0; // inputs: two runs each

    Counts(const BudgetRequest& request, const Configuration& base)
        : repeats(static_cast<std::size_t>(request.repeats)), textures(texture_seeds(base).empty() ? 0 : repeats),
          inputs(base.uncertainty.inputs.size()), trials(static_cast<std::size_t>(request.trials)) {}
};

// The runs in their order: repetitions, each texture, each input above and below its value, trials. What is traced with
// the first light comes first. No noise and no texture but the configuration's comes twice.
std::vector<Run> planned(const BudgetRequest& request, const Configuration& base) {
    const auto& inputs = base.uncertainty.inputs;
    const std::vector<double> none(inputs.size());
    std::vector<Run> runs;
    const Counts counts(request, base);
    const int repeats = request.repeats;
    runs.reserve(counts.repeats + counts.textures + 2 * counts.inputs + counts.trials);
    for (int k = 0; k < repeats; ++k) {
        runs.push_back({fmt::format("repeats/{:03}", k), none, k, 0});
    }
    for (int k = 0; k < static_cast<int>(counts.textures); ++k) {
        runs.push_back({fmt::format("textures/{:03}", k), none, repeats + k, 1 + k});
    }
    for (std::size_t k = 0; k < inputs.size(); ++k) {
        for (const double sign : {1.0, -1.0}) {
            auto deviations = none;
            deviations[k] = sign * inputs[k].uncertainty;
            runs.push_back({fmt::format("inputs/{}/{}", folder_name(inputs[k].key), sign > 0 ? "above" : "below"),
                            std::move(deviations), 0, 0});
        }
    }
    const InputDraws draws(base.uncertainty, base.trace.seed);
    for (int k = 0; k < request.trials; ++k) {
        runs.push_back({fmt::format("trials/{:05}", k), draws.deviations(static_cast<std::uint32_t>(k)),
                        2 * repeats + k, counts.textures > 0 ? 1 + repeats + k : 0});
    }
    return runs;
}

void require_input(const Configuration& base, const BudgetRequest& request) {
    if (base.uncertainty.inputs.empty()) {
        throw InputError({.where = {.file = request.file},
                          .key = "uncertainty",
                          .found = "no such table",
                          .expected = "a table [uncertainty] with the uncertainties of numbers",
                          .remedy = "Add one, as \"stage.scale_error\" = {u = 5e-4}."});
    }
}

Budget evaluated(const std::vector<std::optional<MeasurandValue>>& results, const BudgetRequest& request,
                 const Configuration& base, const std::vector<double>& values) {
    const auto& inputs = base.uncertainty.inputs;
    const Counts counts(request, base);
    Budget budget{.nominal = *results.front(), .rows = {}};
    // The scatter of errors of so many repetitions; their means become the nominal values.
    const auto scatter = [&](std::size_t first, std::size_t count) {
        std::vector<double> errors;
        budget.nominal.measured = budget.nominal.truth = 0;
        for (std::size_t k = first; k < first + count; ++k) {
            if (!results[k]) {
                throw RunError(fmt::format("repetition {} of the measurement has no {}", k, request.measurand));
            }
            errors.push_back(results[k]->error());
            budget.nominal.measured += results[k]->measured / static_cast<double>(count);
            budget.nominal.truth += results[k]->truth / static_cast<double>(count);
        }
        return statistics_of(std::move(errors)).standard_deviation;
    };
    const auto freedom = static_cast<double>(counts.repeats - 1);
    budget.noise = {.value = scatter(0, counts.repeats), .degrees_of_freedom = freedom};
    if (counts.textures > 0) { // each of these repetitions has noise of its own too
        const double both = scatter(counts.repeats, counts.textures), noise = budget.noise.value;
        budget.texture = {.value = std::sqrt(std::max(0.0, both * both - noise * noise)),
                          .degrees_of_freedom = freedom};
    }
    const std::size_t first_input = counts.repeats + counts.textures;
    std::vector<Contribution> contributions;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
        const auto &above = results[first_input + 2 * k], &below = results[first_input + 2 * k + 1];
        if (!above || !below) {
            throw RunError(fmt::format("there is no {} where {} deviates by its standard uncertainty",
                                       request.measurand, inputs[k].key));
        }
        const double half = 0.5 * (above->error() - below->error());
        budget.rows.push_back({.input = inputs[k],
                               .value = values[k],
                               .sensitivity = half / inputs[k].uncertainty,
                               .contribution = {.value = half, .degrees_of_freedom = inputs[k].degrees_of_freedom},
                               .sensitivity_noise = budget.noise.value / std::sqrt(2.0)});
        contributions.push_back(budget.rows.back().contribution);
    }
    contributions.push_back(budget.noise);
    if (budget.texture) {
        contributions.push_back(*budget.texture);
    }
    budget.by_parts = combined(contributions, base.uncertainty.correlations);
    std::vector<double> found;
    for (std::size_t k = first_input + 2 * counts.inputs; k < results.size(); ++k) {
        budget.errors.push_back(results[k] ? results[k]->error() : std::numeric_limits<double>::quiet_NaN());
        if (results[k]) {
            found.push_back(results[k]->error());
        } else {
            ++budget.failed;
        }
    }
    if (found.size() >= 2) {
        budget.by_trials = statistics_of(std::move(found));
    }
    return budget;
}

} // namespace of_budget
} // namespace

double Budget::interval_difference() const {
    const double expanded = by_parts.expanded_uncertainty();
    return std::max(std::abs(nominal.error() - expanded - by_trials.low),
                    std::abs(nominal.error() + expanded - by_trials.high));
}

BudgetResult budget(const BudgetRequest& request, Progress& progress) {
    const of_budget::Base with_pitch = of_budget::base_of(request);
    const Configuration& base = with_pitch.configuration;
    of_budget::require_input(base, request);
    ResultFolder results(base.output_directory);
    const of_budget::Runs runs(request, with_pitch, results.path());
    const auto plan = of_budget::planned(request, base);
    std::vector<std::vector<Configuration>> rows;
    rows.reserve(plan.size());
    for (const auto& run : plan) { // every configuration is checked before the first is traced
        rows.push_back({runs.of(run)});
    }
    SweptStacks swept(std::move(rows));
    swept.require_space(results.path());
    spdlog::info("{}", swept.plan());
    const CountedWork work(swept.images());
    const WarningsOnce warnings_once; // the report of each stack has its own
    BudgetOrigin origin{
        .program = request.program, .title = request.file.stem().string(), .devices = {}, .seed = base.trace.seed};
    std::vector<std::optional<MeasurandValue>> values(plan.size());
    std::set<std::string> devices;
    swept.measure(
        progress, swept.lanes(),
        {.begins = [&](std::size_t run) { spdlog::info("{} of {}: {}", run + 1, plan.size(), plan[run].name); },
         .after_stack =
             [&](std::size_t run, const StackResult& stack) {
                 values[run] = measurand(stack.evaluation, request.measurand);
                 if (run == 0 && !values[run]) {
                     throw RunError(fmt::format("the stack has no {} with a truth. It has \"{}\"", request.measurand,
                                                fmt::join(measurands(stack.evaluation), "\", \"")));
                 }
             },
         .after_row = [&](std::size_t, SweepRow&& row) { devices.insert(row.device); }});
    devices.erase("");
    origin.devices.assign(devices.begin(), devices.end());
    const Budget found = of_budget::evaluated(values, request, base, runs.values());
    BudgetResult result{.document = budget_json(found, origin), .folder = results.path()};
    results.write("budget.json", json_text(result.document) + "\n");
    results.write("budget.html", budget_page(found, origin, base.canonical));
    results.write_checksums();
    return result;
}

std::string summary(const BudgetResult& result) {
    const auto& document = result.document;
    const std::string unit = document.at("measurand").at("unit");
    const auto quantity = [&](double value) { return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit); };
    std::string text =
        fmt::format("{}: measured {}, true {}, error {}\n", document.at("measurand").at("name").get<std::string>(),
                    quantity(document.at("measured")), quantity(document.at("truth")), quantity(document.at("error")));
    for (const auto& input : document.at("inputs")) {
        text +=
            fmt::format("  {:<40} {}\n", input.at("key").get<std::string>() + ":", quantity(input.at("contribution")));
    }
    text +=
        fmt::format("  {:<40} {}\n", "noise of one measurement:", quantity(document.at("noise").at("contribution")));
    if (const auto& texture = document.at("texture"); !texture.is_null()) {
        text += fmt::format("  {:<40} {}\n", "texture of the specimen:", quantity(texture.at("contribution")));
    }
    const auto& parts = document.at("by_parts");
    text += fmt::format("combined standard uncertainty {}; U = {} (95 %, k = {:.3g})\n",
                        quantity(parts.at("standard_uncertainty")), quantity(parts.at("expanded_uncertainty_95")),
                        parts.at("coverage_factor").get<double>());
    if (const auto& trials = document.at("by_trials"); !trials.is_null()) {
        text += fmt::format("{} trials: mean error {}, standard deviation {}, 95 % within {} to {}\n",
                            trials.at("trials").get<int>(), quantity(trials.at("mean_error")),
                            quantity(trials.at("standard_deviation")), quantity(trials.at("low")),
                            quantity(trials.at("high")));
    }
    for (const auto& remark : document.at("remarks")) {
        text += remark.get<std::string>() + "\n";
    }
    return text + not_traceable + "\n";
}

} // namespace vkfv::measurement
