#include "fields/facet.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

namespace vkfv::fields {

namespace {

constexpr int slopes = 64;
constexpr int lattice = 160; // points across the source

} // namespace

FacetLight::FacetLight(double pupil_rim, double source_rim, double dark_rim, double index) {
    // A facet turns light by twice its angle; beyond the sum of both half angles none reaches the pupil.
    const double most = std::tan(std::min(
        1.4, (std::asin(std::min(0.9999, pupil_rim / index)) + std::asin(std::min(0.9999, source_rim / index))) / 2));
    step_ = most / (slopes - 1);
    for (int k = 0; k < slopes; ++k) {
        const double slope = k * step_;
        const glm::dvec3 normal = glm::normalize(glm::dvec3(-slope, 0, 1));
        double lit = 0, reflected = 0, as_transferred = 0;
        for (int row = 0; row < lattice; ++row) {
            for (int column = 0; column < lattice; ++column) {
                const glm::dvec2 s = source_rim * (glm::dvec2(column + 0.5, row + 0.5) / (lattice / 2.0) - 1.0);
                if (glm::length(s) >= source_rim || glm::length(s) < dark_rim) {
                    continue;
                }
                lit += 1;
                const double gamma_s = std::sqrt(index * index - glm::dot(s, s));
                const glm::dvec3 incident(s, -gamma_s);
                const glm::dvec3 p = incident - 2 * glm::dot(incident, normal) * normal;
                const double radius = std::hypot(p.x, p.y);
                if (p.z > 0 && radius < pupil_rim && radius >= dark_rim) {
                    reflected += 1;
                    // 1 + q p / (q_z gamma_p) with q = p - s
                    as_transferred += 1 / (1 + (p.x * (p.x - s.x) + p.y * (p.y - s.y)) / (p.z * (p.z + gamma_s)));
                }
            }
        }
        shares_.push_back(reflected / lit);
        amplitudes_.push_back(reflected > 0 ? reflected / as_transferred : amplitudes_.back());
    }
}

double FacetLight::at(const std::vector<double>& values, double slope) const {
    const double place = std::min(slope / step_, slopes - 1 - 1e-9);
    const auto below = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(below);
    return values[below] + share * (values[below + 1] - values[below]);
}

} // namespace vkfv::fields
