// Extraction of a profile of a surface, and its roughness.
#pragma once

#include "surface/profile.hpp"

#include <array>
#include <string_view>

namespace vkfv::surface {

// A line in the map's frame, mm.
struct ProfileLine {
    double x_start = 0;
    double y_start = 0;
    double x_end = 0;
    double y_end = 0;
};

ProfileLine middle_row(const HeightMap& map);

// A setting class of ISO 21920-3:2021, table 1, chosen by Ra; lengths in mm. The evaluation length is five nesting
// indices of the L-filter.
struct SettingClass {
    std::string_view name;
    double greatest_ra;
    double s_filter, l_filter; // nesting indices
};

inline constexpr std::array<SettingClass, 5> setting_classes{{{"Sc1", 0.02e-3, 0.0025, 0.08},
                                                              {"Sc2", 0.1e-3, 0.0025, 0.25},
                                                              {"Sc3", 2e-3, 0.0025, 0.8},
                                                              {"Sc4", 10e-3, 0.008, 2.5},
                                                              {"Sc5", 80e-3, 0.025, 8}}};

// The filter of a profile, which follows the operations on its surface.
struct ProfileSetting {
    enum class Kind {
        fifth,         // L-filter of a fifth of the profile, for profiles too short for the standard's
        nesting_index, // L-filter of the given nesting index
        by_class,
        by_ra // the first class in whose range of Ra the profile is
    };
    Kind kind = Kind::fifth;
    double nesting_index = 0;      // mm; 0: no filter
    std::size_t setting_class = 0; // index into setting_classes
};

struct RoughnessProfile {
    Profile profile;                             // before the filter
    Profile roughness;                           // after the filter, over the evaluation length
    double s_filter = 0, l_filter = 0;           // nesting indices, mm; 0: none
    const SettingClass* setting_class = nullptr; // class of these nesting indices
    double section_length = 0;                   // mm
    // NaN if the profile has at most six points, or is too short or too rough for the classes
    ProfileParameters parameters;
};

// The profile along a line, with points one pitch apart: the pitch of the axis along which the line lies, else the
// shorter one. Roughness follows by the Gaussian filters of ISO 16610-21, over five sections (ISO 21920-2) of the whole
// profile, or of a class's evaluation length in its middle.
RoughnessProfile roughness_profile(const HeightMap& map, const ProfileLine& line, const ProfileSetting& setting = {});

} // namespace vkfv::surface
