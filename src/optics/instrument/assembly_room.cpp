#include "optics/instrument/assembly.hpp"

#include <iterator>
#include <utility>

namespace vkfv::optics {

namespace {

using Kind = Element::Kind;

Element make_element(Kind kind, const PlacedSurface& placed, Part part) {
    Element result;
    result.kind = (placed.surface.flags & physics::f64::SURFACE_IDEAL_LENS) != 0 ? Kind::ideal_lens
                  : kind == Kind::surface && placed.surface.index_before == placed.surface.index_after ? Kind::stop
                                                                                                       : kind;
    result.surface = placed.surface;
    result.pose = placed.pose;
    result.name = placed.name;
    result.part = part;
    return result;
}

void add_part(std::vector<Element>& elements, const PlacedSurfaces& surfaces, Part part) {
    for (const PlacedSurface& placed : surfaces) {
        elements.push_back(make_element(Kind::surface, placed, part));
    }
}

// Mirrors the elements from `first` on into the folded space: those behind the mirror in the light's direction, or
// before it in the illumination.
void fold_back(std::vector<Element>& elements, std::size_t first, const Pose& mirror) {
    for (std::size_t i = first; i < elements.size(); ++i) {
        elements[i].pose = elements[i].pose.mirrored_in(mirror);
    }
}

// The illumination from the source to the splitter, folded at its mirrors and at the splitter.
FoldedElements fold_illumination(const InstrumentDescription& description, const PlacedSplitter& splitter,
                                 const Illumination& illumination) {
    FoldedElements folded = {.elements = {}, .source_pose = illumination.source_pose};
    add_part(folded.elements, illumination.illuminator, Part::illuminator);
    // Mirrors are applied from the illuminator on, as each one folds all elements before it.
    for (const Fold& mirror : illumination.folds) {
        fold_back(folded.elements, 0, mirror.mirror.pose);
        folded.source_pose = folded.source_pose.mirrored_in(mirror.mirror.pose);
        folded.elements.push_back(make_element(Kind::mirror, mirror.mirror, Part::fold_mirror));
    }
    if (description.splitter.kind == BeamSplitter::Kind::cube) {
        PlacedSurface face = splitter.surfaces.front();
        face.pose = downward(splitter.height + splitter.half_size);
        add_part(folded.elements, {face}, Part::beam_splitter);
    }
    fold_back(folded.elements, 0, splitter.pose);
    folded.source_pose = folded.source_pose.mirrored_in(splitter.pose);
    return folded;
}

std::vector<Element> splitter_elements(const InstrumentDescription& description, const AxialLayout& layout,
                                       const PlacedSplitter& placed) {
    const BeamSplitter& splitter = description.splitter;
    PlacedSurface coating = mirror_plane(layout.air, placed.pose, splitter.semi_diameter, "beam splitter's coating");
    if (splitter.kind == BeamSplitter::Kind::plate) {
        coating = placed.surfaces.front();
    } else if (splitter.kind == BeamSplitter::Kind::cube) {
        const SpectralIndex glass = spectral_index(splitter.glass, description.spectrum);
        coating.surface.index_before = coating.surface.index_after = glass.centre;
        coating.surface.dispersion_before = coating.surface.dispersion_after = glass.dispersion;
    }
    coating.surface.reflectance = splitter.reflectance;
    std::vector<Element> elements = {make_element(Kind::splitter, coating, Part::beam_splitter)};
    if (splitter.kind == BeamSplitter::Kind::cube) {
        elements.insert(elements.begin(), make_element(Kind::surface, placed.surfaces.front(), Part::beam_splitter));
    }
    if (splitter.kind != BeamSplitter::Kind::ideal) {
        elements.push_back(make_element(Kind::surface, placed.surfaces.back(), Part::beam_splitter));
    }
    return elements;
}

} // namespace

FoldedElements fold(const InstrumentDescription& description, const AxialLayout& layout, const ImagingTrain& imaging,
                    const MeasuredImaging& measured, const Illumination& illumination) {
    FoldedElements folded = {.elements = {}, .source_pose = illumination.source_pose};
    if (!description.source.ring) {
        folded = fold_illumination(description, imaging.splitter, illumination);
        folded.source_pose.origin.z -= measured.best_focus_offset;
    }
    std::vector<Element>& elements = folded.elements;
    add_part(elements, layout.cover, Part::cover_glass);
    add_part(elements, imaging.objective, Part::objective);
    std::ranges::move(splitter_elements(description, layout, imaging.splitter), std::back_inserter(elements));
    std::vector<std::pair<std::size_t, Pose>> mirrors; // index of the first element behind, unfolded mirror plane
    for (const Fold& mirror : imaging.folds) {
        elements.push_back(make_element(Kind::mirror, mirror.mirror, Part::fold_mirror));
        mirrors.emplace_back(elements.size(), mirror.mirror.pose);
    }
    add_part(elements, imaging.tube_lens, Part::tube_lens);
    const PlacedSurface detector = dummy_plane(layout.air, imaging.detector_pose, name_of(Part::detector));
    elements.push_back(make_element(Kind::detector, detector, Part::detector));
    for (auto mirror = mirrors.rbegin(); mirror != mirrors.rend(); ++mirror) { // the farthest first
        fold_back(elements, mirror->first, mirror->second);
    }
    for (Element& element : elements) {
        element.pose.origin.z -= measured.best_focus_offset;
    }
    return folded;
}

std::vector<PlacedMesh> place_meshes(const InstrumentDescription& description, const MeasuredImaging& measured) {
    std::vector<PlacedMesh> meshes;
    for (const MeshElement& element : description.meshes) {
        PlacedMesh mesh{.kind = element.kind, .name = element.name, .facets = element.facets};
        mesh.closed = openness_of(mesh.facets).closed();
        if (mesh.closed) {
            mesh.facets = turned_outward(std::move(mesh.facets));
        }
        for (glm::dvec3& vertex : mesh.facets.vertices) {
            vertex = element.pose.point(vertex);
            vertex.z -= measured.best_focus_offset;
        }
        // A mesh has interfaces like those of the lenses, with the same coating.
        mesh.surface = plate(description, Pose{}, 0, element.glass, element.surrounding, std::nullopt, element.name)
                           .front()
                           .surface;
        mesh.surface.reflectance = element.reflectance;
        meshes.push_back(std::move(mesh));
    }
    return meshes;
}

} // namespace vkfv::optics
