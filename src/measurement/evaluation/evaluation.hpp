// The evaluation of a stack's images: topography and its deviation from truth.
#pragma once

#include "configuration/configuration.hpp"
#include "measurement/scene/known_truth.hpp"
#include "measurement/scene/verdict.hpp"
#include "measurement/surface/standard.hpp"
#include "optics/instrument/field_curvature.hpp"
#include "optics/waves/diffraction.hpp"
#include "report/frames.hpp"
#include "topography/compare.hpp"
#include "topography/topography.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace vkfv::vulkan {
class Device;
}

namespace vkfv::measurement {

// A surface known to be flat, as the same instrument measured it (topography/flatness.hpp).
struct Flat {
    std::filesystem::path file;
    surface::HeightMap heights;
    double deviation = 0; // mm, its z_FLT
    double s_filter = 0;  // mm, nesting index of the S-filter before it
};

// The flat that the configuration names, for stacks of this grid (pitch in mm); there is none if it names none. Throws
// InputError where the flat has another grid, since it must have been measured by the same instrument, or where too
// little of it was measured. The S-filter is topography.s_filter_um; without one its nesting index is the width of the
// focus window, since shorter waves of heights are no instrument's form.
std::optional<Flat> read_flat(const Configuration& configuration, ImageSize pixels, double pitch);

// Errors of the instrument's heights that are known before any image is evaluated.
struct KnownErrors {
    // The curvature of the field: a flat corrects it; without a flat, the curvature of the optical design counts as
    // uncertainty (topography/flatness.hpp). With neither, the curvature is unknown.
    std::optional<Flat> flat;
    std::optional<optics::FieldCurvature> design;
    // Standard uncertainty (mm) of every height beside what the images tell: PhaseLimits::height_uncertainty().
    // Dimensions then have no standard error, since the scatter of the heights does not show this uncertainty.
    double hidden_uncertainty = 0;
};

// The deviation that a flatness correction found and removed.
struct Flatness {
    std::filesystem::path file;
    double deviation = 0;                 // mm, z_FLT of the flat
    double s_filter = 0;                  // mm, nesting index of its S-filter
    double polynomial_peak_to_valley = 0; // mm, of the polynomial that was removed
};

// The factor of an expanded uncertainty: a normal error exceeds it in 3 points of 1000 (JCGM 100:2008, 6.3).
inline constexpr double coverage_factor = 3;

// The surfaces of the comparison with the truth, levelled but not filtered.
struct LevelledMaps {
    topography::LevelledPair pair;           // the true part is empty without a truth
    std::optional<surface::HeightMap> truth; // has heights also where nothing was measured
    std::optional<surface::HeightMap> deviation;
};

struct Evaluation {
    topography::TopographyOptions options; // settled options that the heights were found by
    topography::Topography topography;
    double height_noise = 0;                 // mm, median of the measured points'; NaN without any
    double height_uncertainty = 0;           // mm, median of the measured points'; NaN without any
    std::optional<Flatness> flatness;        // also corrects `diffracted`; none: no correction
    std::optional<double> field_curvature;   // mm peak-to-valley over the measured points, by design, not corrected
    std::optional<surface::HeightMap> truth; // none, and no deviations, for another instrument's stack
    std::optional<optics::MappingDeviation> mapping; // of the pixels that the truth belongs to
    LevelledMaps levelled;
    std::optional<topography::Deviation> deviation; // of the levelled surfaces
    std::optional<double> beyond_uncertainty;       // share of the levelled points beyond coverage_factor times their u
    std::optional<topography::ComparedPair> filtered; // levelled and filtered; none if the band has no limit
    topography::Band band;                            // its form also holds for the levelled surfaces
    std::vector<StandardDimension> dimensions;        // none if the specimen is no standard
    report::Frames frames;                            // small pictures of the images; not of `diffracted`
    double seconds = 0;                               // wall clock
    std::shared_ptr<Evaluation> diffracted;           // the evaluation after diffraction; none without [diffraction]
};

// Chooses where a stack is evaluated while it is traced. EvaluateOn::automatic means the tracing device if it has cores
// of its own, otherwise the host: on the host's own cores the host's code takes a third of lavapipe's time at 1000 x
// 1000 pixels. `traces` is null if the host traces. Throws DeviceError.
topography::FocusPlanesMaker focus_planes_for(EvaluateOn evaluate_on, std::shared_ptr<const vulkan::Device> traces);
// Chooses where a stack of this many image files is evaluated. selector: the device that would trace, or "host".
// EvaluateOn::automatic means that device if it is here, has cores of its own and the stack is worth opening it,
// otherwise the host.
topography::FocusPlanesMaker focus_planes_for_files(EvaluateOn evaluate_on, const std::string& device_selector,
                                                    std::size_t images);

// Takes a stack's images in their order as they come, and measures the time that this takes.
class StackEvaluation {
  public:
    // make_planes: chooses where the work is done. With diffraction the images are evaluated twice, without and with
    // it; they must then have its size and one channel. images: the number of images that will come, from which the
    // report's frames and focus curves are kept; 0 keeps none.
    StackEvaluation(const topography::TopographyOptions& options, topography::FocusPlanesMaker make_planes,
                    std::optional<optics::Diffraction> diffraction, int images);

    // See StackEvaluator::add().
    void add(topography::Channels image, double z, std::optional<double> reading = {});
    // Heights on the truth's grid, with the deviation from the truth. feature: the dimensions to find on the specimen.
    Evaluation finish(KnownTruth known, const topography::Band& band, const KnownErrors& errors = {},
                      const std::optional<dimensions::Feature>& feature = {});
    // Heights without a truth. The middle of the grid is the origin; pitch in mm.
    Evaluation finish(double pitch, const surface::Form& form, const KnownErrors& errors = {});

  private:
    void reconstruct(double x0, double y0, double pitch, const KnownErrors& errors);

    topography::StackEvaluator evaluator_;
    std::optional<optics::Diffraction> diffraction_;
    std::unique_ptr<StackEvaluation> diffracted_;
    std::optional<report::FrameTally> frames_;
    int columns_ = 0;
    int rows_ = 0;
    Evaluation evaluation_;
};

// The sentences of the summary that judge: the share of points measured, why the others were not, and how uncertain the
// heights are. From nine tenths of the points on, the verdict is that the surface was measured.
Verdict verdict_of(const Evaluation& evaluation);

// The figures as a text of a few lines.
std::string summary(const Evaluation& evaluation);

} // namespace vkfv::measurement
