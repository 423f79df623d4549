// The order in which the paths of an image leave the source: shaders/physics/emission_cell.glsl.
#pragma once

#include "optics/instrument/instrument.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vkfv::trace {

// Cells of the emission along a curve on which neighbours in the field stay close together, and within that neighbours
// in the pupil; rays show which of the two belongs to the places at the source and which to the directions. Where both
// decide where light arrives they take equal shares. All paths of an image together are distributed as independent
// ones: the number in each cell is drawn from the multinomial distribution, not shared out.
class EmissionOrder {
  public:
    // An order of a single cell: paths are not ordered.
    EmissionOrder() = default;
    // The order for images of so many paths (> 0). seed: of the trace.
    EmissionOrder(const optics::Instrument& instrument, std::uint64_t paths, std::uint32_t seed);

    std::size_t cells() const { return given_.size(); }
    double cells_per_path() const { return static_cast<double>(cells()) / static_cast<double>(paths_); }
    // EmissionCell::given of each cell in order; EmissionCell::drawn is the same for all.
    std::span<const glm::uvec4> given() const { return given_; }
    glm::uvec4 drawn() const { return drawn_; }
    // The first path of each cell in an image, and the number of paths at the end.
    std::vector<std::uint64_t> first_paths(std::uint32_t image) const;

  private:
    std::uint64_t paths_ = 1;
    std::uint32_t seed_ = 1;
    std::vector<glm::uvec4> given_{glm::uvec4(0)};
    glm::uvec4 drawn_{~0u};
};

// The cells of one image, for the host. The order must outlive it.
class EmissionCells {
  public:
    EmissionCells(const EmissionOrder& order, std::uint32_t image)
        : order_(&order), first_paths_(order.first_paths(image)) {}
    // The cell of a path. Paths beyond the image's are in the last cell.
    physics::f64::EmissionCell of(std::uint64_t path) const;

  private:
    const EmissionOrder* order_;
    std::vector<std::uint64_t> first_paths_;
};

} // namespace vkfv::trace
