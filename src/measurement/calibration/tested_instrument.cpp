#include "measurement/calibration/tested_instrument.hpp"

#include "core/files/digest.hpp"
#include "core/mathematics/units.hpp"
#include "core/toml/toml_tables.hpp"
#include "measurement/calibration/standards.hpp"
#include "measurement/scene/assembly.hpp"
#include "report/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

namespace vkfv::measurement {

namespace {
namespace of_tested_instrument { // files of a unity build share the unnamed namespace

constexpr int small_side = 160, small_lateral_side = 320, small_images = 31;
constexpr double small_paths = 64; // a pixel, backward, where the configuration traces forward

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

// The overrides that leave at most 31 images of the scan. The average along z and the fit's range, which count steps,
// keep their lengths.
std::vector<TomlOverride> small_scan(const Configuration& base) {
    const auto positions = base.scan->positions();
    if (positions.size() <= small_images) {
        return {};
    }
    constexpr double sampling = 0.5; // in standard deviations of a focus curve, whose top then holds several images
    const double range = positions.back() - positions.front(), step = positions[1] - positions[0];
    const double deviation = focus_curve_deviation(base, assemble_for_figures(base).first_order);
    const double wider = std::clamp(range / (small_images - 1), step, std::max(step, sampling * deviation));
    const double middle = 0.5 * (positions.front() + positions.back());
    const double half = 0.5 * std::min(range, (small_images - 1) * wider);
    const auto override_of = [](const std::string& key, double value) {
        return TomlOverride{key, fmt::format("{:.12g}", value), origin_of_standards};
    };
    std::vector<TomlOverride> overrides = {{"scan.z_start_um", um(middle - half), origin_of_standards},
                                           {"scan.z_stop_um", um(middle + half), origin_of_standards},
                                           override_of("scan.z_step_um", wider * um_per_mm)};
    if (const auto smoothing = base.topography.smoothing_steps) {
        overrides.push_back(override_of("topography.smoothing_steps", *smoothing * step / wider));
    }
    const int reach = base.topography.peak_range_steps, usual = topography::TopographyOptions{}.peak_range_steps;
    overrides.push_back(override_of("topography.peak_range_steps",
                                    std::max<double>(std::min(reach, usual), std::round(reach * step / wider))));
    return overrides;
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
    std::vector<TomlOverride> overrides = small_scan(base);
    overrides.push_back({"trace.rays", fmt::format("{:.0f}", std::ceil(paths * side * side)), origin_of_standards});
    if (!backward) {
        overrides.push_back({"trace.estimator", "\"auto\"", origin_of_standards});
    }
    // Read once more, so that the text has the overrides' values.
    const auto read = read_configuration(
        TomlTable::parse(toml + "[specimen]\nkind = \"plane\"\nsize_mm = 1.0\n", base.file, overrides));
    return without_entries(read.canonical, {"specimen"});
}

} // namespace of_tested_instrument
} // namespace

TestedInstrument tested_instrument(const Configuration& base, TestedField field) {
    const bool small = field != TestedField::whole;
    TestedInstrument instrument{
        .toml = small ? of_tested_instrument::small_instrument(base, field == TestedField::small_lateral)
                      : without_entries(base.canonical, {"specimen"})};
    const Configuration configuration = read_configuration(
        TomlTable::parse(instrument.toml + "[specimen]\nkind = \"plane\"\nsize_mm = 1.0\n", base.file));
    const auto assembled = assemble_for_figures(configuration);
    const auto& first_order = assembled.first_order;
    const auto positions = configuration.scan->positions();
    const double aperture = first_order.numerical_aperture;
    constexpr double greatest_sine = 0.99;
    const double sine = std::min(greatest_sine, aperture / first_order.object_index);
    instrument.numerical_aperture = aperture;
    instrument.object_index = first_order.object_index;
    const double range = positions.back() - positions.front();
    instrument.conditions = {.pixels = configuration.instrument.detector_pixels,
                             .pitch = first_order.pixel_pitch,
                             .window = configuration.topography.window_px * first_order.pixel_pitch,
                             .resolution = 0.61 * configuration.instrument.spectrum.reference_um * mm_per_um / aperture,
                             .lowest = positions.front(),
                             .range = range,
                             .step = positions.size() > 1 ? positions[1] - positions[0] : 0,
                             .curve_deviation = focus_curve_deviation(configuration, first_order),
                             .blur = 0.5 * range * sine / std::sqrt(1 - sine * sine),
                             .camera = configuration.camera.has_value(),
                             .small = small,
                             .seed = configuration.trace.seed};
    instrument.identity_digest = Digest().add(without_entries(configuration.identity, {"specimen"})).sha256();
    instrument.layout = report::layout_svg(assembled, base.file.stem().string());
    return instrument;
}

Configuration with_standard(const TestedInstrument& instrument, const std::filesystem::path& file, const Trial& trial,
                            const std::filesystem::path& folder) {
    auto overrides = trial.overrides;
    overrides.push_back({"output.directory", toml_quoted(folder.string()), origin_of_standards});
    return read_configuration(TomlTable::parse(instrument.toml + "\n" + trial.specimen, file, overrides));
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

} // namespace vkfv::measurement
