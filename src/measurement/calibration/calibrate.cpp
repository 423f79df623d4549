#include "measurement/calibration/calibrate.hpp"

#include "core/files/digest.hpp"
#include "core/files/result_folder.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/heartbeat.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/warning.hpp"
#include "core/toml/toml_tables.hpp"
#include "measurement/calibration/certificate.hpp"
#include "measurement/calibration/standards.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/sweep/sweep_rows.hpp"
#include "report/layout.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <utility>

namespace vkfv::measurement {

namespace {

namespace fs = std::filesystem;

constexpr int small_side = 160, small_lateral_side = 320, small_images = 31;
constexpr double small_paths = 64; // a pixel, backward, where the configuration traces forward

// The instrument that is calibrated: a configuration without a specimen.
struct Instrument {
    std::string toml;
    Conditions conditions{};
    std::string identity_digest{};
    std::string layout{}; // SVG, to scale
};

// The canonical text with a square part of the detector's middle.
std::string with_pixels(const std::string& toml, int side, double pixel_um) {
    std::string text;
    bool of_detector = false;
    std::istringstream lines(toml);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('[')) {
            of_detector = line == "[detector]";
            text += line + "\n";
            text += of_detector ? fmt::format("pixels = {}\npixel_um = {:.12g}\n", side, pixel_um) : "";
            continue;
        }
        const bool of_size =
            of_detector && std::ranges::any_of(std::array{"pixels", "pixel_um", "size_mm", "format", "camera"},
                                               [&](const std::string& key) { return line.starts_with(key + " "); });
        text += of_size ? "" : line + "\n";
    }
    return text;
}

// The middle of the configuration's field and scan, as far as a small calibration looks at them.
std::string small_instrument(const Configuration& base, bool lateral) {
    const ImageSize pixels = base.instrument.detector_pixels;
    const int side = std::min({lateral ? small_lateral_side : small_side, pixels.columns, pixels.rows});
    std::string toml = without_entries(base.canonical, {"specimen"});
    toml = with_pixels(toml, side, base.instrument.detector_width / pixels.columns * um_per_mm);
    const bool backward = base.trace.estimator == trace::Estimator::backward;
    const double paths =
        backward ? static_cast<double>(base.trace.rays) / static_cast<double>(pixels.count()) : small_paths;
    std::vector<TomlOverride> overrides = {
        {"trace.rays", fmt::format("{:.0f}", std::ceil(paths * side * side)), "calibrate"}};
    if (!backward) {
        overrides.push_back({"trace.estimator", "\"auto\"", "calibrate"});
    }
    const auto positions = base.scan->positions();
    if (positions.size() > small_images) {
        const double step = positions[1] - positions[0], middle = 0.5 * (positions.front() + positions.back());
        const double half = 0.5 * (small_images - 1) * step;
        overrides.push_back({"scan.z_start_um", fmt::format("{:.9g}", (middle - half) * um_per_mm), "calibrate"});
        overrides.push_back({"scan.z_stop_um", fmt::format("{:.9g}", (middle + half) * um_per_mm), "calibrate"});
    }
    // Read once more, so that the text has the overrides' values.
    const auto read = read_configuration(
        TomlTable::parse(toml + "[specimen]\nkind = \"plane\"\nsize_mm = 1.0\n", base.file, overrides));
    return without_entries(read.canonical, {"specimen"});
}

Configuration with_specimen(const Instrument& instrument, const fs::path& file, const Trial& trial,
                            const fs::path& folder) {
    auto overrides = trial.overrides;
    overrides.push_back({"output.directory", toml_quoted(folder.string()), "calibrate"});
    return read_configuration(TomlTable::parse(instrument.toml + "\n" + trial.specimen, file, overrides));
}

