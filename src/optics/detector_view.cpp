#include "optics/detector_view.hpp"

namespace vkfv::optics {

std::optional<TracedWave> DetectorView::trace(glm::dvec2 p, std::uint32_t apertures) const {
    constexpr int most_steps = 25;
    constexpr double enough = 1e-11; // mm in the object; rounding leaves 1e-14 of a train's length
    const glm::dvec2 cosines = p / index;
    glm::dvec2 point = guess;
    auto landing = imaging.trace(point, plane, cosines, 0);
    glm::dmat2 rate(magnification); // of the landing with the point
    for (int step = 0; landing && step < most_steps; ++step) {
        const glm::dvec2 miss = landing->position - detector;
        const glm::dvec2 move = -(glm::inverse(rate) * miss);
        const double length_squared = glm::dot(move, move);
        if (length_squared < enough * enough) {
            if (apertures != 0u && !imaging.trace(point, plane, cosines, apertures)) {
                return std::nullopt;
            }
            // What is missing to the point, to first order.
            const double rest = glm::dot(glm::dvec2(landing->direction), miss);
            return TracedWave{.object_point = point + move,
                              .path_length = landing->path_length - rest - glm::dot(p, move),
                              .slope = glm::dvec2(landing->direction) / landing->direction.z};
        }
        const glm::dvec2 before = landing->position;
        point += move;
        landing = imaging.trace(point, plane, cosines, 0);
        if (landing) {
            rate += glm::outerProduct(landing->position - before - rate * move, move) / length_squared;
        }
    }
    return std::nullopt;
}

} // namespace vkfv::optics
