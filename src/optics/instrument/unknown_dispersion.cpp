#include "optics/instrument/unknown_dispersion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace vkfv::optics {

namespace {

// The index uncertainty below which no warning is given: through 10 mm of glass, it changes the path between the axis
// and the rim of a cone of aperture 0.3 by 1e-5 * 10 mm * 0.3^2 / 2 = 5 nm.
constexpr double negligible = 1e-5;

std::vector<const Medium*> media_of(const InstrumentDescription& description) {
    std::vector<const Medium*> media;
    for (const Prescription* part : {&description.illumination, &description.objective, &description.tube_lens}) {
        media.push_back(&part->medium_before);
        for (const PrescribedSurface& surface : part->surfaces) {
            media.push_back(&surface.medium_after);
        }
    }
    if (description.splitter.kind != BeamSplitter::Kind::ideal) {
        media.push_back(&description.splitter.glass);
    }
    if (description.cover_glass) {
        media.push_back(&description.cover_glass->glass);
    }
    if (description.immersion) {
        media.push_back(&*description.immersion);
    }
    return media;
}

} // namespace

std::vector<Warning> warning_of_unknown_dispersion(const InstrumentDescription& description) {
    std::vector<std::string> names;
    double greatest = negligible;
    double where_um = 0;
    for (const Medium* medium : media_of(description)) {
        for (const double um : {description.spectrum.shortest_um, description.spectrum.longest_um}) {
            const double uncertainty = medium->dispersion_uncertainty(um);
            if (uncertainty > negligible && std::ranges::find(names, medium->name) == names.end()) {
                names.push_back(medium->name);
            }
            if (uncertainty > greatest) {
                greatest = uncertainty;
                where_um = um;
            }
        }
    }
    if (names.empty()) {
        return {};
    }
    return {{.code = "estimated-dispersion",
             .key = "media",
             .value = {},
             .works = fmt::format("indices at {:.4g} um", where_um),
             .sentence = fmt::format(
                 "The indices of {} are known at the F, d and C lines alone (0.486 um to 0.656 um); at {:.4g} um "
                 "they are those that are usual for their Abbe numbers, which 95 in 100 glasses have within {:.1g}. "
                 "More wavelengths in [media] of a prescription say it better.",
                 fmt::join(names, ", "), where_um, greatest)}};
}

} // namespace vkfv::optics
