// Stacks that one process measures one after the other. Their common parts are made once.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/progress.hpp"
#include "measurement/scene/surfaces.hpp"
#include "measurement/scene/working_devices.hpp"
#include "measurement/stack/stack.hpp"
#include "measurement/stack/stack_parts.hpp"
#include "trace/interface/tracer.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::measurement {

// Configurations with equal texts have images of the same bits, if one device traces them.
std::string image_key(const Configuration& configuration);
// Configurations with equal texts have the same light on the detector; different cameras may make different images of
// it.
std::string light_key(const Configuration& configuration);

// A stack among other stacks of the same process.
struct StackAmongOthers {
    // Folders of stacks with the same image_key(), whose images are taken as far as they are there.
    std::vector<std::filesystem::path> same_images;
    // Configurations with the same light_key(), each with an image_key() of its own. Their images are made, in their
    // folders, of the light that is traced now.
    std::vector<const Configuration*> same_light;
    bool light_again = false; // a stack with the same light_key() follows
    bool more = false;        // any other stack follows
};

class StackRuns {
  public:
    // Measures a stack as measure_stack() does, to the same bits. Devices stay open for the next stack, and a stack
    // with the same light_key() uses the scene and kernels again. Throws as measure_stack() does; the same call
    // continues.
    StackResult measure(const Configuration& configuration, Progress& progress, const StackAmongOthers& others = {});

    struct Traced {
        scan::StackSummary traced; // images that this run traced or found
        std::string device;        // that traced the images
    };
    // Traces a stack's images as measure() does, to the same bits, and evaluates nothing. `visit` sees each image once
    // in order, and again from the first where a device failed. Throws as measure_stack() does; the same call
    // continues.
    Traced trace(const Configuration& configuration, Progress& progress, const scan::ImageVisitor& visit);

    // The devices that the configuration asks for; open devices are used again.
    WorkingDevices& devices_of(const Configuration& configuration);

  private:
    // The parts of a stack that depend on the light alone.
    struct Light {
        std::string key;
        std::shared_ptr<const StackScene::Parts> parts;
        std::unique_ptr<trace::Tracer> tracer; // null: to be made
    };

    // Makes the parts of this light, unless those at hand are the same. keep_surface: another stack may have it too.
    void take_light(const Configuration& configuration, bool keep_surface);
    StackResult trace_and_evaluate(const StackScene& scene, const WorkingDevices& devices,
                                   const StackAmongOthers& others, Progress& progress);

    std::string selector_;
    std::optional<WorkingDevices> devices_;
    std::optional<Light> light_;
    Surfaces surfaces_;
};

} // namespace vkfv::measurement
