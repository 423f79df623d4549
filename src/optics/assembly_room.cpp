#include "optics/assembly.hpp"

#include "core/units.hpp"
#include "optics/first_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::optics {

namespace {

Element make_element(Element::Kind kind, const PlacedSurface& placed, const char* part) {
    Element result;
    result.kind = (placed.surface.flags & physics::f64::SURFACE_IDEAL_LENS) != 0 ? Element::Kind::ideal_lens
                  : kind == Element::Kind::surface && placed.surface.index_before == placed.surface.index_after
                      ? Element::Kind::stop
                      : kind;
    result.surface = placed.surface;
    result.pose = placed.pose;
    result.name = placed.name;
    result.part = part;
    return result;
}

} // namespace

// Every element once, the light's way folded, heights over the plane of best focus.
void Assembly::furnish() {
    auto& elements = instrument.elements;
    const auto add_part = [&](const Part& part, Element::Kind kind, const char* name) {
        for (const PlacedSurface& placed : part) {
            elements.push_back(make_element(kind, placed, name));
        }
    };
    // In a mirror's space stands what lies behind it in the light's direction, for the illumination what lies
    // before.
    const auto fold_back = [&](std::size_t from, std::size_t to, const Pose& mirror) {
        for (std::size_t i = from; i < to; ++i) {
            elements[i].pose = elements[i].pose.mirrored_in(mirror);
        }
    };
    if (!description.ring) {
        add_part(illuminator, Element::Kind::surface, "illuminator");
        for (const Fold* fold :
             folds_of(FoldMirror::Path::illumination)) { // from the illuminator on: each shows all before it
            fold_back(0, elements.size(), fold->mirror.pose);
            instrument.source_pose = instrument.source_pose.mirrored_in(fold->mirror.pose);
            add_part({fold->mirror}, Element::Kind::mirror, "fold mirror");
        }
        if (splitter.kind == BeamSplitter::Kind::cube) {
            PlacedSurface face = splitter_imaging.front();
            face.pose = downward(splitter_height + half_size);
            add_part({face}, Element::Kind::surface, "beam splitter");
        }
        fold_back(0, elements.size(), splitter_pose);
        instrument.source_pose = instrument.source_pose.mirrored_in(splitter_pose);
    }
    add_part(cover, Element::Kind::surface, "cover glass");
    add_part(objective, Element::Kind::surface, "objective");
    PlacedSurface splitting = mirror_plane(splitter_pose, splitter.semi_diameter, "beam splitter's coating");
    splitting.surface.reflectance = splitter.reflectance;
    std::vector<std::pair<std::size_t, Pose>> mirrors; // first element behind, unfolded plane
    if (splitter.kind == BeamSplitter::Kind::plate) {
        Element coated = make_element(Element::Kind::splitter, splitter_imaging.front(), "beam splitter");
        coated.surface.reflectance = splitter.reflectance;
        elements.push_back(coated);
        elements.push_back(make_element(Element::Kind::surface, splitter_imaging.back(), "beam splitter"));
    } else if (splitter.kind == BeamSplitter::Kind::cube) {
        const SpectralIndex glass = spectral_index(splitter.glass, spectrum);
        splitting.surface.index_before = splitting.surface.index_after = glass.centre;
        splitting.surface.dispersion_before = splitting.surface.dispersion_after = glass.dispersion;
        elements.push_back(make_element(Element::Kind::surface, splitter_imaging.front(), "beam splitter"));
        elements.push_back(make_element(Element::Kind::splitter, splitting, "beam splitter"));
        elements.push_back(make_element(Element::Kind::surface, splitter_imaging.back(), "beam splitter"));
    } else {
        elements.push_back(make_element(Element::Kind::splitter, splitting, "beam splitter"));
    }
    for (const Fold* fold : folds_of(FoldMirror::Path::imaging)) {
        add_part({fold->mirror}, Element::Kind::mirror, "fold mirror");
        mirrors.emplace_back(elements.size(), fold->mirror.pose);
    }
    add_part(tube_lens, Element::Kind::surface, "tube lens");
    PlacedSurface detector = dummy_plane(air, detector_pose, "detector");
    add_part({detector}, Element::Kind::detector, "detector");
    for (auto mirror = mirrors.rbegin(); mirror != mirrors.rend(); ++mirror) { // the farthest first
        fold_back(mirror->first, elements.size(), mirror->second);
    }
    for (Element& element : elements) {
        element.pose.origin.z -= first_order.best_focus_offset;
    }
    if (!description.ring) {
        instrument.source_pose.origin.z -= first_order.best_focus_offset;
    }
}

} // namespace vkfv::optics
