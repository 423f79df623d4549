// The parts that a stack's images and results have in common, whether one run traced the images or several shards.
#pragma once

#include "configuration/configuration.hpp"
#include "measurement/evaluation/evaluation.hpp"
#include "measurement/evaluation/evaluation_files.hpp"
#include "measurement/scene/known_truth.hpp"
#include "measurement/scene/phase_limits.hpp"
#include "measurement/scene/surfaces.hpp"
#include "measurement/scene/wave_limits.hpp"
#include "measurement/scene/working_devices.hpp"
#include "optics/instrument/instrument.hpp"
#include "scan/stack.hpp"
#include "scan/store.hpp"
#include "specimen/specimen.hpp"
#include "trace/interface/tracer_identity.hpp"

#include <future>
#include <memory>
#include <optional>
#include <vector>

namespace vkfv::measurement {

// The instrument and the specimen of a configuration's stack.
class StackScene {
  public:
    struct Parts {
        specimen::Specimen specimen;
        optics::Instrument instrument;
    };

    // surfaces: may hold the specimen's surface already; null: the surface is made. Throws InputError.
    static std::shared_ptr<const Parts> make_parts(const Configuration& configuration, Surfaces* surfaces = nullptr);

    // The scene of the configuration, which must outlive it. The log gets the plan's warnings. Throws InputError.
    explicit StackScene(const Configuration& configuration);
    // The scene of a configuration whose parts were made for another one. It writes nothing to the log.
    StackScene(const Configuration& configuration, std::shared_ptr<const Parts> parts);

    ImageSize pixels() const { return configuration.instrument.detector_pixels; }
    scan::StackDescription description(const trace::TracerIdentity& tracer) const;
    const std::shared_ptr<const Parts>& parts() const { return parts_; }

  private:
    std::shared_ptr<const Parts> parts_;

  public:
    const Configuration& configuration;
    std::vector<double> positions; // focal heights, mm
    const specimen::Specimen& specimen;
    const optics::Instrument& instrument;
    std::vector<Warning> planned;  // warnings of the plan
    std::vector<Warning> warnings; // of the plan and the instrument, in the log already
};

// The function that converts light to stored images, by the camera if there is one. The configuration must outlive it.
scan::ImageDeveloper developer_of(const StackScene& scene, const scan::ImageStore& store,
                                  const WorkingDevices& devices);

// Evaluates a stack while its images come. Meanwhile threads make everything that needs no image.
class GrowingEvaluation {
  public:
    // filters: the pupil filter of each source's light for images of waves; empty for images of rays. The scene must
    // outlive the evaluation.
    GrowingEvaluation(const StackScene& scene, topography::FocusPlanesMaker planes,
                      const std::vector<optics::PupilFilter>& filters);

    // Adds an image. Images must come in their order.
    void add(int image, Grid<float> values);

    // Heights and deviations, after the last image. Warnings go to the log.
    EvaluatedStack finish(scan::ImageStore& store, const trace::TracerIdentity& tracer);

  private:
    const StackScene& scene_;
    KnownErrors errors_;
    StackEvaluation evaluation_;
    std::size_t dark_images_ = 0; // number of images without any light
    std::future<KnownTruth> truth_;
    std::future<StackSource> source_;
    std::optional<std::future<scan::MeanLedger>> light_way_; // of images that are traced backward
    std::optional<std::future<WaveLimits>> wave_limits_;
    std::optional<std::future<PhaseLimits>> phase_limits_;
};

// Writes the files of a stack's evaluation into the store's folder.
void write_stack_results(scan::ImageStore& store, const Configuration& configuration, const EvaluatedStack& stack);

} // namespace vkfv::measurement
