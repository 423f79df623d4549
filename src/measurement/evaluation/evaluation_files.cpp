#include "measurement/evaluation/evaluation_files.hpp"

#include "core/files/file.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/json_text.hpp"
#include "measurement/evaluation/evaluation_figures.hpp"
#include "measurement/evaluation/stack_page.hpp"
#include "measurement/scene/warning_json.hpp"
#include "report/layout.hpp"
#include "scan/store.hpp"
#include "specimen/kinds.hpp"

#include <fmt/format.h>

#include <cmath>
#include <future>
#include <utility>

namespace vkfv::measurement {

namespace {

// Writes the times apart from the results, since no two runs take the same time. They are a script because a page that
// was opened from a disk may load no other kind of file.
void write_timings_script(const std::filesystem::path& folder) {
    const nlohmann::ordered_json text = read_file(folder / "timings.csv");
    write_file(folder / "timings.js", "vkfv.timings.show(" + json_text(text, JsonLayout::one_line) + ");\n");
}

// "Specimen "step" under a 20x/0.41 microscope: 512 x 512 pixels of 0.345 um, light of 0.588 um."
std::string summary_of(const Configuration& configuration, const optics::Instrument& instrument) {
    const auto& first_order = instrument.first_order;
    const auto [columns, rows] = instrument.detector_pixels();
    return fmt::format(
        "Specimen \"{}\" under a {:.3g}x/{:.2g} microscope: {} x {} pixels of {:.3g} µm, light of {:.3g} µm.",
        specimen::kinds().at(configuration.specimen.value().shape.index()).name, std::abs(first_order.magnification),
        first_order.numerical_aperture, columns, rows, um_per_mm * first_order.pixel_pitch,
        configuration.instrument.spectrum.reference_um);
}

} // namespace

StackSource stack_source(const Configuration& configuration, const optics::Instrument& instrument) {
    return {.summary = summary_of(configuration, instrument),
            .layout = report::layout_svg(instrument, folder_name(configuration.output_directory)),
            .configuration = configuration.canonical};
}

void write_results(ResultFolder& folder, const EvaluatedStack& stack) {
    const auto& evaluation = stack.evaluation;
    auto figures = std::async(std::launch::async, [&] { return figures_of(evaluation); });
    auto frames =
        std::async(std::launch::async, [&] { return frames_data(evaluation.frames, stack.files.image_unit); });
    const int count = evaluation.diffracted ? 2 : 1;
    auto data = write_maps(folder, "", evaluation, stack.files, count);
    StackPage page{.title = folder_name(folder.path()),
                   .summary = stack.source.summary,
                   .plain = {.figures = figures.get(), .dimensions = evaluation.dimensions, .data = std::move(data)},
                   .diffracted = {},
                   .frames = frames.get(),
                   .results = {},
                   .ledger = stack.source.ledger,
                   .layout = stack.source.layout,
                   .configuration = stack.source.configuration};
    if (evaluation.diffracted) {
        page.diffracted = {.figures = figures_of(*evaluation.diffracted),
                           .dimensions = evaluation.diffracted->dimensions,
                           .data = write_maps(folder, "diffracted", *evaluation.diffracted, stack.files, count)};
    }
    auto results =
        results_of(evaluation, page.plain.figures, page.diffracted ? page.diffracted->figures : std::vector<Figures>());
    results.update(stack.origin);
    results["verdict"] = json_of(verdict_of(evaluation));
    results["warnings"] = json_of(stack.warnings);
    folder.write(results_name, json_text(results) + "\n");
    page.results = std::move(results);
    folder.write("report.html", stack_page(page));
    scan::append_timing(folder.path(), "evaluation", evaluation.seconds);
    write_timings_script(folder.path());
    folder.write_checksums();
}

} // namespace vkfv::measurement
