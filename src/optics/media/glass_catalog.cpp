#include "optics/media/glass_catalog.hpp"

#include "core/error.hpp"
#include "core/toml_reader.hpp"
#include "optics/media/agf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace vkfv::optics {

namespace {

struct BuiltinGlass {
    const char* name;
    DispersionFormula formula;
    double minimum_um;
    double maximum_um;
    const char* source;
    std::vector<double> coefficients;
};

constexpr const char* schott_2018 = "SCHOTT catalogue, status of 1 June 2018";
constexpr const char* ohara_2019 = "OHARA catalogue, updated 18 October 2019";
constexpr const char* cdgm = "CDGM catalogue, as in the AGF file of zemaxglass";
// Glasses no longer made, and B270, for which only three indices are at hand: Conrady's formula through them.
constexpr const char* zemax_lines = "F, d and C indices of Zemax's old catalogues, as printed in LensLibrary's reports";
constexpr const char* b270_lines = "F, d and C indices of the Thorlabs catalogue's aspheric condensers";

const std::vector<BuiltinGlass>& builtin_glasses() {
    using enum DispersionFormula;
    constexpr double air_squared = 1.000272 * 1.000272; // at 20 C, 1 atm and 0.5876 um
    static const std::vector<BuiltinGlass> glasses = {
        // clang-format off
        {"N-BK7", sellmeier_1, 0.3, 2.5, schott_2018,
         {1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653}},
        {"N-BAF10", sellmeier_1, 0.35, 2.5, schott_2018,
         {1.5851495, 0.00926681282, 0.143559385, 0.0424489805, 1.08521269, 105.613573}},
        {"N-BAK1", sellmeier_1, 0.3, 2.5, schott_2018,
         {1.12365662, 0.00644742752, 0.309276848, 0.0222284402, 0.881511957, 107.297751}},
        {"N-BAK4", sellmeier_1, 0.334, 2.5, schott_2018,
         {1.28834642, 0.00779980626, 0.132817724, 0.0315631177, 0.945395373, 105.965875}},
        {"F2", sellmeier_1, 0.32, 2.5, schott_2018,
         {1.34533359, 0.00997743871, 0.209073176, 0.0470450767, 0.937357162, 111.886764}},
        {"N-F2", sellmeier_1, 0.365, 2.5, schott_2018,
         {1.39757037, 0.00995906143, 0.159201403, 0.0546931752, 1.2686543, 119.248346}},
        {"N-FK5", sellmeier_1, 0.26, 2.5, schott_2018,
         {0.844309338, 0.00475111955, 0.344147824, 0.0149814849, 0.910790213, 97.8600293}},
        {"N-FK51A", sellmeier_1, 0.29, 2.5, schott_2018,
         {0.971247817, 0.00472301995, 0.216901417, 0.0153575612, 0.904651666, 168.68133}},
        {"K7", sellmeier_1, 0.31, 2.5, schott_2018,
         {1.1273555, 0.00720341707, 0.124412303, 0.0269835916, 0.827100531, 100.384588}},
        {"K10", sellmeier_1, 0.3, 2.5, schott_2018,
         {1.15687082, 0.00809424251, 0.0642625444, 0.0386051284, 0.872376139, 104.74773}},
        {"N-K5", sellmeier_1, 0.31, 2.5, schott_2018,
         {1.08511833, 0.00661099503, 0.199562005, 0.024110866, 0.930511663, 111.982777}},
        {"N-KF9", sellmeier_1, 0.35, 2.5, schott_2018,
         {1.19286778, 0.00839154696, 0.0893346571, 0.0404010786, 0.920819805, 112.572446}},
        {"N-KZFS4", sellmeier_1, 0.334, 2.5, schott_2018,
         {1.35055424, 0.0087628207, 0.197575506, 0.0371767201, 1.09962992, 90.3866994}},
        {"N-KZFS11", sellmeier_1, 0.31, 2.5, schott_2018,
         {1.3322245, 0.0084029848, 0.28924161, 0.034423972, 1.15161734, 88.4310532}},
        {"N-LAF2", sellmeier_1, 0.35, 2.5, schott_2018,
         {1.80984227, 0.0101711622, 0.15729555, 0.0442431765, 1.0930037, 100.687748}},
        {"N-LAK8", sellmeier_1, 0.31, 2.5, schott_2018,
         {1.33183167, 0.00620023871, 0.546623206, 0.0216465439, 1.19084015, 82.5827736}},
        {"N-LAK14", sellmeier_1, 0.31, 2.5, schott_2018,
         {1.50781212, 0.00746098727, 0.318866829, 0.0242024834, 1.14287213, 80.9565165}},
        {"N-LAK22", sellmeier_1, 0.31, 2.5, schott_2018,
         {1.14229781, 0.00585778594, 0.535138441, 0.0198546147, 1.04088385, 100.834017}},
        {"N-LASF9", sellmeier_1, 0.365, 2.5, schott_2018,
         {2.00029547, 0.0121426017, 0.298926886, 0.0538736236, 1.80691843, 156.530829}},
        {"N-LASF44", sellmeier_1, 0.334, 2.5, schott_2018,
         {1.78897105, 0.00872506277, 0.38675867, 0.0308085023, 1.30506243, 92.7743824}},
        {"LLF1", sellmeier_1, 0.31, 2.5, schott_2018,
         {1.21640125, 0.00857807248, 0.13366454, 0.0420143003, 0.883399468, 107.59306}},
        {"N-PK51", sellmeier_1, 0.3, 2.5, schott_2018,
         {1.15610775, 0.00585597402, 0.153229344, 0.0194072416, 0.785618966, 140.537046}},
        {"N-PK52A", sellmeier_1, 0.29, 2.5, schott_2018,
         {1.029607, 0.00516800155, 0.1880506, 0.0166658798, 0.736488165, 138.964129}},
        {"SF2", sellmeier_1, 0.35, 2.5, schott_2018,
         {1.40301821, 0.0105795466, 0.231767504, 0.0493226978, 0.939056586, 112.405955}},
        {"SF5", sellmeier_1, 0.35, 2.5, schott_2018,
         {1.46141885, 0.0111826126, 0.247713019, 0.0508594669, 0.949995832, 112.041888}},
        {"N-SF5", sellmeier_1, 0.37, 2.5, schott_2018,
         {1.52481889, 0.011254756, 0.187085527, 0.0588995392, 1.42729015, 129.141675}},
        {"SF6", sellmeier_1, 0.365, 2.5, schott_2018,
         {1.72448482, 0.0134871947, 0.390104889, 0.0569318095, 1.04572858, 118.557185}},
        {"N-SF6", sellmeier_1, 0.37, 2.5, schott_2018,
         {1.77931763, 0.0133714182, 0.338149866, 0.0617533621, 2.08734474, 174.01759}},
        {"SF10", sellmeier_1, 0.38, 2.5, schott_2018,
         {1.61625977, 0.0127534559, 0.259229334, 0.0581983954, 1.07762317, 116.60768}},
        {"N-SF10", sellmeier_1, 0.38, 2.5, schott_2018,
         {1.62153902, 0.0122241457, 0.256287842, 0.0595736775, 1.64447552, 147.468793}},
        {"SF11", sellmeier_1, 0.39, 2.5, schott_2018,
         {1.73848403, 0.0136068604, 0.311168974, 0.0615960463, 1.17490871, 121.922711}},
        {"N-SF11", sellmeier_1, 0.37, 2.5, schott_2018,
         {1.73759695, 0.013188707, 0.313747346, 0.0623068142, 1.89878101, 155.23629}},
        {"SF57", sellmeier_1, 0.37, 2.5, schott_2018,
         {1.81651371, 0.0143704198, 0.428893641, 0.0592801172, 1.07186278, 121.419942}},
        {"N-SF57", sellmeier_1, 0.37, 2.5, schott_2018,
         {1.87543831, 0.0141749518, 0.37375749, 0.0640509927, 2.30001797, 177.389795}},
        {"N-SF66", sellmeier_1, 0.39, 2.5, schott_2018,
         {2.0245976, 0.0147053225, 0.470187196, 0.0692998276, 2.59970433, 161.817601}},
        {"N-SK2", sellmeier_1, 0.31, 2.5, schott_2018,
         {1.28189012, 0.0072719164, 0.257738258, 0.0242823527, 0.96818604, 110.377773}},
        {"N-SK11", sellmeier_1, 0.3, 2.5, schott_2018,
         {1.17963631, 0.00680282081, 0.229817295, 0.0219737205, 0.935789652, 101.513232}},
        {"N-SK14", sellmeier_1, 0.31, 2.5, schott_2018,
         {0.936155374, 0.00461716525, 0.594052018, 0.016885927, 1.04374583, 103.736265}},
        {"N-SK16", sellmeier_1, 0.31, 2.5, schott_2018,
         {1.34317774, 0.00704687339, 0.241144399, 0.0229005, 0.994317969, 92.7508526}},
        {"N-SSK5", sellmeier_1, 0.35, 2.5, schott_2018,
         {1.59222659, 0.00920284626, 0.103520774, 0.0423530072, 1.05174016, 106.927374}},
        {"S-BSL7", sellmeier_1, 0.365015, 2.32542, ohara_2019,
         {1.1515019, 0.010598413, 0.118583612, -0.011822519, 1.26301359, 129.617662}},
        {"S-BSM14", sellmeier_1, 0.365015, 2.32542, ohara_2019,
         {1.2828627, 0.0122902399, 0.247647429, -0.00613142361, 1.10383999, 106.883378}},
        {"S-FPL51", sellmeier_1, 0.365015, 2.32542, ohara_2019,
         {1.17010505, 0.00616203924, 0.0475710783, 0.0263372876, 0.763832445, 141.882642}},
        {"S-FPL53", sellmeier_1, 0.365015, 2.32542, ohara_2019,
         {0.983532327, 0.00492234955, 0.069568814, 0.0193581091, 1.11409238, 264.275294}},
        {"S-FSL5", sellmeier_1, 0.365015, 2.32542, ohara_2019,
         {1.17447043, 0.00841855181, 0.0140056154, -0.0581790767, 1.19272435, 129.599726}},
        {"S-LAH58", sellmeier_1, 0.365015, 2.32542, ohara_2019,
         {1.78764964, 0.00847378536, 0.6526356, 0.0313126408, 1.79914564, 132.788001}},
        {"S-LAH64", sellmeier_1, 0.365015, 2.32542, ohara_2019,
         {1.83021453, 0.0090482329, 0.29156359, 0.0330756689, 1.28544024, 89.3675501}},
        {"S-LAH79", sellmeier_1, 0.404656, 2.32542, ohara_2019,
         {2.32557148, 0.0132895208, 0.507967133, 0.0528335449, 2.43087198, 161.122408}},
        {"S-LAL14", sellmeier_1, 0.365015, 2.32542, ohara_2019,
         {1.2372097, 0.015355132, 0.589722623, -0.00030789625, 1.3192188, 93.7202947}},
        {"S-LAL18", sellmeier_1, 0.365015, 2.32542, ohara_2019,
         {1.50276318, 0.0145462356, 0.430224497, -0.00332784153, 1.3472606, 93.3508342}},
        {"S-NBH5", sellmeier_1, 0.365015, 2.32542, ohara_2019,
         {1.47544521, 0.0095583674, 0.193060095, 0.0460430483, 1.5093901, 126.422746}},
        {"S-NPH1", sellmeier_1, 0.404656, 2.32542, ohara_2019,
         {1.75156623, 0.0135004681, 0.364006304, 0.0668245147, 2.47874141, 170.756006}},
        {"S-TIH6", sellmeier_1, 0.404656, 2.32542, ohara_2019,
         {1.77227611, 0.0131182633, 0.34569125, 0.0614479619, 2.40788501, 200.753254}},
        {"S-TIH53", sellmeier_1, 0.404656, 2.32542, ohara_2019,
         {1.87904886, 0.014412177, 0.369719775, 0.063881799, 2.33730863, 182.66818}},
        {"S-TIM22", sellmeier_1, 0.404656, 2.32542, ohara_2019,
         {1.44222294, 0.0104249404, 0.194432265, 0.0550235257, 1.74092482, 169.710769}},
        {"H-K9L", schott, 0.365, 1.014, cdgm,
         {2.2691511, -0.0085158629, 0.012270445, -0.00025168835, 4.8989821e-05, -2.0672665e-06}},
        {"H-FK61", schott, 0.365, 1.014, cdgm,
         {2.21684419, -0.00491618203, 0.00894134262, -4.29956244e-05, 1.46376888e-05, -5.58732728e-07}},
        {"H-ZF6", schott, 0.365, 1.014, cdgm,
         {2.97759601, -0.0187703401, 0.0256077224, 0.0058044496, -0.000705314282, 5.49723957e-05}},
        {"H-LAK53A", schott, 0.365, 0.7065, cdgm,
         {3.0182184, -0.015381633, 0.021520137, 0.00064608303, -3.2355748e-05, 2.0791593e-06}},
        {"B270", conrady, 0.48, 0.66, b270_lines,
         {1.5051465879, 0.00850457367632, 0.000525392571359}},
        {"BK10", conrady, 0.48, 0.66, zemax_lines,
         {1.47964512966, 0.00960186864444, 0.000285157557727}},
        {"FDS9", conrady, 0.48, 0.66, zemax_lines,
         {1.78509790409, 0.026109123792, 0.00266242897619}},
        {"FK51", conrady, 0.48, 0.66, zemax_lines,
         {1.47301002435, 0.00702431738229, 0.000248157885889}},
        {"FK54", conrady, 0.48, 0.66, zemax_lines,
         {1.42550830796, 0.00599829043938, 0.000199472936672}},
        {"KZFS4", conrady, 0.48, 0.66, zemax_lines,
         {1.58298727449, 0.0150985994234, 0.000733207595173}},
        {"LAK14", conrady, 0.48, 0.66, zemax_lines,
         {1.66806812674, 0.0147061568366, 0.00057618162197}},
        {"NBFD5", conrady, 0.48, 0.66, zemax_lines,
         {1.72383743267, 0.0181086571034, 0.0011418460801}},
        {"SK14", conrady, 0.48, 0.66, zemax_lines,
         {1.5800823088, 0.0118352673494, 0.000448589896704}},
        {"FUSED-SILICA", sellmeier_1, 0.21, 3.71, "Malitson, J. Opt. Soc. Am. 55, 1205 (1965), 20 C",
         {0.6961663, 0.0684043 * 0.0684043, 0.4079426, 0.1162414 * 0.1162414,
          0.8974794, 9.896161 * 9.896161}},
        {"CAF2", sellmeier_1, 0.23, 9.7, "Malitson, Appl. Opt. 2, 1103 (1963), 24 C",
         {0.5675888, 0.050263605 * 0.050263605, 0.4710914, 0.1003909 * 0.1003909,
          3.8484723, 34.649040 * 34.649040}},
        {"MGF2", sellmeier_1, 0.2, 7, "Dodge, Appl. Opt. 23, 1980 (1984), ordinary ray, 19 C",
         {0.48755108, 0.04338408 * 0.04338408, 0.39875031, 0.09461442 * 0.09461442,
          2.3120353, 23.793604 * 23.793604}},
        {"SAPPHIRE", sellmeier_1, 0.2, 5,
         "Malitson and Dodge, J. Opt. Soc. Am. 62, 1405 (1972), ordinary ray, 20 C",
         {1.4313493, 0.0726631 * 0.0726631, 0.65054713, 0.1193242 * 0.1193242,
          5.3414021, 18.028251 * 18.028251}},
        // Daimon and Masumura's formula gives the index relative to vacuum: n^2 is divided by that of air,
        // which the visible spectrum changes by less than 4e-6. The term without resonance is the rest of 1.
        {"WATER", sellmeier_5, 0.182, 1.129,
         "Daimon and Masumura, Appl. Opt. 46, 3811 (2007), 20 C, relative to air of index 1.000272",
         {5.684027565e-1 / air_squared, 5.101829712e-3, 1.726177391e-1 / air_squared, 1.821153936e-2,
          2.086189578e-2 / air_squared, 2.620722293e-2,
          1.130748688e-1 / air_squared, 1.069792721e1, 1 / air_squared - 1, 0}},
        // clang-format on
    };
    return glasses;
}

// Model glass of n_e = 1.518 and v_e = 44.
constexpr double oil_nd = 1.5152354;
constexpr double oil_vd = 44.26741;

// Other names of built-in glasses, in the one case.
const std::vector<std::pair<std::string, std::string>> aliases = {
    {"SILICA", "FUSED-SILICA"}, {"F-SILICA", "FUSED-SILICA"}, {"SIO2", "FUSED-SILICA"}, {"AL2O3", "SAPPHIRE"},
    {"H2O", "WATER"},           {"OIL", "IMMERSION-OIL"}};

std::string in_one_case(std::string_view name) {
    std::string text(name);
    for (char& character : text) {
        if (character >= 'a' && character <= 'z') {
            character = static_cast<char>(character - 'a' + 'A');
        } else if (character == ' ' || character == '_') {
            character = '-';
        }
    }
    return text;
}

bool is_glass_code(std::string_view name) {
    return name.size() == 6 && std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

} // namespace

GlassCatalog GlassCatalog::builtin() {
    static const GlassCatalog catalog = [] {
        std::vector<Medium> media;
        for (const auto& glass : builtin_glasses()) {
            media.push_back(Medium::formula(glass.name, glass.formula, glass.coefficients, glass.minimum_um,
                                            glass.maximum_um, glass.source));
        }
        media.push_back(Medium::model("IMMERSION-OIL", oil_nd, oil_vd,
                                      "model glass of n_e = 1.518, v_e = 44: nominal oil of ISO 8036, 23 C"));
        GlassCatalog built;
        built.add(media);
        for (const auto& [alias, name] : aliases) {
            built.media_[alias] = built.media_.at(name);
        }
        return built;
    }();
    return catalog;
}

void GlassCatalog::add(const std::filesystem::path& agf) {
    add(read_agf(agf));
    files_.push_back(agf);
}

void GlassCatalog::add(const std::vector<Medium>& media) {
    std::set<std::string> added; // the first of a catalogue's names that are the same in one case
    for (const auto& medium : media) {
        if (auto name = in_one_case(medium.name); added.insert(name).second) {
            media_.insert_or_assign(std::move(name), medium);
        }
    }
}

std::optional<Medium> GlassCatalog::find(std::string_view name) const {
    const auto found = media_.find(in_one_case(name));
    return found == media_.end() ? std::nullopt : std::optional(found->second);
}

Medium GlassCatalog::get(std::string_view name) const {
    auto found = find(name);
    if (!found) {
        throw InputError({.where = {},
                          .key = "glass",
                          .found = fmt::format("\"{}\"", name),
                          .expected = fmt::format("the name of a glass of {}the built-in table",
                                                  files_.empty() ? "" : "the glass catalogues or "),
                          .remedy = remedy_for_unknown_glass(*this, name)});
    }
    return std::move(*found);
}

std::vector<std::string> GlassCatalog::names() const {
    std::vector<std::string> names;
    for (const auto& [key, medium] : media_) {
        names.push_back(medium.name);
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

std::optional<std::string> nearest_glass(const GlassCatalog& glasses, std::string_view name,
                                         const std::vector<std::string>& others) {
    std::map<std::string, std::string> known; // by the name in one case
    auto candidates = glasses.names();
    candidates.insert(candidates.end(), others.begin(), others.end());
    for (const auto& candidate : candidates) {
        known[in_one_case(candidate)] = candidate;
    }
    std::vector<std::string> keys;
    for (const auto& [key, candidate] : known) {
        keys.push_back(key);
    }
    const auto meant = nearest_word(in_one_case(name), keys);
    return meant ? std::optional(known[*meant]) : std::nullopt;
}

std::string remedy_for_unknown_glass(const GlassCatalog& glasses, std::string_view name,
                                     const std::vector<std::string>& others) {
    if (is_glass_code(name)) {
        return fmt::format("If a model glass is meant, describe it in [media.{}] by nd = 1.{} and vd = {}.{}.", name,
                           name.substr(0, 3), name.substr(3, 2), name.substr(5));
    }
    const auto meant = nearest_glass(glasses, name, others);
    return fmt::format("{}Correct the name, describe the medium in [media.{}], or add its catalogue to "
                       "glass_catalogs.",
                       meant ? fmt::format("Did you mean \"{}\"? ", *meant) : "", name);
}

} // namespace vkfv::optics
