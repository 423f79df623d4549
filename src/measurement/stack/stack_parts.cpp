#include "measurement/stack/stack_parts.hpp"

#include "core/files/digest.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/stages.hpp"
#include "core/threads/background.hpp"
#include "measurement/evaluation/brightness_warnings.hpp"
#include "measurement/evaluation/noise_warnings.hpp"
#include "measurement/image/camera_images.hpp"
#include "measurement/image/exposure.hpp"
#include "measurement/judgement/plan_warnings.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/known_truth.hpp"
#include "measurement/scene/light_way.hpp"
#include "measurement/scene/specimen_view.hpp"
#include "measurement/scene/stage_figures.hpp"
#include "report/declared_figures.hpp"
#include "scan/repair.hpp"
#include "scan/stack_file.hpp"
#include "specimen/geometry_digest.hpp"
#include "specimen/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace vkfv::measurement {

std::shared_ptr<const StackScene::Parts> StackScene::make_parts(const Configuration& configuration,
                                                                Surfaces* surfaces) {
    auto parts = std::make_shared<Parts>();
    enter_stage("specimen");
    parts->specimen = surfaces != nullptr ? surfaces->of(configuration).specimen : make_specimen(configuration);
    enter_stage("instrument");
    parts->instrument = assemble_instrument(configuration, parts->specimen, configuration.scan->positions());
    return parts;
}

StackScene::StackScene(const Configuration& its_configuration)
    : StackScene(its_configuration, make_parts(its_configuration)) {
    log_warnings(planned);
}

StackScene::StackScene(const Configuration& its_configuration, std::shared_ptr<const Parts> parts)
    : parts_(std::move(parts)), configuration(its_configuration), positions(configuration.scan->positions()),
      specimen(parts_->specimen), instrument(parts_->instrument),
      planned(
          plan_warnings(configuration, instrument, relief_of(specimen, pixels(), instrument.first_order.pixel_pitch))),
      warnings(planned) {
    append(warnings, instrument.warnings);
}

scan::StackDescription StackScene::description(const trace::TracerIdentity& tracer) const {
    std::string identity = image_identity(configuration, specimen::geometry_digest(specimen), tracer);
    std::string digest = Digest().add(identity).text();
    return {.configuration = configuration.canonical,
            .identity = std::move(identity),
            .digest = std::move(digest),
            .positions = positions,
            .columns = pixels().columns,
            .rows = pixels().rows,
            .pitch = height_pitch(instrument, configuration),
            .type = configuration.pixel_type,
            .quantity = configuration.camera ? "grey values in DN" : scan::StackDescription().quantity};
}

scan::ImageDeveloper developer_of(const StackScene& scene, const scan::ImageStore& store,
                                  const WorkingDevices& devices) {
    const Configuration& configuration = scene.configuration;
    if (!configuration.camera) {
        return scan::light_itself;
    }
    enter_stage("exposure time");
    const double seconds = exposure_time(store, configuration, scene.instrument, scene.specimen, devices);
    const auto camera = std::make_shared<const ImagingCamera>(configuration, scene.instrument, seconds);
    return [camera](int image, const trace::Image& exposure) { return camera->develop(image, exposure); };
}

GrowingEvaluation::GrowingEvaluation(const StackScene& scene, topography::FocusPlanesMaker planes,
                                     const std::vector<optics::PupilFilter>& filters)
    : scene_(scene), errors_{.flat = read_flat(scene.configuration, scene.pixels(),
                                               height_pitch(scene.instrument, scene.configuration)),
                             .design = optics::field_curvature(scene.instrument.first_order)},
      evaluation_(evaluation_options(scene.configuration, scene.instrument), std::move(planes),
                  diffraction_of_evaluation(scene.configuration, scene.instrument),
                  static_cast<int>(scene.positions.size())) {
    truth_ = in_background([&scene] { return truth_on_pixels(scene.instrument, scene.configuration, scene.specimen); });
    source_ = in_background([&scene] { return stack_source(scene.configuration, scene.instrument); });
    if (scene.configuration.trace.estimator == trace::Estimator::backward) {
        light_way_ = in_background(
            [&scene] { return light_way(scene.configuration, scene.instrument, scene.specimen, scene.positions); });
    }
    if (!filters.empty()) {
        wave_limits_ =
            in_background([&scene, filters] { return worst_of(limits_of_lights(filters, scene.instrument)); });
        phase_limits_ = in_background(
            [&scene] { return phase_limits(scene.configuration.instrument, scene.instrument, scene.specimen); });
    }
}

