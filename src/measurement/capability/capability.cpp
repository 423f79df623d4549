#include "measurement/capability/capability.hpp"

#include "core/files/result_folder.hpp"
#include "core/messages/heartbeat.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/warning.hpp"
#include "measurement/calibration/certificate.hpp"
#include "measurement/capability/capability_documents.hpp"
#include "measurement/judgement/expectation.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/sweep/sweep_rows.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace vkfv::measurement {

namespace {
namespace of_capability { // files of a unity build share the unnamed namespace

constexpr int usual_wavelengths = 7, usual_amplitudes = 6, small_count = 3;

// The noise of a height of the flat before it is traced, mm; NaN: not known.
double expected_noise(const Configuration& flat) {
    const auto specimen = make_specimen(flat);
    const auto instrument = assemble_silently(flat, specimen, flat.scan->positions());
    return expect(flat, instrument, specimen, 0).height_noise;
}

int count_of(const std::optional<int>& asked, bool small, int usual) {
    return asked.value_or(small ? small_count : usual);
}

} // namespace of_capability
} // namespace

const CapabilityNode& nearest_node(const Capability& capability, const SurfaceWave& wave) {
    return *std::ranges::min_element(capability.nodes, {}, [&](const CapabilityNode& node) {
        return std::hypot(std::log(node.wave.length / wave.length), std::log(node.wave.amplitude / wave.amplitude));
    });
}

double spacing_of_map(const Capability& capability, double SurfaceWave::*of) {
    std::set<double> values;
    for (const CapabilityNode& node : capability.nodes) {
        values.insert(node.wave.*of);
    }
    return values.size() < 2 ? 1
                             : std::pow(*values.rbegin() / *values.begin(), 1 / static_cast<double>(values.size() - 1));
}

CapabilityResult capability(const CapabilityRequest& request, Progress& progress) {
    const Configuration base = load_configuration(request.file, request.overrides);
    Capability found{.program = request.program,
                     .title = request.file.stem().string(),
                     .instrument = tested_instrument(base, request.small ? TestedField::small : TestedField::whole)};
    const Conditions& conditions = found.instrument.conditions;
    require_room_for_waves(conditions, base.file);
    found.specimen = rough_specimen(base, conditions.pitch);
    ResultFolder results(base.output_directory);
    std::vector<Trial> trials = {flat_trial(conditions)};
    std::vector<std::vector<Configuration>> rows;
    const auto add_row = [&](const Trial& trial) {
        rows.push_back({with_standard(found.instrument, base.file, trial, results.path() / trial.name)});
    };
    add_row(trials.front());
    const auto waves =
        waves_of_map(conditions, of_capability::expected_noise(rows.front().front()),
                     of_capability::count_of(request.wavelengths, request.small, of_capability::usual_wavelengths),
                     of_capability::count_of(request.amplitudes, request.small, of_capability::usual_amplitudes));
    rows.reserve(waves.size() + 1);
    trials.reserve(waves.size() + 1);
    for (const SurfaceWave& wave : waves) {
        trials.push_back(trial_of(conditions, wave, static_cast<int>(trials.size()) - 1));
        add_row(trials.back());
    }
    SweptStacks swept(std::move(rows));
    swept.require_space(results.path());
    spdlog::info("{}", swept.plan());
    const CountedWork work(swept.images());
    const WarningsOnce warnings_once; // the report of each stack has its own
    std::set<std::string> devices;
    double noise = surface::undefined;
    found.nodes.resize(waves.size());
    swept.measure(
        progress, swept.lanes(),
        {.begins = [&](std::size_t row) { spdlog::info("{} of {}: {}", row + 1, trials.size(), trials[row].name); },
         .after_stack =
             [&](std::size_t row, const StackResult& stack) {
                 const TrialResult result = result_of(trials[row].name, stack.evaluation);
                 if (row == 0) {
                     noise = result.height_noise;
                 } else {
                     found.nodes[row - 1] = node_of(conditions, waves[row - 1], result);
                 }
             },
         .after_row = [&](std::size_t, SweepRow&& row) { devices.insert(row.device); }});
    devices.erase("");
    found.devices.assign(devices.begin(), devices.end());
    found.properties = limiting_properties(found.instrument, base.topography.window_shape, noise);
    for (CapabilityNode& node : found.nodes) {
        node.limits = keys_of(passed_limits(found.properties, node.wave));
    }
    CapabilityResult result{.document = capability_json(found), .folder = results.path()};
    results.write("capability.json", json_text(result.document) + "\n");
    results.write("capability.html", capability_page(found));
    results.write_checksums();
    return result;
}

std::string summary(const CapabilityResult& result) {
    std::string text;
    for (const auto& node : result.document.at("nodes")) {
        const auto share = [&](const char* key) {
            return node.at(key).is_null() || !std::isfinite(node.at(key).get<double>())
                       ? std::string("-")
                       : fmt::format("{:.3g} %", 100 * node.at(key).get<double>());
        };
        text += fmt::format("wavelength {:>7.4g} um, amplitude {:>7.4g} um: measured {:>7}, bias {:>7}{}\n",
                            node.at("wavelength_um").get<double>(), node.at("amplitude_um").get<double>(),
                            share("measured_share"), share("bias"), node.at("robust").get<bool>() ? ", robust" : "");
    }
    for (const auto& remark : result.document.at("remarks")) {
        text += remark.get<std::string>() + "\n";
    }
    return text + not_traceable + "\n";
}

} // namespace vkfv::measurement
