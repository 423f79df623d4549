#include "surface/roughness_profile.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::surface {
namespace {

constexpr ProfileParameters no_parameters{};
constexpr double sections = 5;

// The middle part of a profile, with as many points as the length has.
Profile middle_of(const Profile& profile, double length) {
    const auto points =
        std::min(profile.height.size(), static_cast<std::size_t>(std::lround(length / profile.spacing)) + 1);
    const auto first = profile.height.begin() + static_cast<std::ptrdiff_t>((profile.height.size() - points) / 2);
    return {{first, first + static_cast<std::ptrdiff_t>(points)}, profile.spacing};
}

// Evaluates the profile by a setting class; false if the profile is too short.
bool take_class(RoughnessProfile& result, const SettingClass& setting) {
    const Profile& profile = result.profile;
    const double length = static_cast<double>(profile.height.size() - 1) * profile.spacing;
    result.setting_class = &setting;
    result.s_filter = setting.s_filter;
    result.l_filter = result.section_length = setting.l_filter;
    result.parameters = no_parameters;
    if (length < sections * setting.l_filter - 0.5 * profile.spacing)
        return false;
    const Profile roughness = remove_long_waves(gaussian_low_pass(profile, setting.s_filter), setting.l_filter);
    result.roughness = middle_of(roughness, sections * setting.l_filter);
    result.parameters = profile_parameters(result.roughness);
    return true;
}

void take_class_by_ra(RoughnessProfile& result) {
    for (const SettingClass& setting : setting_classes)
        if (!take_class(result, setting) || result.parameters.ra <= setting.greatest_ra)
            return;
    result.parameters = no_parameters; // rougher than the last class
}

} // namespace

ProfileLine middle_row(const HeightMap& map) {
    const double y = map.y(map.rows() / 2);
    return {.x_start = map.x(0), .y_start = y, .x_end = map.x(map.columns() - 1), .y_end = y};
}

RoughnessProfile roughness_profile(const HeightMap& map, const ProfileLine& line, const ProfileSetting& setting) {
    const double spacing = line.y_start == line.y_end   ? map.pitch_x
                           : line.x_start == line.x_end ? map.pitch_y
                                                        : std::min(map.pitch_x, map.pitch_y);
    RoughnessProfile result;
    result.profile = extract_profile(map, line.x_start, line.y_start, line.x_end, line.y_end, spacing);
    if (setting.kind == ProfileSetting::Kind::by_class) {
        take_class(result, setting_classes.at(setting.setting_class));
        return result;
    }
    if (setting.kind == ProfileSetting::Kind::by_ra) {
        take_class_by_ra(result);
        return result;
    }
    const auto points = result.profile.height.size();
    result.section_length = static_cast<double>(points - 1) * spacing / sections;
    result.l_filter =
        setting.kind == ProfileSetting::Kind::nesting_index ? setting.nesting_index : result.section_length;
    if (result.section_length <= spacing) // the filter would remove all of such a section
        return result;
    result.roughness = result.l_filter > 0 ? remove_long_waves(result.profile, result.l_filter) : result.profile;
    result.parameters = profile_parameters(result.roughness);
    return result;
}

} // namespace vkfv::surface
