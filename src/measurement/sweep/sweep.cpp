#include "measurement/sweep/sweep.hpp"

#include "core/files/result_folder.hpp"
#include "core/messages/heartbeat.hpp"
#include "measurement/sweep/sweep_page.hpp"
#include "measurement/sweep/sweep_rows.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace vkfv::measurement {

namespace {

std::vector<std::vector<std::string>> combinations(const Sweep& sweep) {
    std::vector<std::vector<std::string>> result = {{}};
    for (const auto& parameter : sweep.parameters) {
        std::vector<std::vector<std::string>> longer;
        for (const auto& begun : result) {
            for (const auto& value : parameter.values) {
                longer.push_back(begun);
                longer.back().push_back(value);
            }
        }
        result = std::move(longer);
    }
    return result;
}

std::vector<TomlOverride> with_values(std::vector<TomlOverride> overrides, const Sweep& sweep,
                                      const std::vector<std::string>& values) {
    for (std::size_t k = 0; k < values.size(); ++k) {
        overrides.push_back({sweep.parameters[k].key, values[k], "sweep"});
    }
    return overrides;
}

// The configurations of a combination's stacks, each with a seed and a folder of its own.
std::vector<Configuration> repeated(const std::filesystem::path& file, const std::vector<TomlOverride>& overrides,
                                    int repeats, const std::filesystem::path& folder) {
    const auto seed = load_configuration(file, overrides).trace.seed;
    std::vector<Configuration> result;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        const auto own = repeats == 1 ? folder : folder / fmt::format("repeat_{:03}", repeat);
        auto of_repeat = overrides;
        of_repeat.push_back(
            {"trace.seed", fmt::format("{}", seed + static_cast<std::uint32_t>(repeat)), "sweep.repeats"});
        of_repeat.push_back({"output.directory", toml_quoted(own.string()), "sweep"});
        result.push_back(load_stack(file, of_repeat));
    }
    return result;
}

} // namespace

SweepResult run_sweep(const std::filesystem::path& file, const std::vector<TomlOverride>& overrides, Progress& progress,
                      const std::function<void(const StackResult&)>& after_stack) {
    const auto base = load_configuration(file, overrides, Needs::exposure);
    if (!base.sweep) {
        throw InputError({{.file = file},
                          "sweep",
                          "no such table",
                          "a table [sweep] with [[sweep.parameter]] key and values",
                          "Add what is to be varied."});
    }
    const Sweep& sweep = *base.sweep;
    const auto needs = sweep.stacks ? Needs::stack : Needs::exposure;
    const auto list = combinations(sweep);
    // Every combination is checked before the first is traced.
    for (const auto& values : list) {
        (void)load_configuration(file, with_values(overrides, sweep, values), needs);
    }
    ResultFolder results(base.output_directory);
    std::vector<std::vector<Configuration>> stacks;
    for (const auto& values : list) {
        if (sweep.stacks) {
            stacks.push_back(repeated(file, with_values(overrides, sweep, values), sweep.repeats,
                                      results.path() / sweep_name(sweep, values)));
        }
    }
    SweptStacks swept(std::move(stacks));
    if (sweep.stacks) {
        spdlog::info("{}", swept.plan());
    }
    const CountedWork work(sweep.stacks ? swept.images() : static_cast<double>(list.size()));
    Surfaces surfaces;
    StackRuns runs; // also has the devices for images
    std::vector<SweepRow> rows(list.size());
    const auto begin = [&](std::size_t row) {
        const std::string name = sweep_name(sweep, list[row]);
        spdlog::info("{} of {}: {}", row + 1, list.size(), name);
        return name;
    };
    if (sweep.stacks) {
        swept.measure(progress, swept.lanes(),
                      {.begins = [&](std::size_t row) { begin(row); },
                       .after_stack = [&](std::size_t, const StackResult& stack) { after_stack(stack); },
                       .after_row = [&](std::size_t row, SweepRow&& measured) { rows[row] = std::move(measured); }});
    } else {
        for (std::size_t row = 0; row < list.size(); ++row) {
            rows[row] = image_row(load_configuration(file, with_values(overrides, sweep, list[row]), needs), results,
                                  begin(row), surfaces, runs);
        }
    }
    for (std::size_t row = 0; row < list.size(); ++row) {
        rows[row].values = list[row];
    }
    const std::string title = file.stem().string();
    results.write("sweep.csv", sweep_csv(sweep, rows));
    results.write("sweep.md", sweep_markdown(sweep, rows));
    results.write("sweep.json", sweep_json(sweep, rows));
    results.write("sweep.svg", sweep_contact_sheet(sweep, rows, title));
    results.write("charts.svg", sweep_charts(sweep, rows, title));
    results.write("report.html", sweep_page(sweep, rows, title, base));
    results.write_checksums();
    return {.sweep = sweep, .rows = std::move(rows), .folder = results.path()};
}

} // namespace vkfv::measurement
