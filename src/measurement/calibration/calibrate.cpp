#include "measurement/calibration/calibrate.hpp"

#include "core/files/digest.hpp"
#include "core/files/result_folder.hpp"
#include "core/messages/heartbeat.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/warning.hpp"
#include "measurement/calibration/certificate.hpp"
#include "measurement/calibration/digital_certificate.hpp"
#include "measurement/calibration/tested_instrument.hpp"
#include "measurement/sweep/sweep_rows.hpp"
#include "surface_files/provenance.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace vkfv::measurement {

namespace {

namespace fs = std::filesystem;

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

// A characteristic with its trials and their configurations.
struct Plan {
    const Characteristic* characteristic;
    const TestedInstrument* instrument;
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
    const TestedInstrument vertical = tested_instrument(base, request.small ? TestedField::small : TestedField::whole);
    const TestedInstrument lateral = request.small ? tested_instrument(base, TestedField::small_lateral) : vertical;
    ResultFolder results(base.output_directory);
    std::vector<Plan> plans;
    std::vector<std::vector<Configuration>> rows;
    for (const Characteristic* characteristic : list) {
        Plan plan{.characteristic = characteristic, .instrument = characteristic->lateral ? &lateral : &vertical};
        plan.trials = characteristic->trials(plan.instrument->conditions, plan.remarks);
        for (const Trial& trial : plan.trials) {
            rows.push_back({with_standard(*plan.instrument, base.file, trial,
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
    const std::string json = json_text(result.certificate) + "\n";
    const std::string date = surface::source_date();
    results.write("certificate.json", json);
    results.write("certificate.xml", digital_certificate(certificate, "vkfv-" + Digest().add(json).sha256(),
                                                         date.substr(0, date.find('T'))));
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
