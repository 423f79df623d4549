#include "app/commands.hpp"
#include "app/version.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/progress.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/budget/budget.hpp"

#include <fmt/format.h>

namespace vkfv::app {

namespace {

struct BudgetOptions {
    std::string measurand;
    int trials = 0;
    int repeats = 10;
};

} // namespace

Command budget_command() {
    return {.name = "budget",
            .summary = "The uncertainty budget of a measurement: how the numbers of [uncertainty] deviate, one at a "
                       "time and all together, and what that does to the result; continues an interrupted one",
            .operands = {{"C.toml", "Configuration of a stack with [uncertainty]", into(&CommandOptions::file)}},
            .options = together({configuration_options(),
                                 {{.name = "--measurand",
                                   .value = "NAME",
                                   .description = "A dimension of the specimen, as \"groove depth\", or a parameter of "
                                                  "ISO 25178-2, as Sq",
                                   .target = into(&BudgetOptions::measurand),
                                   .needed = "the quantity that the budget is of"},
                                  {.name = "--trials",
                                   .value = "N",
                                   .description = "Measurements in which all inputs deviate at once (default: 0)",
                                   .target = into(&BudgetOptions::trials),
                                   .range = {0, 100000}},
                                  {.name = "--repeats",
                                   .value = "N",
                                   .description = "Measurements with no input changed, for the noise (default: 10)",
                                   .target = into(&BudgetOptions::repeats),
                                   .range = {2, 10000}},
                                  out_option("Output folder"),
                                  json_option()}}),
            .run = run_budget,
            .example = "vkfv budget assets/stacks/groove_budget.toml --measurand \"groove depth\" --trials 200"};
}

void run_budget(const CommandOptions& options) {
    auto progress = Progress::on_standard_error(options.quiet);
    const auto own = options.of<BudgetOptions>();
    const measurement::BudgetRequest request{.file = options.file,
                                             .overrides = overrides_with_folder(options, "-budget"),
                                             .measurand = own.measurand,
                                             .trials = own.trials,
                                             .repeats = own.repeats,
                                             .program = version_text()};
    const auto result = measurement::budget(request, progress);
    if (options.json) {
        print_text(json_text(result.document) + "\n");
    } else {
        print_text(measurement::summary(result) +
                   fmt::format("budget in {}\n", safe_line((result.folder / "budget.html").string())));
    }
    tell_results(result.folder);
}

} // namespace vkfv::app
