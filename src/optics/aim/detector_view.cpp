#include "optics/aim/detector_view.hpp"

#include <limits>

namespace vkfv::optics {

std::optional<DetectorView::Found> DetectorView::find(glm::dvec2 cosines) const {
    constexpr int most_steps = 25;
    constexpr double enough = 1e-11; // mm in the object; rounding is 1e-14 of a train's length
    glm::dvec2 point = guess;
    auto landing = imaging.trace(point, plane, cosines, 0);
    glm::dmat2 rate(magnification); // derivative of the landing point by the object point
    for (int step = 0; landing && step < most_steps; ++step) {
        const glm::dvec2 miss = landing->position - detector;
        const glm::dvec2 move = -(glm::inverse(rate) * miss);
        const double length_squared = glm::dot(move, move);
        if (length_squared < enough * enough) {
            return Found{.point = point, .move = move, .landing = *landing};
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

std::optional<TracedWave> DetectorView::trace(glm::dvec2 p, std::uint32_t apertures) const {
    const auto found = find(p / index);
    if (!found || (apertures != 0u && !imaging.trace(found->point, plane, p / index, apertures))) {
        return std::nullopt;
    }
    const auto& [point, move, landing] = *found;
    const double rest = glm::dot(glm::dvec2(landing.direction), landing.position - detector);
    return TracedWave{.object_point = point + move,
                      .path_length = landing.path_length - rest - glm::dot(p, move),
                      .slope = glm::dvec2(landing.direction) / landing.direction.z};
}

double DetectorView::excess(glm::dvec2 p) const {
    const auto found = find(p / index);
    return found ? imaging.excess(found->point, plane, p / index) : std::numeric_limits<double>::infinity();
}

} // namespace vkfv::optics
