// From the images of a stack to topography and deviation from truth.
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

// A flat that the same instrument measured (topography/flatness.hpp).
struct Flat {
    std::filesystem::path file;
    surface::HeightMap heights;
    double deviation = 0; // mm, its z_FLT
    double s_filter = 0;  // mm, nesting index of the S-filter before it
};

// The flat that the configuration names, for stacks of this grid (pitch in mm); none if it names none. Throws
// InputError where its grid is another, since it must have been measured by the same instrument, or where too little of
// it was measured. The S-filter is that of topography.s_filter_um; where that is none, as long as the focus window is
// wide, since shorter waves of heights are no instrument's form.
std::optional<Flat> read_flat(const Configuration& configuration, ImageSize pixels, double pitch);

// Errors of the instrument's heights that are known before any image is evaluated.
struct KnownErrors {
    // How its field is curved: a flat takes it off; what the design tells counts as uncertainty where there is no flat
    // (topography/flatness.hpp). Neither: nothing is known.
    std::optional<Flat> flat;
    std::optional<optics::FieldCurvature> design;
    // Standard uncertainty of every height beside what the images tell, mm: PhaseLimits::height_uncertainty().
    // Dimensions then have no standard error, as the scatter of the heights tells nothing of it.
    double hidden_uncertainty = 0;
};

// What a flatness correction found and removed.
struct Flatness {
    std::filesystem::path file;
    double deviation = 0;                 // mm, z_FLT of the flat
    double s_filter = 0;                  // mm, nesting index of its S-filter
    double polynomial_peak_to_valley = 0; // mm, of what was removed
};

// Of an expanded uncertainty: a normal error is beyond it in 3 points of 1000 (JCGM 100:2008, 6.3).
inline constexpr double coverage_factor = 3;

// As the comparison treats them, levelled but not filtered.
struct LevelledMaps {
    topography::LevelledPair pair;           // without a truth, that of the pair is empty
    std::optional<surface::HeightMap> truth; // also where nothing was measured
    std::optional<surface::HeightMap> deviation;
};

struct Evaluation {
    topography::TopographyOptions options; // that the heights were found by
    topography::Topography topography;
    double height_noise = 0;                 // mm, median of the measured points'; NaN without any
    double height_uncertainty = 0;           // likewise
    std::optional<Flatness> flatness;        // of `diffracted` too, by the same flat; none: no correction
    std::optional<double> field_curvature;   // mm peak-to-valley over the measured points, by design, not corrected
    std::optional<surface::HeightMap> truth; // none of a stack that another instrument took; nor deviations
    std::optional<optics::MappingDeviation> mapping; // with a truth, which it belongs to
    LevelledMaps levelled;
    std::optional<topography::Deviation> deviation; // levelled
    std::optional<double> beyond_uncertainty;       // share of the points levelled beyond coverage_factor times theirs
    std::optional<topography::ComparedPair> filtered; // levelled and filtered; none if the band has no limit
    topography::Band band;                            // its form holds for the levelled one too
    std::vector<StandardDimension> dimensions;        // of a standard; none of other specimens
    report::Frames frames;                            // the images, made small; not of `diffracted`
    double seconds = 0;                               // wall clock
    std::shared_ptr<Evaluation> diffracted; // the same of the images after diffraction; none without [diffraction]
};

// Where a stack is evaluated by this choice of [topography] evaluate_on: "auto" means the device that traces it (none:
// the host) if it has cores of its own; on the host's own cores the host's code takes a third of lavapipe's time at
// 1000 x 1000 pixels. Throws DeviceError.
topography::FocusPlanesMaker focus_planes_for(EvaluateOn evaluate_on, std::shared_ptr<const vulkan::Device> traces);
// Of so many images that are in files. selector: of the device that would trace, or "host". "auto" means that device if
// it is here, has cores of its own and the stack is worth opening it; else the host.
topography::FocusPlanesMaker focus_planes_for_files(EvaluateOn evaluate_on, const std::string& device_selector,
                                                    std::size_t images);

// Takes a stack's images in their order, as they come, and keeps the time that this takes.
class StackEvaluation {
  public:
    // make_planes: where the work is done. With diffraction the images are evaluated twice, without and with it; they
    // have its size and one channel then. images: how many will come, of which the report's frames and focus curves are
    // kept; 0: none are.
    StackEvaluation(const topography::TopographyOptions& options, topography::FocusPlanesMaker make_planes,
                    std::optional<optics::Diffraction> diffraction, int images);

    // As StackEvaluator::add().
    void add(topography::Channels image, double z, std::optional<double> reading = {});
    // On the truth's grid, with the deviation from it. Feature: what is measured on the specimen.
    Evaluation finish(KnownTruth known, const topography::Band& band, const KnownErrors& errors = {},
                      const std::optional<dimensions::Feature>& feature = {});
    // Without a truth; the grid's middle is the origin, pitch in mm.
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

// The sentences of the summary that judge: the share measured, why the rest was not, and how uncertain it is. All
// counts as measured from nine tenths of the points on.
Verdict verdict_of(const Evaluation& evaluation);

// The figures as a text of a few lines.
std::string summary(const Evaluation& evaluation);

} // namespace vkfv::measurement
