// An instrument, a specimen and a scan, whose images are traced in this process.
#pragma once

#include "vkfv/image.hpp"
#include "vkfv/topography.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vkfv {

// Told of each image of a stack when it is there. An exception that it throws ends the stack and reaches the caller.
using ImageProgress = std::function<void(int done, int images)>;

// Every function throws Error alone, and what a caller's own function throws. A scene keeps its device, surface,
// instrument and kernels, and makes again only what a changed key needs. Several threads may call one scene, which
// then works for one after the other; several scenes work side by side.
// Warnings go to standard error.
class Scene {
  public:
    // file: a configuration of the command `vkfv stack`.
    explicit Scene(const std::string& file);
    ~Scene();
    Scene(Scene&&) noexcept;
    Scene& operator=(Scene&&) noexcept;

    // Sets a key, "specimen.material.g", to a text of TOML: "0.5", "[64, 48]"; any other text is taken as a string. If
    // the configuration is then wrong, it throws and the scene stays as it was.
    void set(const std::string& key, const std::string& value);
    void set(const std::string& key, double value);

    std::vector<double> positions_um() const; // of the scan
    // The configuration with all its keys, as TOML.
    std::string configuration() const;

    // The exposure with the focal plane at this height (um), to the bits of `vkfv image --z`.
    Image image(double z_um);
    // The images of the scan, to the bits of `vkfv stack`.
    Stack stack(const ImageProgress& progress = {});
    // Heights of the images of this scene's scan, by its table [topography]. They may be changed images.
    Topography evaluate(const Stack& stack);

    // How often this scene has made its surface and instrument: once for each light that its keys asked for in turn.
    int lights_made() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace vkfv
