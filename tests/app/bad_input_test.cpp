// Bad input never crashes and never runs on: each case through the real program, with the exit code and what
// the message must say: the place (file:line:column, or file@offset), the key, what was expected and the
// remedy.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include <sys/wait.h>

namespace vkfv::test {
namespace {

using testing::HasSubstr;

struct Case {
    std::string name;
    // Changes to the small configuration: first by second. Empty: as it is.
    std::vector<std::pair<std::string, std::string>> changes;
    int exit_code = 2;
    std::vector<std::string> message; // all of these in standard error
    std::vector<std::string> arguments = {"--check", "c.toml"};
    std::map<std::string, std::string> files = {}; // beside the configuration
    std::map<std::string, std::string> environment = {};
};

std::ostream& operator<<(std::ostream& stream, const Case& given) {
    return stream << given.name;
}

template <class Value>
std::string bytes(Value value) {
    static_assert(std::endian::native == std::endian::little); // as STL files are
    return {reinterpret_cast<const char*>(&value), sizeof(Value)};
}

// A binary STL with `count` in its header and one triangle, whose first coordinate of the first vertex is
// given.
std::string binary_stl(std::uint32_t count, float first = 0) {
    std::string text(80, ' ');
    text += bytes(count);
    for (const float value : {0.f, 0.f, 1.f, first, 0.f, 0.f, 0.1f, 0.f, 0.f, 0.f, 0.1f, 0.f}) {
        text += bytes(value);
    }
    return text + std::string(2, '\0');
}

const std::pair<std::string, std::string> mesh_specimen = {
    "kind = \"step\"\nsize_mm = 0.2\nheight_um = 2.0\n[specimen.material]\ng = 0.8\n[specimen.roughness]\n"
    "noise_um = 0.1\nkernel_um = 1.0\npitch_um = 1.0\nseed = 7\n",
    "kind = \"stl\"\nfile = \"part.stl\"\n"};

std::pair<std::string, std::string> file_specimen(const std::string& lines) {
    return {mesh_specimen.first, lines};
}

std::string repeated(const std::string& piece, int times) {
    std::string text;
    for (int i = 0; i < times; ++i) {
        text += piece;
    }
    return text;
}

// A plate, with one more line in its first surface.
std::string zemax_lens(const std::string& line) {
    return "MODE SEQ\nUNIT MM\nWAVL 0.5875618\nSURF 0\n  CURV 0\n  DISZ INFINITY\nSURF 1\n  " + line +
           "\n  CURV 0\n  DISZ 1\nSURF 2\n  CURV 0\n  DISZ 1\nSURF 3\n  CURV 0\n  DISZ 0\n";
}

// A fault of the glass catalogue g.agf, which the configuration names in its first line.
Case catalogue_fault(const std::string& name, const std::string& catalogue, std::vector<std::string> message) {
    return {name,
            {{"# a small step", "glass_catalogs = [\"g.agf\"]"}},
            2,
            std::move(message),
            {"--check", "c.toml"},
            {{"g.agf", catalogue}}};
}

// A fault of the objective's glass "glass".
Case glass_fault(const std::string& name, const std::string& medium, std::vector<std::string> message) {
    return {name,
            {{"\"10x_0.28\"", "\"mine.toml\""}},
            2,
            std::move(message),
            {"--check", "c.toml"},
            {{"mine.toml", "source = \"s\"\nlicence = \"l\"\n[[surface]]\nmedium = \"glass\"\nthickness_mm = 1\n"
                           "[[surface]]\nradius_mm = -10\nrole = \"aperture stop\"\nsemi_diameter_mm = 2\n" +
                               medium}}};
}

// A fault of the instrument: one piece of the small configuration by another.
Case instrument_fault(const std::string& name, const std::string& from, const std::string& to,
                      std::vector<std::string> message) {
    return {name, {{from, to}}, 2, std::move(message)};
}

// A ring light of these keys, in place of the disc and its illuminator.
Case ring_fault(const std::string& name, const std::string& keys, std::vector<std::string> message,
                const std::string& illumination = "") {
    return {name,
            {{"radius_mm = 0.96\n", "kind = \"ring\"\n" + keys},
             {"[illumination]\nprescription = \"koehler\"\nfield_stop_radius_mm = 0.2\n", illumination}},
            2,
            std::move(message)};
}

// A map of the specimen's reflectance of these keys, from line 31 on.
Case map_fault(const std::string& name, const std::string& keys, std::vector<std::string> message,
               std::map<std::string, std::string> files = {}) {
    return {name,
            {{"g = 0.8\n", "g = 0.8\n[specimen.reflectance]\n" + keys}},
            2,
            std::move(message),
            {"--check", "c.toml"},
            std::move(files)};
}

std::vector<Case> cases() {
    const std::vector<std::string> stack = {"--stack", "c.toml"};
    const std::vector<std::string> import = {"--import", "lens.zmx"};
    const std::vector<std::string> rays = {"--trace-rays", "c.toml", "rays.csv"};
    const std::string rays_header = "x_mm,y_mm,z_mm,l,m,n\n";
    return {
        // The text of the configuration.
        {"MissingFile", {}, 2, {"absent.toml", "no such file", "Check the path"}, {"--check", "absent.toml"}},
        {"FolderForFile", {}, 2, {"a directory", "expected a readable TOML file"}, {"--check", "."}},
        {"NotToml", {{"pixels = 8", "pixels = = 8"}}, 2, {"c.toml:22:10", "valid TOML"}},
        {"KeyTwice", {{"pixels = 8", "pixels = 8\npixels = 9"}}, 2, {"c.toml:23:", "valid TOML"}},
        {"BinaryForToml", {{"# a small step", std::string("\xff\xfe\0\1", 4)}}, 2, {"c.toml:1:", "valid TOML"}},
        {"NameOfTooManyParts",
         {{"# a small step", "[" + repeated("a.", 50'000) + "a]"}},
         2,
         {"c.toml:1:129: ", "nested at most 64 deep", "Shorten the dotted name"}},
        {"KeyOfTooManyParts",
         {{"pixels = 8", repeated("a.", 50'000) + "a = 8"}},
         2,
         {"c.toml:22:126: ", "nested at most 64 deep"}},
        {"TooManyBrackets",
         {{"pixels = 8", "pixels = " + repeated("[", 50'000)}},
         2,
         {"c.toml:22:72: ", "nested at most 64 deep", "take brackets out"}},
        {"SettingOfTooManyParts",
         {},
         2,
         {"--set: ", "nested at most 64 deep"},
         {"--check", "c.toml", "--set", repeated("a.", 50'000) + "a=1"}},
        // Several problems, each told once.
        {"MisspeltTable",
         {{"[tube_lens]", "[tubelens]"}},
         2,
         {"c.toml:17:", "tubelens", "expected tube_lens as a table", "Did you mean \"tube_lens\"? Rename it."}},
        {"KeyInAnotherUnit",
         {{"z_step_um = 1.0", "z_step_nm = 1000"}},
         2,
         {"c.toml:39:1: scan.z_step_nm = 1000", "expected scan.z_step_um as a finite number > 0",
          "Did you mean \"z_step_um\"? Rename it, and give its value in um."},
         stack},
        {"SeveralProblems",
         {{"radius_mm = 0.96", "radius_mm = -1"},
          {"\"10x_0.28\"", "\"11x_0.28\""},
          {"[tube_lens]", "[tubelens]"},
          {"pixels = 8", "pixels = 0\npixle = 3"},
          {"\"step\"", "\"stp\""},
          {"window_px = 3", "window_px = 4"}},
         2,
         {"vkfv: c.toml:3:13: source.radius_mm = -1: expected a finite number > 0. Correct source.radius_mm.\n"
          "c.toml:15:16: objective.prescription = '11x_0.28': ",
          "Did you mean \"10x_0.28\"?",
          "\nc.toml:17:2: tubelens = ", "\nc.toml:22:10: detector.pixels = 0: ", "\nc.toml:23:1: detector.pixle = 3: ",
          "\nc.toml:26:8: specimen.kind = 'stp': ", "\nc.toml:47:13: topography.window_px = 4: "}},
        {"WavelengthInNanometres",
         {{"wavelength_um = 0.5876", "wavelength_um = 587.562"}},
         2,
         {"c.toml:5:17: source.wavelength_um = 587.562", "587.562 looks like nanometres: write 0.587562."}},
        {"LinesInNanometres",
         {{"wavelength_um = 0.5876",
           "[source.spectrum]\nkind = \"lines\"\nwavelengths_um = [486.1, 656.3]\nweights = [1, 1]"}},
         2,
         {"source.spectrum.wavelengths_um[0] = 486.1", "486.1 looks like nanometres: write 0.4861."}},
        {"LedInNanometres",
         {{"wavelength_um = 0.5876", "[source.spectrum]\nkind = \"gaussian\"\ncentre_um = 550\nfull_width_um = 20"}},
         2,
         {"source.spectrum.centre_um = 550", "550 looks like nanometres: write 0.55."}},
        {"WidthInNanometres",
         {{"wavelength_um = 0.5876", "[source.spectrum]\nkind = \"gaussian\"\ncentre_um = 0.55\nfull_width_um = 20"}},
         2,
         {"source.spectrum.full_width_um = 20", "20 looks like nanometres: write 0.02."}},
        {"LayerInNanometres",
         {{"[objective]", "[interfaces]\nmodel = \"quarter-wave\"\ndesign_wavelength_um = 550\n[objective]"}},
         2,
         {"interfaces.design_wavelength_um = 550", "550 looks like nanometres: write 0.55."}},
        {"SpectrumFileInNanometres",
         {{"wavelength_um = 0.5876", "[source.spectrum]\nkind = \"table\"\nfile = \"led.csv\""}},
         2,
         {"led.csv:2:1: wavelength_um = 500", "500 looks like nanometres: write 0.5."},
         {"--check", "c.toml"},
         {{"led.csv", "wavelength_um,density\n500,1\n600,1\n"}}},
        glass_fault("GlassInNanometres",
                    "[media.glass]\nwavelengths_um = [486.1, 587.6, 656.3]\nindices = [1.52, 1.51, 1.5]\n",
                    {"index of glass", "look like nanometres: divide them by 1000"}),
        // Keys.
        {"UnknownKey",
         {{"pixels = 8", "pixles = 8\npixels = 8"}},
         2,
         {"c.toml:22:1", "detector.pixles", "Did you mean \"pixels\"?"}},
        {"UnknownTable",
         {{"[detector]", "[detecter]\nx = 1\n[detector]"}},
         2,
         {"c.toml:20:", "detecter", "Did you mean \"detector\"?"}},
        {"MissingKey", {{"pixels = 8\n", ""}}, 2, {"c.toml:20:1", "detector.pixels", "Add pixels to [detector]"}},
        {"MissingTable", {{"[detector]\nsize_mm = 0.16\npixels = 8\n", ""}}, 2, {"detector", "Add [detector]"}},
        {"KeyOfAnotherKind",
         {{"height_um = 2.0", "height_um = 2.0\nradius_um = 5"}},
         2,
         {"c.toml:28:13", "specimen.radius_um", "kind \"step\"", "sphere"}},
        {"RoughnessOfTwoHeights",
         {{"noise_um = 0.1", "noise_um = 0.1\nsq_um = 0.1"}},
         2,
         {"specimen.roughness.sq_um", "one of noise_um, sq_um and ra_um"}},
        {"RoughnessOfNoHeight",
         {{"noise_um = 0.1\n", ""}},
         2,
         {"specimen.roughness.noise_um", "Add noise_um to [specimen.roughness]"}},
        {"RoughnessOfAMesh",
         {{"kind = \"step\"\nsize_mm = 0.2\nheight_um = 2.0", "kind = \"stl\"\nfile = \"part.stl\""}},
         2,
         {"specimen.roughness", "kind \"stl\"", "Remove [specimen.roughness]"}},
        // The instrument.
        instrument_fault("UnknownSource", "radius_mm = 0.96", "kind = \"disk\"\nradius_mm = 0.96",
                         {"c.toml:3:8", "source.kind", "\"disc\" or \"ring\"", "Did you mean \"disc\"?"}),
        instrument_fault("RingKeyOfADisc", "radius_mm = 0.96", "radius_mm = 0.96\nsegments = 8",
                         {"c.toml:4:12", "source.segments", "kind \"disc\"", "belongs to kind \"ring\""}),
        ring_fault("DiscKeyOfARing", "radius_mm = 1\n", {"c.toml:4:13", "source.radius_mm", "kind \"ring\""}),
        ring_fault("RingWithoutDistance", "elevation_deg = 45\nwidth_mm = 1\n",
                   {"c.toml:2:1", "source.distance_mm", "Add distance_mm to [source]"}),
        ring_fault("RingInTheZenith", "distance_mm = 10\nelevation_deg = 90\nwidth_mm = 1\n",
                   {"c.toml:5:17", "source.elevation_deg", "in (0, 90)"}),
        ring_fault("RingAllOff",
                   "distance_mm = 10\nelevation_deg = 45\nwidth_mm = 1\nsegments = 2\non = [false, false]\n",
                   {"c.toml:8:6", "source.on", "at least one true"}),
        ring_fault("RingOfOtherSegments",
                   "distance_mm = 10\nelevation_deg = 45\nwidth_mm = 1\nsegments = 3\non = [true, false]\n",
                   {"c.toml:8:6", "source.on", "3 of true and false"}),
        ring_fault("RingOfNumbers", "distance_mm = 10\nelevation_deg = 45\nwidth_mm = 1\non = [1]\n",
                   {"c.toml:7:6", "source.on", "an array of true and false"}),
        ring_fault("RingOfTooManySegments", "distance_mm = 10\nelevation_deg = 45\nwidth_mm = 1\nsegments = 33\n",
                   {"c.toml:7:12", "source.segments", "in [1, 32]"}),
        ring_fault("RingOverTheAxis", "distance_mm = 10\nelevation_deg = 80\nwidth_mm = 9\n",
                   {"c.toml:6:12", "source.width_mm", "a band that does not reach the axis"}),
        ring_fault("RingWithIllumination", "distance_mm = 10\nelevation_deg = 45\nwidth_mm = 1\n",
                   {"c.toml:10:1", "illumination", "no [illumination]", "Remove it"},
                   "[illumination]\nprescription = \"koehler\"\n"),
        ring_fault("RingWithAFoldedIlluminator", "distance_mm = 10\nelevation_deg = 45\nwidth_mm = 1\n",
                   {"c.toml:11:8", "fold_mirror[0].path", "no illumination path"},
                   "[[fold_mirror]]\npath = \"illumination\"\n"),
        instrument_fault("TwoSpectra", "wavelength_um = 0.5876",
                         "wavelength_um = 0.5876\n[source.spectrum]\nkind = \"monochromatic\"\nwavelength_um = 0.5",
                         {"c.toml:5:17", "source.wavelength_um", "not both"}),
        instrument_fault(
            "SpectrumKeyOfAnotherKind", "wavelength_um = 0.5876",
            "[source.spectrum]\nkind = \"gaussian\"\ncentre_um = 0.55\nfull_width_um = 0.02\nweights = [1]",
            {"c.toml:9:11", "source.spectrum.weights", "belongs to kind \"lines\""}),
        instrument_fault("LinesWithoutWeights", "wavelength_um = 0.5876",
                         "[source.spectrum]\nkind = \"lines\"\nwavelengths_um = [0.5, 0.6]\nweights = [1]",
                         {"c.toml:5:1", "source.spectrum", "as many values as wavelengths"}),
        instrument_fault("LinesDescending", "wavelength_um = 0.5876",
                         "[source.spectrum]\nkind = \"lines\"\nwavelengths_um = [0.6, 0.5]\nweights = [1, 1]",
                         {"c.toml:5:1", "source.spectrum", "ascending"}),
        instrument_fault("DarkSpectrum", "wavelength_um = 0.5876",
                         "[source.spectrum]\nkind = \"lines\"\nwavelengths_um = [0.5]\nweights = [0]",
                         {"c.toml:5:1", "source.spectrum", "some flux"}),
        instrument_fault("GaussianTooWide", "wavelength_um = 0.5876",
                         "[source.spectrum]\nkind = \"gaussian\"\ncentre_um = 0.55\nfull_width_um = 0.5",
                         {"c.toml:5:1", "source.spectrum", "a full width > 0 and below"}),
        instrument_fault("SpectrumFileMissing", "wavelength_um = 0.5876",
                         "[source.spectrum]\nkind = \"table\"\nfile = \"led.csv\"",
                         {"bad_input_SpectrumFileMissing/led.csv", "source.spectrum.file", "wavelength_um,density",
                          "Check the path", "It is named at c.toml:7:8"}),
        {"SpectrumFileWrong",
         {{"wavelength_um = 0.5876", "[source.spectrum]\nkind = \"table\"\nfile = \"led.csv\""}},
         2,
         {"led.csv:3:5", "density", "a finite number"},
         {"--check", "c.toml"},
         {{"led.csv", "wavelength_um,density\n0.5,1\n0.6,x\n"}}},
        {"SpectrumTwice",
         {{"wavelength_um = 0.5876", "[source.spectrum]\nkind = \"table\"\nfile = \"led.csv\"\ndensities = [1, 1]"}},
         2,
         {"c.toml:8:13", "source.spectrum.densities", "not both"},
         {"--check", "c.toml"},
         {{"led.csv", "wavelength_um,density\n0.5,1\n0.6,1\n"}}},
        instrument_fault(
            "SpectrumBeyondAGlass", "wavelength_um = 0.5876",
            "[source.spectrum]\nkind = \"lines\"\nwavelengths_um = [0.5, 2.6]\nweights = [1, 1]",
            {"c.toml:5:1", "source.spectrum", "2.6 um", "expected a wavelength", "in the illumination koehler"}),
        instrument_fault("SplitterOfMoreThanAll", "reflectance = 0.5", "reflectance = 0.5\ntransmittance = 0.6",
                         {"c.toml:13:17", "beam_splitter.transmittance", "at most 1 - reflectance = 0.5"}),
        instrument_fault("SplitterKeyOfAnotherKind", "reflectance = 0.5",
                         "kind = \"cube\"\nthickness_mm = 1\nedge_mm = 20",
                         {"c.toml:13:16", "beam_splitter.thickness_mm", "kind \"cube\"", "belongs to kind \"plate\""}),
        instrument_fault("PlateWithoutThickness", "reflectance = 0.5", "kind = \"plate\"",
                         {"c.toml:11:1", "beam_splitter.thickness_mm", "Add thickness_mm"}),
        instrument_fault("UnknownGlassOfTheSplitter", "reflectance = 0.5",
                         "kind = \"cube\"\nglass = \"N-BK8\"\nedge_mm = 20",
                         {"c.toml:13:9", "beam_splitter.glass", "N-BK8", "Did you mean \"N-BK7\"?", "glass_catalogs"}),
        instrument_fault("SplitterBehindTheTubeLens", "reflectance = 0.5", "reflectance = 0.5\ndistance_mm = 120",
                         {"c.toml", "tube_lens.distance_mm", "120 mm behind the objective", "Move"}),
        instrument_fault("FoldMirrorBeforeTheSplitter", "[objective]",
                         "[[fold_mirror]]\npath = \"imaging\"\nsemi_diameter_mm = 20\ndistance_mm = 30\n[objective]",
                         {"c.toml:17:15", "fold_mirror[0].distance_mm", "behind the beam splitter", "50 mm"}),
        instrument_fault("FoldMirrorEdgeOn", "[objective]",
                         "[[fold_mirror]]\npath = \"imaging\"\nsemi_diameter_mm = 20\ndistance_mm = 80\n"
                         "incidence_deg = 90\n[objective]",
                         {"c.toml:18:17", "fold_mirror[0].incidence_deg", "in (0, 90)"}),
        instrument_fault("FoldMirrorOfNothing", "[objective]",
                         "[[fold_mirror]]\npath = \"imaging\"\nsemi_diameter_mm = 20\ndistance_mm = 80\n"
                         "reflectance = 0\n[objective]",
                         {"c.toml:18:15", "fold_mirror[0].reflectance", "in (0, 1]"}),
        instrument_fault("UnknownInterfaces", "[objective]", "[interfaces]\nmodel = \"fresnell\"\n[objective]",
                         {"c.toml:15:9", "interfaces.model", "Did you mean \"fresnel\"?"}),
        instrument_fault("LayerWithoutAModel", "[objective]", "[interfaces]\nlayer = \"MgF2\"\n[objective]",
                         {"c.toml:15:9", "interfaces.layer", "belongs to kind \"quarter-wave\""}),
        instrument_fault("UnknownLayer", "[objective]",
                         "[interfaces]\nmodel = \"quarter-wave\"\nlayer = \"MgF3\"\n[objective]",
                         {"c.toml:16:9", "interfaces.layer", "Did you mean \"MGF2\"?"}),
        instrument_fault("LayerOutOfRange", "[objective]",
                         "[interfaces]\nmodel = \"quarter-wave\"\ndesign_wavelength_um = 60\n[objective]",
                         {"c.toml:16:24", "interfaces.design_wavelength_um", "60 um", "quarter-wave layer"}),
        instrument_fault("IdealObjectiveWithAPrescription", "[objective]", "[objective]\nkind = \"ideal\"",
                         {"c.toml:16:16", "objective.prescription", "kind \"ideal\""}),
        instrument_fault("IdealObjectiveWithoutLength", "prescription = \"10x_0.28\"",
                         "kind = \"ideal\"\nnumerical_aperture = 0.3",
                         {"c.toml:14:1", "objective.focal_length_mm", "Add focal_length_mm"}),
        instrument_fault("IdealObjectiveBeyondItsMedium", "prescription = \"10x_0.28\"",
                         "kind = \"ideal\"\nfocal_length_mm = 10\nnumerical_aperture = 1.0",
                         {"c.toml:17:22", "objective.numerical_aperture", "a number below 1, the index of air"}),
        instrument_fault("IdealObjectiveBeyondWater", "prescription = \"10x_0.28\"",
                         "kind = \"ideal\"\nfocal_length_mm = 10\nnumerical_aperture = 1.4\nimmersion = \"water\"",
                         {"c.toml:17:22", "objective.numerical_aperture", "below 1.33"}),
        instrument_fault("UnknownImmersion", "prescription = \"10x_0.28\"",
                         "prescription = \"10x_0.28\"\nimmersion = \"watre\"",
                         {"c.toml:16:13", "objective.immersion", "Did you mean \"WATER\"?"}),
        instrument_fault("PlaceOfTwoNumbers", "prescription = \"10x_0.28\"",
                         "prescription = \"10x_0.28\"\nglobal_mm = [0, 0]",
                         {"c.toml:16:13", "objective.global_mm", "three numbers"}),
        instrument_fault("TiltWithoutEnd", "prescription = \"10x_0.28\"",
                         "prescription = \"10x_0.28\"\ntilt_x_deg = 361",
                         {"c.toml:16:14", "objective.tilt_x_deg", "in [-360, 360]"}),
        instrument_fault("IdealTubeLensWithAPrescription", "[tube_lens]",
                         "[tube_lens]\nkind = \"ideal\"\nfocal_length_mm = 200",
                         {"c.toml:20:16", "tube_lens.prescription", "kind \"ideal\""}),
        instrument_fault("CoverGlassTooThick", "[objective]", "[cover_glass]\nthickness_mm = 40\n[objective]",
                         {"c.toml:15:16", "cover_glass.thickness_mm", "a plate between the focus and the objective"}),
        instrument_fault("CoverGlassTooFar", "[objective]",
                         "[cover_glass]\nthickness_mm = 0.17\ndistance_mm = 20\n[objective]",
                         {"c.toml:15:16", "cover_glass.thickness_mm", "20 mm over the focus"}),
        instrument_fault("UnknownCoverGlass", "[objective]",
                         "[cover_glass]\nthickness_mm = 0.17\nglass = \"B271\"\n[objective]",
                         {"c.toml:16:9", "cover_glass.glass", "Did you mean \"B270\"?"}),
        {"IdealLensWithAShape",
         {{"\"10x_0.28\"", "\"mine.toml\""}},
         2,
         {"mine.toml:4:13", "surface[0].radius_mm", "no shape of an ideal lens"},
         {"--check", "c.toml"},
         {{"mine.toml", "source = \"s\"\nlicence = \"l\"\n[[surface]]\nradius_mm = 3\nideal_focal_length_mm = 9\n"}}},
        // Types and ranges.
        {"WrongType",
         {{"radius_mm = 0.96", "radius_mm = \"wide\""}},
         2,
         {"c.toml:3:13", "source.radius_mm", "wide", "a finite number > 0"}},
        {"NegativeRadius",
         {{"radius_mm = 0.96", "radius_mm = -0.96"}},
         2,
         {"c.toml:3:13", "source.radius_mm = -0.96", "a finite number > 0"}},
        {"NotANumber", {{"flux_W = 1.0", "flux_W = nan"}}, 2, {"c.toml:4:10", "source.flux_W = nan"}},
        {"ZeroPixels", {{"pixels = 8", "pixels = 0"}}, 2, {"c.toml:22:10", "an integer in [1, 16384]"}},
        {"HalfAPixel", {{"pixels = 8", "pixels = 8.5"}}, 2, {"c.toml:22:10", "an integer in [1, 16384]"}},
        {"HugeDetector", {{"pixels = 8", "pixels = 1e9"}}, 2, {"c.toml:22:10", "an integer in [1, 16384]"}},
        {"FullReflection", {{"reflectance = 0.5", "reflectance = 1"}}, 2, {"c.toml:12:15", "in (0, 1)"}},
        {"AsymmetryOutOfRange", {{"g = 0.8", "g = 1.2"}}, 2, {"c.toml:29:5", "specimen.material.g = 1.2", "[-0.9, 1]"}},
        {"UnknownScatter",
         {{"g = 0.8", "g = 0.8\nscatter = \"henyey\""}},
         2,
         {"c.toml:30:11", "specimen.material.scatter", "\"henyey-greenstein\""}},
        {"MisspeltParameter",
         {{"g = 0.8", "gg = 0.8"}},
         2,
         {"c.toml:29:1", "specimen.material.gg", "Did you mean \"g\"?"}},
        {"ParameterOfAnotherScatterModel",
         {{"g = 0.8", "g = 0.8\nscatter = \"lambertian\""}},
         2,
         {"c.toml:29:5", "specimen.material.g", "scatter = \"lambertian\"",
          "belongs to scatter = \"henyey-greenstein\""}},
        {"MoreThanWhite",
         {{"g = 0.8", "reflectance = 1.1"}},
         2,
         {"c.toml:29:15", "specimen.material.reflectance = 1.1", "[0, 1]"}},
        {"LobesThatAddUpToMoreThanOne",
         {{"[specimen.material]\ng = 0.8", "[[specimen.material.lobe]]\nscatter = \"mirror\"\nweight = 0.6\n"
                                           "[[specimen.material.lobe]]\nscatter = \"mirror\"\nweight = 0.5"}},
         2,
         {"c.toml:33:10", "specimen.material.lobe[1].weight = 0.5", "at most 1, not 1.1", "Choose smaller weights"}},
        {"LobeWithoutWeight",
         {{"[specimen.material]\ng = 0.8", "[[specimen.material.lobe]]\nscatter = \"mirror\""}},
         2,
         {"c.toml:28:", "specimen.material.lobe[0].weight", "(0, 1]"}},
        {"LobeThatWeighsNothing",
         {{"[specimen.material]\ng = 0.8", "[[specimen.material.lobe]]\nscatter = \"mirror\"\nweight = 0"}},
         2,
         {"c.toml:30:10", "specimen.material.lobe[0].weight = 0", "(0, 1]"}},
        {"LobeOfNoModel",
         {{"[specimen.material]\ng = 0.8", "[[specimen.material.lobe]]\nweight = 0.5"}},
         2,
         {"c.toml:28:", "specimen.material.lobe[0].scatter", "\"mirror\""}},
        {"KeysBesideLobes",
         {{"g = 0.8", "g = 0.8\n[[specimen.material.lobe]]\nscatter = \"mirror\"\nweight = 0.5"}},
         2,
         {"c.toml:29:5", "specimen.material.g", "beside [[specimen.material.lobe]]", "Move it into a lobe"}},
        {"TooManyLobes",
         {{"[specimen.material]\ng = 0.8", "[specimen.material]\nlobe = [{}, {}, {}, {}, {}]"}},
         2,
         {"c.toml:29:8", "specimen.material.lobe", "at most 4 lobes"}},
        // The map of its reflectance.
        map_fault("MapWithoutKind", "period_um = 8\n", {"c.toml:30:", "specimen.reflectance.kind", "\"grating\""}),
        map_fault("UnknownMap", "kind = \"gratings\"\n",
                  {"c.toml:31:8", "specimen.reflectance.kind", "Did you mean \"grating\"?"}),
        map_fault("GratingWithoutPeriod", "kind = \"grating\"\n",
                  {"c.toml:30:", "specimen.reflectance.period_um", "a finite number > 0"}),
        map_fault("GratingOfNoPeriod", "kind = \"grating\"\nperiod_um = 0\n",
                  {"c.toml:32:13", "specimen.reflectance.period_um = 0", "a finite number > 0"}),
        map_fault("GratingTooFineForFloats", "kind = \"grating\"\nperiod_um = 1e-30\n",
                  {"c.toml:32:13", "specimen.reflectance.period_um", "a length from 1e-07 to 1e+09 um"}),
        map_fault("SideOfAGrating", "kind = \"grating\"\nperiod_um = 8\nside_um = 4\n",
                  {"c.toml:33:11", "specimen.reflectance.side_um", "kind \"checkerboard\""}),
        map_fault("UnknownProfile", "kind = \"grating\"\nperiod_um = 8\nprofile = \"triangular\"\n",
                  {"c.toml:33:11", "specimen.reflectance.profile", "\"sinusoidal\" or \"square\""}),
        map_fault("MoreReflectanceThanAll", "kind = \"checkerboard\"\nside_um = 4\nhighest = 1.5\n",
                  {"c.toml:33:11", "specimen.reflectance.highest = 1.5", "[0, 1]"}),
        map_fault("DarkerThanTheDarkest", "kind = \"checkerboard\"\nside_um = 4\nhighest = 0.4\nlowest = 0.6\n",
                  {"c.toml:34:10", "specimen.reflectance.lowest", "at most highest = 0.4"}),
        map_fault("StarOfNoCycles", "kind = \"star\"\ncycles = 0\n",
                  {"c.toml:32:10", "specimen.reflectance.cycles = 0", "an integer in [1, 1024]"}),
        map_fault("CoarseNoise", "kind = \"noise\"\npitch_um = 4\ncorrelation_length_um = 5\n",
                  {"c.toml:32:12", "specimen.reflectance.pitch_um", "at most half the correlation length, 2.5 um"}),
        map_fault("NoiseWiderThanTheSpecimen", "kind = \"noise\"\npitch_um = 4\ncorrelation_length_um = 500\n",
                  {"c.toml:33:25", "specimen.reflectance.correlation_length_um", "at most the specimen's"}),
        map_fault("EndlessNoise", "kind = \"noise\"\npitch_um = 0.001\ncorrelation_length_um = 5\n",
                  {"c.toml:32:12", "specimen.reflectance.pitch_um", "Choose reflectance.pitch_um >="}),
        map_fault("NegativeSeedOfNoise", "kind = \"noise\"\npitch_um = 4\nseed = -1\n",
                  {"c.toml:33:8", "specimen.reflectance.seed = -1", "an integer in [0, "}),
        map_fault("ImageOfReflectanceWithoutFile", "kind = \"image\"\npitch_um = 1\n",
                  {"c.toml:30:", "specimen.reflectance.file"}),
        map_fault("MissingImageOfReflectance", "kind = \"image\"\npitch_um = 1\nfile = \"absent.png\"\n",
                  {"c.toml:33:8", "specimen.reflectance.file", "absent.png", "no such file"}),
        map_fault("DamagedImageOfReflectance", "kind = \"image\"\npitch_um = 1\nfile = \"map.png\"\n", {"map.png"},
                  {{"map.png", "no picture"}}),
        {"UnknownKind", {{"\"step\"", "\"stp\""}}, 2, {"c.toml:25:8", "specimen.kind", "Did you mean \"step\"?"}},
        {"TooFineFacets",
         {{"height_um = 2.0", "height_um = 2.0\npitch_um = 1e-6"}},
         2,
         {"c.toml:28:12", "specimen.pitch_um", "Choose pitch_um >="}},
        {"NoRays", {{"rays = 2000", "rays = 0"}}, 2, {"c.toml:42:8", "trace.rays = 0", "an integer in [1, "}},
        {"EvenWindow",
         {{"window_px = 3", "window_px = 4"}},
         2,
         {"c.toml:46:13", "topography.window_px = 4", "Choose 3 or 5"}},
        {"BackwardWithoutTrains",
         {{"rays = 2000", "rays = 2000\nmode = \"nonsequential\"\nestimator = \"backward\""}},
         2,
         {"c.toml:44:13", "trace.estimator", "Choose estimator = \"forward\", or mode = \"sequential\""}},
        {"UnknownScattering",
         {{"rays = 2000", "rays = 2000\nscattering = \"aimed\""}},
         2,
         {"c.toml:43:14", "trace.scattering", "\"analog\" or \"directed\""}},
        {"DirectedScatterWithoutTrains",
         {{"rays = 2000", "rays = 2000\nmode = \"nonsequential\"\nscattering = \"directed\""}},
         2,
         {"c.toml:44:14", "trace.scattering", "Choose scattering = \"analog\""}},
        {"NonsequentialByQuadtree",
         {{"rays = 2000", "rays = 2000\nmode = \"nonsequential\"\ntraversal = \"quadtree\""}},
         2,
         {"c.toml:44:13", "trace.traversal", "\"auto\", \"bvh\" or \"ray-query\""}},
        {"WavelengthNoGlassKnows",
         {{"wavelength_um = 0.5876", "wavelength_um = 10.6"}},
         2,
         {"c.toml", "10.6", "expected a wavelength", "Choose such a wavelength"}},
        // The scan.
        {"StepOfZero", {{"z_step_um = 1.0", "z_step_um = 0"}}, 2, {"c.toml:39:13", "scan.z_step_um = 0"}, stack},
        {"ScanOfZeroSteps",
         {{"z_stop_um = 2.0", "z_stop_um = -2.0"}},
         2,
         {"c.toml:39:13", "scan.z_step_um", "at least 3 focal positions"},
         stack},
        {"ScanDownwards",
         {{"z_stop_um = 2.0", "z_stop_um = -3.0"}},
         2,
         {"c.toml:38:13", "scan.z_stop_um = -3", "Exchange"},
         stack},
        {"EndlessScan", {{"z_step_um = 1.0", "z_step_um = 1e-9"}}, 2, {"c.toml:39:13", "at most 10000"}, stack},
        {"NoScan",
         {{"[scan]\nz_start_um = -2.0\nz_stop_um = 2.0\nz_step_um = 1.0\n", ""}},
         2,
         {"c.toml", "scan", "Add [scan]"},
         stack},
        // Prescriptions.
        {"UnknownObjective",
         {{"\"10x_0.28\"", "\"11x_0.28\""}},
         2,
         {"c.toml:15:16", "objective.prescription", "11x_0.28", "assets/objectives",
          "looked for assets/objectives/11x_0.28.toml beside /",
          "bad_input_UnknownObjective, beside every folder above it", "Did you mean \"10x_0.28\"?"}},
        {"MissingPrescriptionFile",
         {{"\"10x_0.28\"", "\"mine.toml\""}},
         2,
         {"c.toml:15:16", "objective.prescription", "an existing file; looked for /",
          "bad_input_MissingPrescriptionFile/mine.toml"}},
        {"DamagedPrescription",
         {{"\"10x_0.28\"", "\"mine.toml\""}},
         2,
         {"mine.toml:5:13", "radius_mm", "bent"},
         {"--check", "c.toml"},
         {{"mine.toml", "title = \"t\"\nsource = \"s\"\nlicence = \"l\"\n[[surface]]\nradius_mm = \"bent\"\n"}}},
        {"PrescriptionWithoutSurfaces",
         {{"\"10x_0.28\"", "\"mine.toml\""}},
         2,
         {"mine.toml:1:1", "surface", "Add [[surface]]"},
         {"--check", "c.toml"},
         {{"mine.toml", "title = \"t\"\nsource = \"s\"\nlicence = \"l\"\n"}}},
        // Glasses.
        {"MissingGlassCatalogue",
         {{"# a small step", "glass_catalogs = [\"absent.agf\"]"}},
         2,
         {"bad_input_MissingGlassCatalogue/absent.agf", "no such file", "Check the path",
          "It is named at c.toml:1:18"}},
        {"GlassCataloguesNoArray",
         {{"# a small step", "glass_catalogs = \"g.agf\""}},
         2,
         {"c.toml:1:18", "glass_catalogs", "an array of paths", "in brackets"}},
        {"GlassCatalogueNoPath",
         {{"# a small step", "glass_catalogs = [7]"}},
         2,
         {"c.toml:1:19", "glass_catalogs[0]", "a string"}},
        catalogue_fault("CatalogueWithoutGlass", "CC none\n", {"g.agf", "NM", "no glass", "complete"}),
        catalogue_fault("GlassWithoutFormula", "NM G\n", {"g.agf:1", "NM", "the number of a formula", "Complete"}),
        catalogue_fault("UnknownGlassFormula", "NM G 14\n", {"g.agf:1", "NM", "\"14\"", "1 to 13"}),
        catalogue_fault("CoefficientsTooManyInTwoLines", "NM G 5\nCD 1 2\n3 4\nLD 1 2\n",
                        {"g.agf:3", "CD of \"G\"", "3 coefficients"}),
        catalogue_fault("CoefficientNoNumber", "NM G 5\nCD 1,5\n",
                        {"g.agf:2", "CD of \"G\"", "1,5", "a finite number"}),
        catalogue_fault("CoefficientInfinite", "NM G 5\nCD 1e999\n", {"g.agf:2", "CD of \"G\"", "1e999"}),
        catalogue_fault("CoefficientsTooMany", "NM G 5\nCD 1 2 3 4\n", {"g.agf:2", "CD of \"G\"", "3 coefficients"}),
        catalogue_fault("CoefficientsNone", "NM G 5\nCD\n", {"g.agf:2", "CD of \"G\"", "Complete the line"}),
        catalogue_fault("CoefficientsOfNoGlass", "CD 1.5\n", {"g.agf:1", "CD", "a line NM before it"}),
        catalogue_fault("CoefficientsTwice", "NM G 5\nCD 1\nCD 1\n", {"g.agf:3", "CD of \"G\"", "Remove one"}),
        catalogue_fault("CoefficientsMissing", "NM G 5\nLD 1 2\n", {"g.agf:1", "CD of \"G\"", "Complete the glass"}),
        catalogue_fault("RangeMissing", "NM G 5\nCD 1.5\n", {"g.agf:1", "LD of \"G\"", "Complete the glass"}),
        catalogue_fault("RangeCut", "NM G 5\nCD 1.5\nLD 1\n", {"g.agf:3", "LD of \"G\"", "Complete the line"}),
        catalogue_fault("RangeDescending", "NM G 5\nCD 1.5\nLD 2 1\n",
                        {"g.agf:3", "LD of \"G\"", "\"2 1\"", "ascending"}),
        catalogue_fault("UnknownCatalogueKeyword", "NM G 5\nXY 1\n", {"g.agf:2", "XY of \"G\"", "NM, CD, LD", "'!'"}),
        glass_fault("UnknownGlass", "", {"mine.toml:4:10", "surface[0].medium = 'glass'", "glass_catalogs"}),
        glass_fault("GlassDescribedTwice", "[media.glass]\nindex = 1.5\nnd = 1.5\nvd = 50\n",
                    {"mine.toml:11:9", "media.glass.index", "one description"}),
        glass_fault("GlassNotDescribed", "[media.glass]\n", {"mine.toml:10:1", "media.glass.wavelengths_um"}),
        glass_fault("UnknownFormulaName", "[media.glass]\nformula = \"selmeier 1\"\n",
                    {"mine.toml:11:11", "media.glass.formula", "Did you mean \"sellmeier 1\"?"}),
        glass_fault("FormulaWithoutRange", "[media.glass]\nformula = \"conrady\"\ncoefficients = [1.5]\n",
                    {"mine.toml:10:1", "media.glass.range_um"}),
        glass_fault("WavelengthOutsideTheGlass",
                    "[media.glass]\nformula = \"conrady\"\ncoefficients = [1.5]\nrange_um = [0.6, 0.7]\n",
                    {"index of glass", "0.5876 um", "[0.6, 0.7] um", "Choose such a wavelength"}),
        glass_fault("GlassWithoutIndex",
                    "[media.glass]\nformula = \"schott\"\ncoefficients = [-1]\nrange_um = [0.4, 0.7]\n",
                    {"index of glass", "0.5876 um", "finite and positive", "Correct the numbers"}),
        // Files of specimens.
        {"MissingMesh", {mesh_specimen}, 2, {"c.toml:26:8", "specimen.file", "bad_input_MissingMesh/part.stl"}},
        {"TruncatedStl",
         {mesh_specimen},
         2,
         {"part.stl@"},
         {"--check", "c.toml"},
         {{"part.stl", binary_stl(1).substr(0, 120)}}},
        {"StlThatPromisesMore", {mesh_specimen}, 2, {"part.stl"}, {"--check", "c.toml"}, {{"part.stl", binary_stl(7)}}},
        {"StlWithNaN",
         {mesh_specimen},
         2,
         {"part.stl@96", "finite"}, // 84 bytes of header, 12 of normal, then the first coordinate
         {"--check", "c.toml"},
         {{"part.stl", binary_stl(1, std::numeric_limits<float>::quiet_NaN())}}},
        {"AsciiStlWithWord",
         {mesh_specimen},
         2,
         {"part.stl:4:"},
         {"--check", "c.toml"},
         {{"part.stl", "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0\nvertex 1 0 0\nvertex 0 1 0\n"
                       "endloop\nendfacet\nendsolid s\n"}}},
        {"EmptyMesh",
         {mesh_specimen},
         2,
         {"part.stl", "at least one triangle"},
         {"--check", "c.toml"},
         {{"part.stl", binary_stl(0).substr(0, 84)}}},
        {"MissingFont",
         {file_specimen("kind = \"plateaus\"\nsize_mm = 0.2\npitch_um = 1\ntext = \"a\"\nfont = "
                        "\"NoSuchFont\"\nheights_um = [1]\n")},
         2,
         {"c.toml:29:8", "specimen.font", "NoSuchFont", "looked for in $OPENIMAGEIO_FONTS", "Install the font"}},
        {"GltfThatIsNone",
         {file_specimen("kind = \"gltf\"\nfile = \"part.gltf\"\n")},
         2,
         {"part.gltf"},
         {"--check", "c.toml"},
         {{"part.gltf", "{ \"asset\": "}}},
        {"ImageThatIsNone",
         {file_specimen("kind = \"image\"\nfile = \"map.png\"\npitch_um = 1\nheight_um = 1\n")},
         2,
         {"map.png"},
         {"--check", "c.toml"},
         {{"map.png", "no picture"}}},
        // Rays.
        {"RaysMissing", {}, 2, {"rays.csv", "Check the path"}, rays},
        {"RaysHeader", {}, 2, {"rays.csv:1:1", "x_mm,y_mm,z_mm,l,m,n"}, rays, {{"rays.csv", "x,y,z\n1,2,3\n"}}},
        {"RaysWord", {}, 2, {"rays.csv:2:3", "y_mm", "\"b\""}, rays, {{"rays.csv", rays_header + "0,b,0,0,0,1\n"}}},
        {"RaysShortLine",
         {},
         2,
         {"rays.csv:3:", "6 numbers"},
         rays,
         {{"rays.csv", rays_header + "0,0,0,0,0,1\n0,0\n"}}},
        {"RaysLongLine", {}, 2, {"rays.csv:2:", "6 numbers"}, rays, {{"rays.csv", rays_header + "0,0,0,0,0,1,7\n"}}},
        {"RaysInfinite", {}, 2, {"rays.csv:2:1", "finite"}, rays, {{"rays.csv", rays_header + "inf,0,0,0,0,1\n"}}},
        {"RaysNotUnit", {}, 2, {"rays.csv:2:1", "length 1"}, rays, {{"rays.csv", rays_header + "0,0,0,0,0,2\n"}}},
        {"RaysNone", {}, 2, {"rays.csv:1:1", "at least one ray"}, rays, {{"rays.csv", rays_header}}},
        // The command line.
        {"UnknownOption", {}, 2, {"--chekc", "Did you mean --check?"}, {"--chekc", "c.toml"}},
        {"NoCommand", {}, 2, {"no command", "--help"}, {"--quiet"}},
        {"TwoCommands", {}, 2, {"--check", "--bench", "one command"}, {"--check", "c.toml", "--bench", "c.toml"}},
        {"CommandWithoutFile", {}, 2, {"--check", "--help"}, {"--check"}},
        {"ImageWithoutHeight", {}, 2, {"--z UM"}, {"--image", "c.toml"}},
        {"HeightThatIsNone", {}, 2, {"--z", "--help"}, {"--image", "c.toml", "--z", "high"}},
        {"RaysThatAreNone", {}, 2, {"--rays: trace.rays", "many"}, {"--check", "c.toml", "--rays", "many"}},
        {"UnknownTraversal",
         {},
         2,
         {"--traversal: trace.traversal", "Did you mean \"quadtree\"?"},
         {"--check", "c.toml", "--traversal", "quadtre"}},
        {"SettingWithoutValue", {}, 2, {"--set trace.rays", "KEY=VALUE"}, {"--check", "c.toml", "--set", "trace.rays"}},
        {"SettingOfUnknownKey",
         {},
         2,
         {"--set", "trace.rasy", "Did you mean \"rays\"?"},
         {"--check", "c.toml", "--set", "trace.rasy=5"}},
        {"NoStackThere", {}, 2, {"nowhere", "stack.toml"}, {"--topography", "nowhere"}},
        // Surfaces.
        {"SurfaceMissing", {}, 2, {"part.x3p", "Check the path"}, {"--surface", "part.x3p"}},
        {"SurfaceOfUnknownKind",
         {},
         2,
         {"part.x3p", "an X3P, SUR, SDF", "Export"},
         {"--surface", "part.x3p"},
         {{"part.x3p", "none"}}},
        {"FormOfUnknownName",
         {},
         2,
         {"--form polynomial-21", "polynomial-1 to polynomial-20 or sphere", "Name one of these"},
         {"--surface", "part.x3p", "--form", "polynomial-21"}},
        {"FilterOfNegativeIndex",
         {},
         2,
         {"a nesting index of -5 um", "--s_filter_um or --l_filter_um"},
         {"--surface", "part.x3p", "--s-filter-um", "-5"}},
        {"FilterOfInfiniteIndex",
         {},
         2,
         {"a nesting index of inf um", "--s_filter_um or --l_filter_um"},
         {"--compare", "a.x3p", "b.x3p", "--l_filter_um", "inf"}},
        {"FilterThatIsNone", {}, 2, {"--filter", "--help"}, {"--surface", "part.x3p", "--filter", "median"}},
        {"FiltersExchanged",
         {},
         2,
         {"--s_filter_um 80 with --l_filter_um 5", "Exchange them"},
         {"--surface", "part.x3p", "--s_filter_um", "80", "--l_filter_um", "5"}},
        {"ProfileOfThreeNumbers",
         {},
         2,
         {"--profile 1,2,3", "four numbers", "--profile 0,50,100,50"},
         {"--surface", "part.x3p", "--profile", "1,2,3"}},
        {"ProfileOfFiveNumbers",
         {},
         2,
         {"--profile -1,2,3,4,5", "four numbers"},
         {"--surface", "part.x3p", "--profile", "-1,2,3,4,5"}},
        {"ProfileOfWords",
         {},
         2,
         {"--profile a,b,c,d", "four numbers"},
         {"--surface", "part.x3p", "--profile", "a,b,c,d"}},
        {"FormElsewhere",
         {},
         2,
         {"--form with --check", "--surface or --compare"},
         {"--check", "c.toml", "--form", "none"}},
        {"ProfileElsewhere",
         {},
         2,
         {"--profile with --compare", "Leave --profile out"},
         {"--compare", "a.x3p", "b.x3p", "--profile", "1,2,3,4"}},
        {"RaysElsewhere", {}, 2, {"--rays with --surface", "--stack"}, {"--surface", "part.x3p", "--rays", "5"}},
        {"SetElsewhere",
         {},
         2,
         {"--set with --compare", "--stack"},
         {"--compare", "a.x3p", "b.x3p", "--set", "trace.seed=5"}},
        {"OutElsewhere", {}, 2, {"--out with --check", "--stack"}, {"--check", "c.toml", "--out", "o"}},
        {"JsonElsewhere", {}, 2, {"--json with --stack", "--check"}, {"--stack", "c.toml", "--json"}},
        {"AlignElsewhere", {}, 2, {"--align with --check", "--compare"}, {"--check", "c.toml", "--align"}},
        {"ShuffleElsewhere",
         {},
         2,
         {"--shuffle with --check", "--topography"},
         {"--check", "c.toml", "--shuffle", "1"}},
        {"UnitElsewhere", {}, 2, {"--unit_um with --check", "--surface"}, {"--check", "c.toml", "--unit_um", "1"}},
        {"StepElsewhere",
         {},
         2,
         {"--z_step_um with --surface", "expected --topography"},
         {"--surface", "part.x3p", "--z-step-um", "1"}},
        // Zemax lenses.
        {"ImportOfUnknownKeyword",
         {},
         2,
         {"lens.zmx:8: surface 1: SCBD", "expected a keyword that this import understands", "Remove in Zemax"},
         import,
         {{"lens.zmx", zemax_lens("SCBD 0 1 0 0 0 0")}}},
        {"ImportOfMirror",
         {},
         2,
         {"lens.zmx:8: surface 1: GLAS = MIRROR", "a refracting surface", "unfold"},
         import,
         {{"lens.zmx", zemax_lens("GLAS MIRROR 0 0 1.5 40")}}},
        {"ImportOfMissingGlass",
         {},
         2,
         {"lens.zmx:8: surface 1: GLAS = N-BK99", "a glass of the catalogues", "--glass-catalog"},
         import,
         {{"lens.zmx", zemax_lens("GLAS N-BK99 0 0 1.5 40")}}},
        {"ImportOfAModelGlassOfTinyAbbeNumber",
         {},
         2,
         {"lens.zmx:8: surface 1: GLAS", "in [5, 150], or 0 for no dispersion"},
         import,
         {{"lens.zmx", zemax_lens("GLAS ___BLANK 1 0 1.5 0.5")}}},
        {"ImportOfWrongNumber",
         {},
         2,
         {"lens.zmx:8: surface 1: CONI = -0,6", "as value 1 a finite number", "decimals take a point"},
         import,
         {{"lens.zmx", zemax_lens("CONI -0,6")}}},
        {"ImportOfTruncatedFile",
         {},
         2,
         {"lens.zmx:11: surface 2: SURF = no DISZ", "The file looks cut off"},
         import,
         {{"lens.zmx", zemax_lens("").substr(0, 108)}}},
        {"ImportOfEmptyFile", {}, 2, {"lens.zmx", "0 surfaces", "a whole .zmx file"}, import, {{"lens.zmx", ""}}},
        {"ImportOfNoText",
         {},
         2,
         {"lens.zmx@2", "a NUL character", "UTF-16"},
         import,
         {{"lens.zmx", std::string("\xff\xfe\0\0", 4)}}},
        {"ImportOfNothing", {}, 2, {"lens.zmx", "no such file", "Check the path"}, import},
        {"ImportWithMissingCatalogue",
         {},
         2,
         {"absent.agf"},
         {"--import", "lens.zmx", "--glass-catalog", "absent.agf"},
         {{"lens.zmx", zemax_lens("")}}},
        // Devices.
        {"UnknownDevice", {}, 3, {"no-such-device"}, {"--image", "c.toml", "--z", "0", "--device", "no-such-device"}},
        {"NoDriver",
         {},
         3,
         {"river"},
         {"--image", "c.toml", "--z", "0"},
         {},
         {{"VK_DRIVER_FILES", "/nonexistent/icd.json"}, {"VK_ICD_FILENAMES", "/nonexistent/icd.json"}}},
        {"NoDriverToList",
         {},
         3,
         {"river"},
         {"--devices"},
         {},
         {{"VK_DRIVER_FILES", "/nonexistent/icd.json"}, {"VK_ICD_FILENAMES", "/nonexistent/icd.json"}}},
    };
}

class BadInput : public testing::TestWithParam<Case> {};

TEST_P(BadInput, IsRefusedWithPlaceKeyExpectationAndRemedy) {
    const Case& given = GetParam();
    const auto folder = fresh_folder("bad_input_" + given.name);
    std::string text = small_configuration;
    for (const auto& [from, to] : given.changes) {
        text = replaced(text, from, to);
    }
    write_file(folder / "c.toml", text);
    for (const auto& [name, content] : given.files) {
        write_file(folder / name, content);
    }
    const auto result = run_program(given.arguments, folder, given.environment);
    EXPECT_EQ(result.exit_code, given.exit_code) << result.standard_error;
    for (const auto& part : given.message) {
        EXPECT_THAT(result.standard_error, HasSubstr(part));
    }
    EXPECT_EQ(result.standard_output, "");
    EXPECT_FALSE(std::filesystem::exists(folder / "out")) << "it ran on";
}

INSTANTIATE_TEST_SUITE_P(Table, BadInput, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<Case>& info) { return info.param.name; });

// Little stack changes nothing about names of many parts.
TEST(BadInputTable, DeepNamesNeedNoStack) {
    const auto folder = fresh_folder("deep");
    for (const auto& line :
         {"[" + repeated("a.", 50'000) + "a]", "x = " + repeated("[", 50'000), repeated("a.", 50'000) + "a = 1"}) {
        write_file(folder / "c.toml", line + "\n" + small_configuration);
        const std::string command =
            "cd '" + folder.string() + "' && ulimit -s 256 && '" + VKFV_BINARY_DIR + "/vkfv' --check c.toml 2>message";
        const int status = std::system(command.c_str());
        ASSERT_TRUE(WIFEXITED(status));
        EXPECT_EQ(WEXITSTATUS(status), 2);
        EXPECT_THAT(read_file(folder / "message"), HasSubstr("nested at most 64 deep"));
    }
}

TEST(BadInputTable, IsAsLongAsPromised) {
    EXPECT_GE(cases().size(), 30u);
}

// The wrong twin of the table: the configuration that every case damages is itself accepted.
TEST(BadInputTable, UndamagedConfigurationIsAccepted) {
    const auto folder = fresh_folder("bad_input_none");
    write_file(folder / "c.toml", small_configuration);
    const auto result = run_program({"--check", "c.toml"}, folder);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    EXPECT_THAT(result.standard_output, HasSubstr("numerical_aperture"));
}

} // namespace
} // namespace vkfv::test
