#include "optics/aim/best_focus.hpp"

#include "core/threads/parallel_list.hpp"
#include "optics/aim/detector_view.hpp"

#include <cmath>
#include <vector>

namespace vkfv::optics {

namespace {

struct Sample {
    glm::dvec2 p = glm::dvec2(0);
    double path = 0;    // wavefront W, mm
    double defocus = 0; // change of W by a plane higher by 1 mm
    double weight = 0;
    glm::dvec2 place = glm::dvec2(0); // mm, in the paraxial object plane
    glm::dvec2 slope = glm::dvec2(0);
};

// Subtracts the mean and the fitted tilt from the paths and from the defocus.
void level(std::vector<Sample>& samples) {
    Sample mean;
    for (const Sample& sample : samples) {
        mean.weight += sample.weight;
        mean.p += sample.weight * sample.p;
        mean.path += sample.weight * sample.path;
        mean.defocus += sample.weight * sample.defocus;
    }
    glm::dmat2 normal(0);
    glm::dvec2 of_path(0);
    glm::dvec2 of_defocus(0);
    for (Sample& sample : samples) {
        sample.p -= mean.p / mean.weight;
        sample.path -= mean.path / mean.weight;
        sample.defocus -= mean.defocus / mean.weight;
        normal += sample.weight * glm::outerProduct(sample.p, sample.p);
        of_path += sample.weight * sample.path * sample.p;
        of_defocus += sample.weight * sample.defocus * sample.p;
    }
    if (!(glm::determinant(normal) > 0)) {
        return;
    }
    const glm::dmat2 inverse = glm::inverse(normal);
    for (Sample& sample : samples) {
        sample.path -= glm::dot(inverse * of_path, sample.p);
        sample.defocus -= glm::dot(inverse * of_defocus, sample.p);
    }
}

} // namespace

PencilFocus focus_of_pencil(const Imaging& imaging, double magnification, const Outline& outline, glm::dvec2 detector,
                            std::span<const SpectralNode> spectrum) {
    if (!(outline.area() > 0)) {
        return {.height = NAN, .centroid = glm::dvec2(NAN)};
    }
    const auto cone = fill_cone(outline);
    const auto samples_of = [&](int k) {
        const Imaging alone = at_wavelength(imaging, spectrum[static_cast<std::size_t>(k)].spectral);
        const double index = alone.train.front().index_before;
        const DetectorView view{.imaging = alone,
                                .index = index,
                                .magnification = magnification,
                                .plane = 0,
                                .detector = detector,
                                .guess = outline.position};
        std::vector<Sample> samples;
        for (const auto& [cosines, weight] : cone) {
            const glm::dvec2 p = index * cosines;
            if (const auto traced = view.trace(p, 0)) {
                const double axial = std::sqrt(index * index - glm::dot(p, p));
                samples.push_back({.p = p,
                                   .path = -traced->path_length - glm::dot(p, traced->object_point - outline.position),
                                   .defocus = axial,
                                   .weight = weight,
                                   .place = traced->object_point,
                                   .slope = p / axial});
            }
        }
        level(samples);
        return samples;
    };
    const auto all = parallel_list(static_cast<int>(spectrum.size()), samples_of);
    double numerator = 0;
    double denominator = 0;
    double light = 0;
    PencilFocus focus;
    glm::dvec2 slope(0);
    for (std::size_t k = 0; k < all.size(); ++k) {
        const SpectralNode& node = spectrum[k];
        for (const Sample& sample : all[k]) {
            const double weight = node.weight * sample.weight / (node.wavelength_um * node.wavelength_um);
            numerator += weight * sample.path * sample.defocus;
            denominator += weight * sample.defocus * sample.defocus;
            light += node.weight * sample.weight;
            focus.centroid += node.weight * sample.weight * sample.place;
            slope += node.weight * sample.weight * sample.slope;
        }
    }
    focus.height = denominator > 0 ? -numerator / denominator : 0;
    focus.centroid = (focus.centroid + focus.height * slope) / light;
    return focus;
}

double best_focus(const Imaging& imaging, double magnification, const Outline& outline,
                  std::span<const SpectralNode> spectrum) {
    const auto chief = imaging.trace(outline.position, 0, outline.centre, 0);
    return chief ? focus_of_pencil(imaging, magnification, outline, chief->position, spectrum).height : NAN;
}

} // namespace vkfv::optics
