// Which paths of an image leave the source where: shaders/physics/emission_cell.glsl.
#pragma once

#include "optics/instrument/instrument.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vkfv::trace {

// Cells of the emission along a curve on which what lies close together in the field is close together, and in the
// pupil within that; which of the two belongs to the places at the source and which to the directions is seen by rays.
// Where both say where light arrives they take equal shares. All paths of an image together are distributed as
// independent ones: how many lie in a cell is drawn, not shared out, from the multinomial distribution.
class EmissionOrder {
  public:
    // A single cell: no order.
    EmissionOrder() = default;
    // Of images of so many paths (> 0). seed: of the trace.
    EmissionOrder(const optics::Instrument& instrument, std::uint64_t paths, std::uint32_t seed);

    std::size_t cells() const { return given_.size(); }
    double cells_per_path() const { return static_cast<double>(cells()) / static_cast<double>(paths_); }
    // Of each cell in order, what EmissionCell::given is; its `drawn` is the same for all.
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
    // Of a path. Those beyond the image's are in the last.
    physics::f64::EmissionCell of(std::uint64_t path) const;

  private:
    const EmissionOrder* order_;
    std::vector<std::uint64_t> first_paths_;
};

} // namespace vkfv::trace
