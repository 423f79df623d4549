// The files of an evaluated stack.
#pragma once

#include "configuration/configuration.hpp"
#include "core/files/result_folder.hpp"
#include "core/messages/warning.hpp"
#include "measurement/evaluation/evaluation_maps.hpp"
#include "measurement/evaluation/results_document.hpp"
#include "optics/instrument/instrument.hpp"
#include "scan/ledger_table.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace vkfv::measurement {

// The parts of the report that do not come from the evaluation.
struct StackSource {
    std::string summary;       // specimen, instrument and light in one line; empty: not known
    std::string layout;        // the instrument as SVG; empty: not known
    std::string configuration; // TOML; empty: none
    scan::MeanLedger ledger{}; // light of the images or of a trace beside them; empty: not known
};

// The source of a stack that vkfv traced.
StackSource stack_source(const Configuration& configuration, const optics::Instrument& instrument);

// An evaluated stack with everything that its files contain.
struct EvaluatedStack {
    Evaluation evaluation;
    std::vector<Warning> warnings{};                                  // also in the log
    nlohmann::ordered_json origin = nlohmann::ordered_json::object(); // where the images come from
    StackSource source;
    TopographyFiles files;
};

// Writes into the folder, checksums last: the topography's files, quality.tif (contrast), fit_residual.tif, mask.tif
// (uint16: topography::PointState), all_in_focus.tif; with a truth also truth.tif and deviation.tif (float32 um);
// topography.svg, a picture of the levelled surfaces; results.json; curves.npy (focus curves on a grid, float32, rows x
// columns x heights); and report.html, a page with all of it, which finds the times in timings.js. The first row of
// every map has the highest y. The files of the evaluation after diffraction stand in the subfolder `diffracted`.
void write_results(ResultFolder& folder, const EvaluatedStack& stack);

} // namespace vkfv::measurement