Instrument instrument_of(const Configuration& base, bool small, bool lateral) {
    Instrument instrument{.toml =
                              small ? small_instrument(base, lateral) : without_entries(base.canonical, {"specimen"})};
    const Configuration configuration = read_configuration(
        TomlTable::parse(instrument.toml + "[specimen]\nkind = \"plane\"\nsize_mm = 1.0\n", base.file));
    const auto assembled = assemble_for_figures(configuration);
    const auto& first_order = assembled.first_order;
    const auto positions = configuration.scan->positions();
    const double aperture = first_order.numerical_aperture;
    const double range = positions.back() - positions.front();
    instrument.conditions = {.pixels = configuration.instrument.detector_pixels,
                             .pitch = first_order.pixel_pitch,
                             .window = configuration.topography.window_px * first_order.pixel_pitch,
                             .resolution = 0.61 * configuration.instrument.spectrum.reference_um * mm_per_um / aperture,
                             .lowest = positions.front(),
                             .range = range,
                             .step = positions.size() > 1 ? positions[1] - positions[0] : 0,
                             .curve_deviation = focus_curve_deviation(configuration, first_order),
                             .blur = 0.5 * range * aperture / std::sqrt(std::max(0.01, 1 - aperture * aperture)),
                             .camera = configuration.camera.has_value(),
                             .small = small,
                             .seed = configuration.trace.seed};
    instrument.identity_digest = Digest().add(without_entries(configuration.identity, {"specimen"})).sha256();
    instrument.layout = report::layout_svg(assembled, base.file.stem().string());
    return instrument;
}

std::vector<const Characteristic*> chosen(const std::vector<std::string>& only) {
    std::vector<const Characteristic*> list;
    std::vector<std::string> names;
    for (const Characteristic& one : characteristics()) {
        names.push_back(one.name);
        if (only.empty() || std::ranges::find(only, one.name) != only.end()) {
            list.push_back(&one);
        }
    }
    for (const std::string& name : only) {
        if (std::ranges::find(names, name) == names.end()) {
            throw InputError({.where = {.file = "command line"},
                              .key = "--only",
                              .found = name,
                              .expected = fmt::format("characteristics among {}", fmt::join(names, ", ")),
                              .remedy = "Correct the name."});
        }
    }
    return list;
}

TrialResult result_of(const std::string& name, const Evaluation& evaluation) {
    const auto& values = evaluation.topography.height.height.values;
    const auto measured = std::ranges::count_if(values, [](double height) { return std::isfinite(height); });
    return {.name = name,
            .heights = evaluation.topography.height,
            .truth = evaluation.truth.value(),
            .uncertainty = evaluation.topography.height_uncertainty,
            .height_noise = median_of(evaluation.topography.height_noise.values),
            .measured_share = static_cast<double>(measured) / static_cast<double>(values.size()),
            .dimensions = evaluation.dimensions};
}

// A characteristic with its trials and their configurations.
struct Plan {
    const Characteristic* characteristic;
    const Instrument* instrument;
    std::vector<Trial> trials{};
    std::vector<std::string> remarks{};
    std::vector<TrialResult> results{}; // of the trials, until findings are known
    std::size_t measured = 0;           // trials
    Findings findings{};
};

} // namespace

