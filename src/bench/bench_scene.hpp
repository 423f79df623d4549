// The scene and device on which the parts of vkfv bench are measured, and the timing of runs.
#pragma once

#include "bench/bench.hpp"
#include "configuration/configuration.hpp"
#include "optics/instrument/instrument.hpp"
#include "specimen/specimen.hpp"
#include "trace/interface/tracer.hpp"
#include "vulkan/device.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vkfv::bench {

inline constexpr double in_focus = 0; // focal height of all exposures, mm

double median(std::vector<double> values);
// The spread (max - min) / median.
double spread(const std::vector<double>& values);

// A traversal or estimator that is compared with others.
struct Way {
    std::string name;
    trace::TraceOptions options;
    std::uint64_t rays = 0; // rays of an image; 0: the number of a run
};

class BenchScene {
  public:
    // `options` must outlive the object. Throws InputError, DeviceError.
    explicit BenchScene(const BenchOptions& options);

    const BenchOptions& options() const { return options_; }
    const Configuration& configuration() const { return configuration_; }
    const vulkan::DeviceReport& device() const { return device_; }
    const specimen::Specimen& specimen() const { return specimen_; }
    const optics::Instrument& instrument() const { return instrument_; }
    bool software() const { return vulkan::is_software(device_); }

    // Rays of a run: as many as the device traces in the time of a run, at most the configuration's; 0 until settled.
    std::uint64_t rays() const { return rays_; }
    void settle_rays();

    std::unique_ptr<trace::Tracer> tracer_of(trace::TraceOptions options, std::uint64_t rays) const;

    // Exposes until the clocks of an idle GPU have risen.
    void warm_up(const trace::Tracer& tracer) const;
    // A timing (bench.hpp), in so many runs or in the number of the options.
    Json timing(const trace::Tracer& tracer, int runs) const;
    Json timing(const trace::Tracer& tracer) const { return timing(tracer, options_.runs); }

    // The traversals that the specimen and the device admit.
    std::vector<Way> traversals() const;
    // The estimators; the first is the reference for the others' efficiency.
    std::vector<Way> estimators() const;

  private:
    const BenchOptions& options_;
    Configuration configuration_;
    // Each tracer opens the device anew. This one stays open, so that the driver stays loaded: NVIDIA's, loaded anew
    // some fifty times, was seen to fail.
    vulkan::Device kept_;
    vulkan::DeviceReport device_;
    specimen::Specimen specimen_;
    optics::Instrument instrument_;
    std::uint64_t rays_ = 0;
    mutable std::chrono::steady_clock::time_point last_busy_{};
};

// An instrument that can also trace backward, unless its light is a ring.
optics::Instrument instrument_of(const Configuration& configuration, const specimen::Specimen& specimen);

} // namespace vkfv::bench
