// What a stack's images and its results have in common, whoever traced the images: one run, or shards.
#pragma once

#include "configuration/configuration.hpp"
#include "measurement/evaluation/evaluation.hpp"
#include "measurement/evaluation/evaluation_files.hpp"
#include "measurement/scene/known_truth.hpp"
#include "measurement/scene/phase_limits.hpp"
#include "measurement/scene/wave_limits.hpp"
#include "optics/instrument/instrument.hpp"
#include "scan/store.hpp"
#include "specimen/specimen.hpp"
#include "trace/interface/tracer_identity.hpp"

#include <future>
#include <optional>
#include <vector>

namespace vkfv::measurement {

// Instrument and specimen of a configuration's stack.
struct StackScene {
    // Throws InputError. The configuration must outlive it.
    explicit StackScene(const Configuration& configuration);

    ImageSize pixels() const { return configuration.instrument.detector_pixels; }
    scan::StackDescription description(const trace::TracerIdentity& tracer) const;

    const Configuration& configuration;
    std::vector<double> positions; // focal heights, mm
    specimen::Specimen specimen;
    optics::Instrument instrument;
    std::vector<Warning> warnings; // of both and of the plan; the log has them
};

// A stack that is evaluated while its images come. What no image is needed for is made beside them.
class GrowingEvaluation {
  public:
    // filters: what makes the images as waves do, one a light; none: they are as rays make them. The scene must outlive
    // it.
    GrowingEvaluation(const StackScene& scene, topography::FocusPlanesMaker planes,
                      const std::vector<optics::PupilFilter>& filters);

    // In the images' order.
    void add(int image, Grid<float> values);

    // After the last image: heights and their deviations. Warnings go to the log.
    EvaluatedStack finish(scan::ImageStore& store, const trace::TracerIdentity& tracer);

  private:
    const StackScene& scene_;
    KnownErrors errors_;
    StackEvaluation evaluation_;
    bool any_light_ = false;
    std::future<KnownTruth> truth_;
    std::future<StackSource> source_;
    std::optional<std::future<WaveLimits>> wave_limits_;
    std::optional<std::future<PhaseLimits>> phase_limits_;
};

// The files of a stack's evaluation in the store's folder.
void write_stack_results(scan::ImageStore& store, const Configuration& configuration, const EvaluatedStack& stack);

} // namespace vkfv::measurement