CalibrationResult calibrate(const CalibrationRequest& request, Progress& progress) {
    const auto list = chosen(request.only);
    const Configuration base = load_configuration(request.file, request.overrides);
    const Instrument vertical = instrument_of(base, request.small, false);
    const Instrument lateral = request.small ? instrument_of(base, true, true) : vertical;
    ResultFolder results(base.output_directory);
    std::vector<Plan> plans;
    std::vector<std::vector<Configuration>> rows;
    for (const Characteristic* characteristic : list) {
        Plan plan{.characteristic = characteristic, .instrument = characteristic->lateral ? &lateral : &vertical};
        plan.trials = characteristic->trials(plan.instrument->conditions, plan.remarks);
        for (const Trial& trial : plan.trials) {
            rows.push_back({with_specimen(*plan.instrument, base.file, trial,
                                          results.path() / characteristic->name / trial.name)});
        }
        plan.results.resize(plan.trials.size());
        plans.push_back(std::move(plan));
    }
    std::vector<std::pair<Plan*, std::size_t>> places; // of the rows: a plan and one of its trials
    for (Plan& plan : plans) {
        for (std::size_t trial = 0; trial < plan.trials.size(); ++trial) {
            places.emplace_back(&plan, trial);
        }
    }
    SweptStacks swept(std::move(rows));
    swept.require_space(results.path());
    spdlog::info("{}", swept.plan());
    const CountedWork work(swept.images());
    const WarningsOnce warnings_once; // the report of each stack has its own
    Certificate certificate{.program = request.program,
                            .title = request.file.stem().string(),
                            .identity_digest = vertical.identity_digest,
                            .conditions = vertical.conditions,
                            .layout = vertical.layout,
                            .configuration = vertical.toml};
    // A characteristic is evaluated when the last of its trials is measured, so that heights are kept no longer.
    std::set<std::string> devices;
    swept.measure(progress, swept.lanes(),
                  {.begins =
                       [&](std::size_t row) {
                           const auto& [plan, trial] = places[row];
                           spdlog::info("{} of {}: {}, {}", row + 1, places.size(), plan->characteristic->name,
                                        plan->trials[trial].name);
                       },
                   .after_stack =
                       [&](std::size_t row, const StackResult& stack) {
                           const auto& [plan, trial] = places[row];
                           plan->results[trial] = result_of(plan->trials[trial].name, stack.evaluation);
                           if (++plan->measured == plan->trials.size()) {
                               plan->findings =
                                   plan->characteristic->evaluate(plan->instrument->conditions, plan->results);
                               plan->results.clear();
                           }
                       },
                   .after_row = [&](std::size_t, SweepRow&& row) { devices.insert(row.device); }});
    devices.erase("");
    certificate.devices.assign(devices.begin(), devices.end());
    for (Plan& plan : plans) {
        CertificateEntry entry{.characteristic = plan.characteristic, .findings = std::move(plan.findings)};
        for (const Trial& trial : plan.trials) {
            entry.trials.push_back((fs::path(plan.characteristic->name) / trial.name).generic_string());
        }
        if (plan.instrument->conditions.pixels != certificate.conditions.pixels) {
            const ImageSize pixels = plan.instrument->conditions.pixels;
            entry.findings.remarks.push_back(fmt::format("Measured on {} x {} pixels.", pixels.columns, pixels.rows));
        }
        entry.findings.remarks.insert(entry.findings.remarks.begin(), plan.remarks.begin(), plan.remarks.end());
        certificate.entries.push_back(std::move(entry));
    }
    CalibrationResult result{.certificate = certificate_json(certificate), .folder = results.path()};
    results.write("certificate.json", json_text(result.certificate) + "\n");
    results.write("certificate.html", certificate_page(certificate));
    results.write_checksums();
    return result;
}

std::string summary(const CalibrationResult& result) {
    std::string text;
    for (const auto& characteristic : result.certificate.at("characteristics")) {
        text += characteristic.at("title").get<std::string>() + "\n";
        for (const auto& figure : characteristic.at("figures")) {
            const std::string unit = figure.at("unit");
            const double value = figure.at("value"), expanded = figure.at("expanded_uncertainty_95");
            text += fmt::format("  {:<66} ", figure.at("title").get<std::string>() + ":");
            text += std::isfinite(value) ? fmt::format("{:.6g}", value) : "not determined";
            text += std::isfinite(expanded) && std::isfinite(value) ? fmt::format(" +- {:.2g}", expanded) : "";
            text += unit.empty() || !std::isfinite(value) ? "\n" : " " + unit + "\n";
        }
        for (const auto& remark : characteristic.at("remarks")) {
            text += "  " + remark.get<std::string>() + "\n";
        }
    }
    return text + "+-: expanded uncertainty, 95 %. " + not_traceable + "\n";
}

} // namespace vkfv::measurement