void GrowingEvaluation::add(int image, Grid<float> values) {
    dark_images_ += std::ranges::any_of(values.values, [](float value) { return value > 0; }) ? 0u : 1u;
    const double z = scene_.positions[static_cast<std::size_t>(image)];
    evaluation_.add({std::move(values)}, z, reading_of(scene_.configuration, z, image));
}

EvaluatedStack GrowingEvaluation::finish(scan::ImageStore& store, const trace::TracerIdentity& tracer) {
    const Configuration& configuration = scene_.configuration;
    const auto camera = camera_figures(store);
    std::vector<Warning> warnings;
    if (dark_images_ == scene_.positions.size() || (camera && !(camera->light.mean > 0))) {
        append(warnings, warning_of_no_light(configuration, scene_.instrument,
                                             scene_.positions.size() *
                                                 trace::launched_rays(configuration.trace, configuration.instrument),
                                             " vkfv image of one position tells where it goes."));
    } else if (dark_images_ > 0) {
        warnings.push_back({.code = "dark-images",
                            .key = configuration.stage ? "stage" : "trace.rays",
                            .value = {},
                            .works = configuration.stage ? "smaller errors of the stage" : "more rays",
                            .sentence = fmt::format(
                                "{} of {} images are without any light: {}.", dark_images_, scene_.positions.size(),
                                configuration.stage ? "the stage holds the specimen far from where they look, or "
                                                      "few rays are launched"
                                                    : "few rays are launched, or the specimen is far from focus")});
    }
    enter_stage("heights and truth");
    std::optional<PhaseLimits> phase;
    if (phase_limits_) {
        phase = phase_limits_->get();
        errors_.hidden_uncertainty = phase->height_uncertainty();
    }
    EvaluatedStack stack{
        .evaluation = evaluation_.finish(truth_.get(), configuration.band, errors_,
                                         specimen::feature_of(*configuration.specimen)),
        .origin = {{"device", tracer.text()},
                   {"stack_digest", store.description().digest},
                   {"seed", configuration.trace.seed},
                   {"images", scene_.positions.size()},
                   {"rays_per_image", trace::launched_rays(configuration.trace, configuration.instrument)}},
        .source = source_.get(),
        .files = topography_files(configuration)};
    stack.source.ledger = light_way_ ? light_way_->get() : scan::mean_ledger(store.folder());
    if (wave_limits_) {
        const WaveLimits limits = wave_limits_->get();
        append(warnings, warnings_of(limits));
        append(warnings, warnings_of(phase.value()));
        stack.origin["waves"] = json_of(limits);
        stack.origin["waves"].update(report::as_declared("results.waves", json_of(*phase)));
    }
    if (camera) {
        stack.origin["camera"] = camera_json(*configuration.camera, *camera);
        append(warnings, warnings_of_images(configuration, *camera));
    }
    append(warnings, warnings_of_noise(configuration, stack.evaluation));
    append(warnings, warnings_of_brightness(stack.evaluation));
    log_warnings(warnings);
    stack.warnings = scene_.warnings;
    append(stack.warnings, warnings);
    if (scan::was_repaired(store.folder())) {
        stack.origin["repaired"] = true;
    }
    if (configuration.stage) {
        stack.origin["stage"] = stage_figures(configuration);
    }
    return stack;
}

void write_stack_results(scan::ImageStore& store, const Configuration& configuration, const EvaluatedStack& stack) {
    if (configuration.stage) {
        store.results().write(stage_file, stage_table(configuration));
    }
    if (configuration.stack_file) {
        enter_stage("images in one file");
        scan::write_stack_file(store);
    }
    enter_stage("results and report");
    write_results(store.results(), stack);
    enter_stage("end");
}

} // namespace vkfv::measurement
