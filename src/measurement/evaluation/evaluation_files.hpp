// An evaluated stack as files.
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

// What the report shows of a stack beside its evaluation.
struct StackSource {
    std::string layout;        // the instrument as SVG; empty: not known
    std::string configuration; // TOML; empty: none
    scan::MeanLedger ledger{}; // of the images' light; empty: not known
};

// Of a stack of vkfv's own.
StackSource stack_source(const Configuration& configuration, const optics::Instrument& instrument);

// An evaluated stack with what its results say beside the evaluation.
struct EvaluatedStack {
    Evaluation evaluation;
    std::vector<Warning> warnings{};                                  // that the log has too
    nlohmann::ordered_json origin = nlohmann::ordered_json::object(); // of the images, for results.json
    StackSource source;
    TopographyFiles files;
};

// Writes into the folder, checksums last, the first row of each with the highest y: the topography's files, quality.tif
// (contrast), fit_residual.tif, mask.tif (uint16: topography::PointState), all_in_focus.tif; with a truth also
// truth.tif and deviation.tif (float32 um); topography.svg, a picture of them, levelled; results.json; curves.npy
// (focus curves on a grid, float32, rows x columns x heights); and report.html, all of it on a page, which finds the
// times in timings.js. What diffraction changes stands in a folder `diffracted` in it.
void write_results(ResultFolder& folder, const EvaluatedStack& stack);

} // namespace vkfv::measurement
