// The table [reference_arm]: its keys and its reader.
#include "configuration/optical_parts.hpp"
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace vkfv {

namespace {

using ArmKind = fields::ReferenceArm::Kind;

const ChoiceKey<ArmKind> arm_kind("kind",
                                  {{ArmKind::linnik, "linnik", "an objective of its own, alike"},
                                   {ArmKind::michelson, "michelson", "a splitter below the objective"},
                                   {ArmKind::mirau, "mirau", "the mirror in the middle of the objective's front lens"}},
                                  ArmKind::michelson, "Where the reference mirror stands.");
const NumberKey mirror_share("reflectance", share_range, 1.0,
                             "Of the reference mirror; fringes have the highest contrast if it is the specimen's.");
const NumberKey mirror_tilt_x("tilt_x_deg", NumberRange::within(-1, 1), 0.0,
                              "Tilt of the mirror about the x axis, by which its image in the object rises along y.");
const NumberKey mirror_tilt_y("tilt_y_deg", NumberRange::within(-1, 1), 0.0,
                              "Tilt of the mirror about the y axis, by which its image in the object falls along x.");
const NumberKey mirror_defocus =
    of_kinds({"linnik", "michelson"}, NumberKey("defocus_um", NumberRange::within(-100, 100), 0.0,
                                                "Distance of the mirror from the focus of its objective."));
const NumberKey obscuration =
    of_kinds({"mirau"}, NumberKey("obscuration", {.minimum = 0, .maximum = 0.9}, 0.0,
                                  "Radius of the pupil's part that the mirror hides, over the pupil's radius."));
const NumberKey
    arm_glass_thickness("glass_thickness_um", NumberRange::finite(), 0.0,
                        "Glass that the reference arm has more than the object's arm; the mirror balances its "
                        "delay at the mean wavelength.");
const TextKey arm_glass("glass", Default::of(std::string("N-BK7")), "That glass.");

// Keys and tables that say nothing about an interferometer's images, or whose effect these do not have yet.
struct Meaningless {
    const char* table; // dotted
    const char* key;   // empty: the whole table
    const char* why;
};
constexpr std::array meaningless{
    Meaningless{"diffraction", "", "fields are waves already"},
    Meaningless{"cover_glass", "", "the fields have no cover glass"},
    Meaningless{"fold_mirror", "", "the fields have no fold mirrors"},
    Meaningless{"mesh_element", "", "the fields have no mesh elements"},
    Meaningless{"illumination.field", "", "the fields' illumination is uniform"},
    Meaningless{"specimen.reflectance", "", "the fields' specimen has one reflectance"},
    Meaningless{"detector", "distortion", "the fields' image is not distorted"},
    Meaningless{"detector", "shear_deg", "the fields' image is not sheared"},
    Meaningless{"objective", "magnification_per_um", "the fields' magnification is constant"},
    Meaningless{"trace", "rays", "the fields have no rays"},
    Meaningless{"trace", "max_bounces", "the fields are scattered once"},
    Meaningless{"trace", "mode", "the fields have no rays"},
    Meaningless{"trace", "estimator", "the fields have no rays"},
    Meaningless{"trace", "emission", "the fields have no rays"},
    Meaningless{"trace", "scattering", "the fields have no rays"},
    Meaningless{"trace", "traversal", "the fields have no rays"},
    Meaningless{"trace", "batch", "the fields have no rays"},
    Meaningless{"stage", "lateral_drift_um_per_s", "the fields' specimen stands still sideways"},
    Meaningless{"stage", "tilt_deg", "the fields' specimen stands still sideways"},
    Meaningless{"topography", "focus_measure", "fringes have no focus measure"},
    Meaningless{"topography", "window_px", "each pixel has fringes of its own"},
    Meaningless{"topography", "window_shape", "each pixel has fringes of its own"},
    Meaningless{"topography", "smoothing_steps", "fringes are not averaged"},
    Meaningless{"topography", "peak", "fringes have their own peak"},
    Meaningless{"topography", "peak_range_steps", "fringes have their own peak"},
    Meaningless{"topography", "most_rival", "fringes have no focus curve"},
    Meaningless{"topography", "most_fit_residual", "fringes have no focus curve"},
    Meaningless{"topography", "most_peaks", "fringes have no focus curve"},
    Meaningless{"topography", "false_peak_rate", "fringes have no focus curve"},
    Meaningless{"topography", "place_by_texture", "each pixel has fringes of its own"},
};

void refuse_meaningless(const TomlTable& root) {
    for (const auto& [path, key, why] : meaningless) {
        TomlTable table = root;
        std::string rest = path;
        bool there = true;
        std::string last;
        for (std::size_t dot = 0; there && !rest.empty();) {
            dot = rest.find('.');
            last = rest.substr(0, dot);
            rest = dot == std::string::npos ? std::string() : rest.substr(dot + 1);
            there = table.has(last);
            if (there && (!rest.empty() || *key != '\0')) {
                table = table.table(last);
            }
        }
        if (!there || (*key != '\0' && !table.has(key))) {
            continue;
        }
        table.note(*key != '\0' ? key : last.c_str(), fmt::format("nothing beside [reference_arm]: {}", why),
                   "Remove it, or remove [reference_arm].");
    }
}

} // namespace

const KeyTable& reference_arm_keys() {
    static const KeyTable table{
        .path = "reference_arm",
        .presence = KeyTable::Presence::optional,
        .meaning = "The reference mirror that makes the instrument an interferometer: images are of coherent fields.",
        .subject = "a reference arm",
        .kind = "kind",
        .keys = {&arm_kind, &mirror_share, &mirror_tilt_x, &mirror_tilt_y, &mirror_defocus, &obscuration,
                 &arm_glass_thickness, &arm_glass}};
    return table;
}

void read_reference_arm(const TomlTable& root, Configuration& configuration) {
    const auto table = root.optional_table("reference_arm");
    if (!table) {
        return;
    }
    const Section section(*table, reference_arm_keys(), configuration);
    fields::ReferenceArm& arm = configuration.reference_arm.emplace();
    arm.kind = section.kind(arm_kind);
    arm.reflectance = section.number(mirror_share);
    arm.tilt = {-std::tan(section.number(mirror_tilt_y) * radians_per_degree),
                std::tan(section.number(mirror_tilt_x) * radians_per_degree)};
    if (arm.kind == ArmKind::mirau) {
        arm.obscuration = section.number(obscuration);
    } else {
        arm.defocus = from_um(section.number(mirror_defocus));
    }
    arm.glass_thickness = from_um(section.number(arm_glass_thickness));
    arm.glass = read_glass(section, arm_glass, configuration);
    refuse_meaningless(root);
    // These keys have defaults, which a configuration that was written in full states.
    if (configuration.instrument.interfaces.model != optics::Interfaces::Model::ideal) {
        root.table("interfaces")
            .note("model", "\"ideal\" beside [reference_arm]: the fields have no reflection losses",
                  "Set it so, or remove [reference_arm].");
    }
    if (configuration.instrument.fill_factor != 1) {
        root.table("detector")
            .note("fill_factor", "1 beside [reference_arm]: the fields' pixels are sensitive all over",
                  "Set it so, or remove [reference_arm].");
    }
    if (configuration.stage && configuration.stage->runout != 0) {
        root.table("stage").note("runout_um", "0 beside [reference_arm]: the fields' specimen stands still sideways",
                                 "Set it so, or remove [reference_arm].");
    }
    if (configuration.scan) {
        const double step = configuration.scan->z_step;
        const double most = from_um(configuration.instrument.spectrum.shortest_um) / 4;
        if (root.sound("scan") && root.sound("source") && !(step < most)) {
            root.table("scan").note("z_step_um",
                                    fmt::format("a number below {:.4g}, a quarter of the shortest wavelength, so that "
                                                "each fringe has more than two images",
                                                most * um_per_mm),
                                    "Choose an eighth of the mean wavelength.");
        }
    }
}

} // namespace vkfv
