#include "vkfv/scene.hpp"

#include "configuration/configuration.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "measurement/evaluation/evaluation.hpp"
#include "measurement/image/exposure.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/known_truth.hpp"
#include "measurement/scene/phase_limits.hpp"
#include "measurement/scene/stage_figures.hpp"
#include "measurement/stack/stack_runs.hpp"
#include "optics/instrument/field_curvature.hpp"
#include "scan/stack.hpp"
#include "specimen/kinds.hpp"
#include "vkfv/error.hpp"
#include "vulkan/device.hpp"
#include "vulkan/failure.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <future>
#include <mutex>
#include <new>
#include <utility>

namespace vkfv {

namespace {

Error error_of(const InputError& error) {
    std::vector<ErrorProblem> problems;
    for (const InputProblem& problem : error.problems()) {
        problems.push_back({.place = problem.where.to_string(),
                            .key = problem.key,
                            .found = problem.found,
                            .expectation = problem.expected,
                            .remedy = problem.remedy});
    }
    return Error(Error::Cause::input, error.what(), std::move(problems));
}

// Does the work, and throws what it throws of vkfv's own as an Error.
template <class Work>
auto with_errors(const Work& work) {
    try {
        return work();
    } catch (const InputError& error) {
        throw error_of(error);
    } catch (const DeviceError& error) {
        throw Error(Error::Cause::device, error.what());
    } catch (const RunError& error) {
        throw Error(Error::Cause::run, error.what());
    } catch (const vk::SystemError& failure) {
        throw Error(Error::Cause::run, vulkan::run_error_of(failure).what());
    } catch (const std::filesystem::filesystem_error& error) {
        throw Error(Error::Cause::run, error.what());
    } catch (const std::bad_alloc&) {
        throw Error(Error::Cause::run, "the host has not enough memory. Choose fewer pixels or positions");
    }
}

std::once_flag prepared, at_exit;
vulkan::DriverScope* drivers = nullptr;

// Prepares the process: drivers stay open for the next scene, and messages go to standard error, unless the caller has
// given spdlog a logger of its own.
void prepare_process() {
    std::call_once(prepared, [] {
        drivers = new vulkan::DriverScope;
        if (spdlog::default_logger()->name().empty()) {
            auto logger = spdlog::stderr_color_mt("libvkfv");
            logger->set_level(spdlog::level::warn);
            spdlog::set_default_logger(std::move(logger));
        }
    });
}

// Does work on a device, and has the drivers closed when the process ends. They are closed before their own static
// objects end, since what is registered last is done first, and the drivers are loaded during the first work.
template <class Work>
auto with_device(const Work& work) {
    auto result = with_errors(work);
    std::call_once(at_exit, [] { (void)std::atexit([] { delete drivers; }); });
    return result;
}

// Light is what this library hands over; grey values are the command's alone.
void refuse_camera(const Configuration& configuration) {
    if (configuration.camera) {
        throw InputError({.where = {.file = configuration.file},
                          .key = "camera",
                          .found = "a camera",
                          .expected = "no [camera], since images in process are light",
                          .remedy = "Remove [camera], or take the images by the command vkfv stack."});
    }
}

Image image_of(const trace::Image& exposure, const PixelGrid& grid, double z) {
    return {.columns = exposure.flux.columns,
            .rows = exposure.flux.rows,
            .x0_um = grid.x0 * um_per_mm,
            .y0_um = grid.y0 * um_per_mm,
            .pitch_um = grid.pitch_x * um_per_mm,
            .z_um = z * um_per_mm,
            .flux = scan::light_itself(0, exposure).values.values,
            .standard_error = exposure.standard_error.values};
}

std::vector<double> in_um(std::vector<double> lengths) {
    for (double& length : lengths) {
        length *= um_per_mm;
    }
    return lengths;
}

Topography topography_of(const measurement::Evaluation& evaluation) {
    const auto& found = evaluation.topography;
    Topography result{.columns = found.height.columns(),
                      .rows = found.height.rows(),
                      .x0_um = found.height.x0 * um_per_mm,
                      .y0_um = found.height.y0 * um_per_mm,
                      .pitch_um = found.height.pitch_x * um_per_mm,
                      .heights_um = in_um(found.height.height.values),
                      .height_uncertainty_um = in_um(found.height_uncertainty.values),
                      .height_noise_um = in_um(found.height_noise.values),
                      .contrast = found.contrast.values,
                      .truth_um = evaluation.truth ? in_um(evaluation.truth->height.values) : std::vector<double>(),
                      .measured = std::vector<std::uint8_t>(found.state.values.size())};
    std::ranges::transform(found.state.values, result.measured.begin(), [](topography::PointState state) {
        return static_cast<std::uint8_t>(state == topography::PointState::measured ? 1 : 0);
    });
    return result;
}

} // namespace

struct Scene::State {
    std::filesystem::path file;
    std::vector<TomlOverride> overrides{};
    Configuration configuration{};
    measurement::StackRuns runs{};
    std::mutex one_at_a_time{};
};

Scene::Scene(const std::string& file) : state_(std::make_unique<State>()) {
    prepare_process();
    state_->file = file;
    with_errors([&] { state_->configuration = load_configuration(file, {}, Needs::stack); });
}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

void Scene::set(const std::string& key, const std::string& value) {
    const std::scoped_lock lock(state_->one_at_a_time);
    auto overrides = state_->overrides;
    std::erase_if(overrides, [&](const TomlOverride& override) { return override.key == key; });
    overrides.push_back({key, value, "Scene::set()"});
    with_errors([&] { state_->configuration = load_configuration(state_->file, overrides, Needs::stack); });
    state_->overrides = std::move(overrides);
}

void Scene::set(const std::string& key, double value) {
    set(key, fmt::format("{}", value));
}

std::vector<double> Scene::positions_um() const {
    const std::scoped_lock lock(state_->one_at_a_time);
    return in_um(state_->configuration.scan->positions());
}

std::string Scene::configuration() const {
    const std::scoped_lock lock(state_->one_at_a_time);
    return state_->configuration.canonical;
}

int Scene::lights_made() const {
    const std::scoped_lock lock(state_->one_at_a_time);
    return state_->runs.lights_made();
}

Image Scene::image(double z_um) {
    const std::scoped_lock lock(state_->one_at_a_time);
    return with_device([&] {
        const Configuration& configuration = state_->configuration;
        refuse_camera(configuration);
        const double z = z_um / um_per_mm;
        const auto positions = configuration.scan->positions();
        const auto index = measurement::image_index(configuration, z);
        Image result;
        if (index == positions.size()) { // the instrument's aim holds for the heights of its scan alone
            const auto specimen = measurement::make_specimen(configuration);
            const auto instrument = measurement::instrument_for(configuration, specimen, z);
            const auto exposure =
                measurement::expose(configuration, state_->runs.devices_of(configuration), instrument, specimen, z);
            return image_of(exposure.image, exposure.grid, z);
        }
        state_->runs.with_light(configuration, [&](const measurement::StackScene& scene, const trace::Tracer& tracer) {
            result =
                image_of(tracer.expose(z, index), measurement::grid_of_image(scene.instrument, configuration, z), z);
        });
        return result;
    });
}

Stack Scene::stack(const ImageProgress& progress) {
    const std::scoped_lock lock(state_->one_at_a_time);
    return with_device([&] {
        const Configuration& configuration = state_->configuration;
        refuse_camera(configuration);
        Stack stack;
        state_->runs.with_light(configuration, [&](const measurement::StackScene& scene, const trace::Tracer& tracer) {
            stack.images.clear(); // those of a device that failed
            const auto& positions = scene.positions;
            std::deque<std::future<trace::Image>> under_way;
            for (std::size_t next = 0; stack.images.size() < positions.size();) {
                while (next < positions.size() && static_cast<int>(under_way.size()) < tracer.most_under_way()) {
                    under_way.push_back(tracer.begin(positions[next], static_cast<std::uint32_t>(next)));
                    ++next;
                }
                const trace::Image exposure = under_way.front().get();
                under_way.pop_front();
                const double z = positions[stack.images.size()];
                stack.images.push_back(
                    image_of(exposure, measurement::grid_of_image(scene.instrument, configuration, z), z));
                if (progress) {
                    progress(static_cast<int>(stack.images.size()), static_cast<int>(positions.size()));
                }
            }
        });
        return stack;
    });
}

Topography Scene::evaluate(const Stack& stack) {
    const std::scoped_lock lock(state_->one_at_a_time);
    return with_device([&] {
        const Configuration& configuration = state_->configuration;
        refuse_camera(configuration);
        const auto positions = configuration.scan->positions();
        const ImageSize pixels = configuration.instrument.detector_pixels;
        const auto fits = [&](const Image& image) {
            return image.columns == pixels.columns && image.rows == pixels.rows && image.flux.size() == pixels.count();
        };
        if (stack.images.size() != positions.size() || !std::ranges::all_of(stack.images, fits)) {
            throw InputError({.where = {},
                              .key = "stack",
                              .found = fmt::format("{} images", stack.images.size()),
                              .expected = fmt::format("{} images of {} x {} pixels, those of the scan",
                                                      positions.size(), pixels.columns, pixels.rows),
                              .remedy = "Give the images of Scene::stack(), changed or not, in their order."});
        }
        Topography result;
        state_->runs.with_light(configuration, [&](const measurement::StackScene& scene, const trace::Tracer& tracer) {
            const auto& instrument = scene.instrument;
            measurement::StackEvaluation evaluation(
                measurement::evaluation_options(configuration, instrument),
                measurement::focus_planes_for(configuration.evaluate_on, tracer.device()),
                measurement::diffraction_of_evaluation(configuration, instrument), 0);
            for (std::size_t k = 0; k < positions.size(); ++k) {
                Grid<float> values(pixels.columns, pixels.rows);
                values.values = stack.images[k].flux;
                evaluation.add({std::move(values)}, positions[k],
                               measurement::reading_of(configuration, positions[k], static_cast<int>(k)));
            }
            measurement::KnownErrors errors{
                .flat =
                    measurement::read_flat(configuration, pixels, measurement::height_pitch(instrument, configuration)),
                .design = optics::field_curvature(instrument.first_order)};
            if (!tracer.pupil_filters().empty()) {
                errors.hidden_uncertainty =
                    measurement::phase_limits(configuration.instrument, instrument, scene.specimen)
                        .height_uncertainty();
            }
            result = topography_of(
                evaluation.finish(measurement::truth_on_pixels(instrument, configuration, scene.specimen),
                                  configuration.band, errors, specimen::feature_of(*configuration.specimen)));
        });
        return result;
    });
}

} // namespace vkfv
