// Compares what vkfv reads of real surface files with what Gwyddion reads of them and, for those named here, with
// published figures. The files are given by their folder and belong to others: tests/acceptance/check_surfaces FOLDER.
#include "core/mathematics/units.hpp"
#include "gwyddion/gwyddion.hpp"
#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface/hybrid_parameters.hpp"
#include "surface_files/surface_file.hpp"

#include <libprocess/stats.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace {

using namespace vkfv;

// The roundings on the way from metres to mm and back, as a share of a metre.
constexpr double same_height = 1e-15;
constexpr double six_digits = 5e-7;

// Gwyddion 2.62's figures of the valid points in um; for the Ski file only Sa and Sq are known, of the raw heights.
struct Figures {
    const char* name;
    int columns, rows, gaps;
    double sa, sq, ssk, sku, sq_levelled; // 0: not known
};
constexpr Figures published[] = {
    {"KautschukInfiniteFocus.x3p", 860, 634, 5296, 2.705277, 3.398872, 0.732665, 3.686634, 3.398380},
    {"SkiInfiniteFocus.x3p", 1197, 940, 4272, 15.23741, 18.15497, 0, 0, 0}};

int failures = 0;

void check(bool good, const std::string& what) {
    fmt::print("  {} {}\n", good ? "ok    " : "FAILED", what);
    failures += good ? 0 : 1;
}

int gaps_of(const surface::HeightMap& map) {
    return static_cast<int>(std::ranges::count_if(map.height.values, [](double z) { return !std::isfinite(z); }));
}

// Checks a figure to half a unit of the sixth digit of a rounded one.
void check_figure(const char* name, double found, double expected) {
    const double half = 5 * std::pow(10.0, std::floor(std::log10(std::abs(expected))) - 6);
    check(std::abs(found - expected) <= half, fmt::format("{} {:.7g}, expected {:.7g}", name, found, expected));
}

void check_published(const Figures& figures, const surface::HeightMap& map) {
    check(map.columns() == figures.columns && map.rows() == figures.rows && gaps_of(map) == figures.gaps,
          fmt::format("{} x {} points, {} not measured, expected", figures.columns, figures.rows, figures.gaps));
    const auto raw = surface::height_parameters(map);
    check_figure("Sa um", raw.sa * um_per_mm, figures.sa);
    check_figure("Sq um", raw.sq * um_per_mm, figures.sq);
    if (figures.ssk != 0)
        check_figure("Ssk", raw.ssk, figures.ssk);
    if (figures.sku != 0)
        check_figure("Sku", raw.sku, figures.sku);
    if (figures.sq_levelled != 0) {
        const auto levelled = surface::height_parameters(remove_plane(map, surface::least_squares_plane(map)));
        check_figure("Sq um, levelled", levelled.sq * um_per_mm, figures.sq_levelled);
    }
}

// Heights and mask of the first channel of lengths: MetroPro's and Wyko's files may begin with intensities.
std::pair<GwyDataField*, GwyDataField*> heights_in_gwyddion(const test::GwyddionFile& loaded) {
    for (int channel = 0; channel < 8; ++channel) {
        GwyDataField* field = test::gwyddion_field(loaded, fmt::format("/{}/data", channel).c_str());
        if (field && gwy_si_unit_equal_string(gwy_data_field_get_si_unit_z(field), "m"))
            return {field, test::gwyddion_field(loaded, fmt::format("/{}/mask", channel).c_str())};
    }
    return {};
}

void check_against_gwyddion(const std::filesystem::path& file, const surface::HeightMap& map) {
    const auto loaded = test::load_in_gwyddion(file);
    const auto [heights, mask] = heights_in_gwyddion(loaded);
    const bool same_size =
        heights && gwy_data_field_get_xres(heights) == map.columns() && gwy_data_field_get_yres(heights) == map.rows();
    check(same_size, fmt::format("Gwyddion's {} has the same size", test::gwyddion_import(file)));
    if (!same_size)
        return;
    check(std::abs(gwy_data_field_get_dx(heights) * 1e3 / map.pitch_x - 1) < six_digits &&
              std::abs(gwy_data_field_get_dy(heights) * 1e3 / map.pitch_y - 1) < six_digits,
          fmt::format("and pitch: {:.9g} x {:.9g} um", gwy_data_field_get_dx(heights) * 1e6,
                      gwy_data_field_get_dy(heights) * 1e6));
    int masked = 0, other_mask = 0;
    double largest = 0;
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column) {
            const int line = map.rows() - 1 - row;
            const double metres = gwy_data_field_get_val(heights, column, line), mm = map.height(column, row);
            const bool gap = mask && gwy_data_field_get_val(mask, column, line) > 0;
            masked += gap ? 1 : 0;
            other_mask += mask && gap == std::isfinite(mm) ? 1 : 0;
            if (!gap && std::isfinite(mm)) {
                largest = std::max(largest, std::abs(metres * 1e3 - mm));
                lowest = std::min(lowest, mm);
                highest = std::max(highest, mm);
            }
        }
    check(other_mask == 0, fmt::format("{} points masked there, {} not measured here", masked, gaps_of(map)));
    check(largest <= same_height * 1e3 + 1e-7 * (highest - lowest),
          fmt::format("heights from {:.6f} to {:.6f} um differ by at most {:.3g} um", lowest * um_per_mm,
                      highest * um_per_mm, largest * um_per_mm));
}

// The most by which Gwyddion's triangles, which meet at a cell's mean height, have a smaller Sdr than those of the
// diagonals: opposite edges are averaged there, and the excess of an area is at most half of the squared slope.
double less_by_triangles(const surface::HeightMap& map) {
    double sum = 0, cells = 0;
    for (int row = 0; row + 1 < map.rows(); ++row)
        for (int column = 0; column + 1 < map.columns(); ++column) {
            const double twist = map.height(column, row) - map.height(column + 1, row) - map.height(column, row + 1) +
                                 map.height(column + 1, row + 1);
            if (!std::isfinite(twist))
                continue;
            sum += twist * twist * (1 / (map.pitch_x * map.pitch_x) + 1 / (map.pitch_y * map.pitch_y)) / 16;
            cells += 1;
        }
    return sum / cells;
}

// Gwyddion takes one mean of all squared differences, not one along either axis: they are apart by at most the share by
// which there are more of the one.
double uneven_pairs(const surface::HeightMap& map) {
    double along_x = 0, along_y = 0;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column) {
            const double z = map.height(column, row);
            along_x += column > 0 && std::isfinite(z - map.height(column - 1, row)) ? 1 : 0;
            along_y += row > 0 && std::isfinite(z - map.height(column, row - 1)) ? 1 : 0;
        }
    return std::abs(along_x - along_y) / (along_x + along_y);
}

// Compares every parameter that both have. Gwyddion's area has half a level cell more around the map, and other
// triangles; the others are sums over the same points.
void check_parameters(const std::filesystem::path& file, const surface::HeightMap& map) {
    constexpr double same_sum = 1e-10;
    const auto loaded = test::load_in_gwyddion(file);
    const auto [heights, mask] = heights_in_gwyddion(loaded);
    const auto masking = mask ? GWY_MASK_EXCLUDE : GWY_MASK_IGNORE;
    const int columns = map.columns(), rows = map.rows();
    double mean, sa, sq, skewness, excess, lowest, highest;
    gwy_data_field_area_get_stats_mask(heights, mask, masking, 0, 0, columns, rows, &mean, &sa, &sq, &skewness,
                                       &excess);
    gwy_data_field_area_get_min_max_mask(heights, mask, masking, 0, 0, columns, rows, &lowest, &highest);
    double measured = 0;
    for (const double height : map.height.values)
        measured += std::isfinite(height) ? 1 : 0;
    const double area = measured * gwy_data_field_get_dx(heights) * gwy_data_field_get_dy(heights);
    const double sdr =
        gwy_data_field_area_get_surface_area_mask(heights, mask, masking, 0, 0, columns, rows) / area - 1;
    const double sdq = gwy_data_field_area_get_surface_slope_mask(heights, mask, masking, 0, 0, columns, rows);
    const auto ours = surface::height_parameters(map);
    const auto hybrid = surface::hybrid_parameters(map);
    // Heights are rounded at their offset, here and there in another unit; a mean of them moves by some of it, and Ssk,
    // which may be near 0, by three times as much in units of Sq.
    const double rounding = 8 * std::numeric_limits<double>::epsilon() * std::abs(mean) / sq;
    const auto compare = [](const char* name, double found, double expected, double tolerance) {
        const double apart = std::abs(found / expected - 1);
        check(apart <= tolerance,
              fmt::format("{:<6} {:>14.8g}, Gwyddion {:>14.8g}, {:.1e} apart", name, found, expected, apart));
    };
    compare("Sq um", ours.sq * um_per_mm, sq * 1e6, same_sum);
    compare("Ssk", ours.ssk, skewness, same_sum + rounding / std::abs(skewness));
    compare("Sku", ours.sku, excess + 3, same_sum);
    compare("Sp um", ours.sp * um_per_mm, (highest - mean) * 1e6, same_sum);
    compare("Sv um", ours.sv * um_per_mm, (mean - lowest) * 1e6, same_sum);
    compare("Sz um", ours.sz * um_per_mm, (highest - lowest) * 1e6, same_sum);
    compare("Sa um", ours.sa * um_per_mm, sa * 1e6, same_sum);
    const double pitch = std::min(map.pitch_x, map.pitch_y);
    compare("Sdq", hybrid.sdq, sdq, same_sum + uneven_pairs(map) + rounding * ours.sq / (hybrid.sdq * pitch));
    compare("Sdr", hybrid.sdr, sdr,
            0.01 + 1.0 / map.columns() + 1.0 / map.rows() + less_by_triangles(map) / hybrid.sdr);
}

} // namespace

int main(int argument_count, char** arguments) {
    if (argument_count != 2) {
        fmt::print(stderr, "usage: check_surfaces FOLDER\n");
        return 2;
    }
    test::start_gwyddion();
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(arguments[1]))
        files.push_back(entry.path());
    std::ranges::sort(files);
    for (const auto& file : files) {
        try {
            const auto surface = surface::read_surface(file);
            const auto parameters = surface::height_parameters(surface.map);
            fmt::print("{}: {} x {} points, pitch {:.9g} x {:.9g} um, {} not measured, Sa {:.7g} um, Sq {:.7g} um; by "
                       "{} {}, {}\n",
                       file.filename().string(), surface.map.columns(), surface.map.rows(),
                       surface.map.pitch_x * um_per_mm, surface.map.pitch_y * um_per_mm, gaps_of(surface.map),
                       parameters.sa * um_per_mm, parameters.sq * um_per_mm, surface.provenance.manufacturer,
                       surface.provenance.model, surface.provenance.date);
            if (file.extension() == ".nms") { // which Gwyddion 2.62 takes for another format
                fmt::print("  not read by Gwyddion\n");
                continue;
            }
            check_against_gwyddion(file, surface.map);
            check_parameters(file, surface.map);
            for (const Figures& figures : published)
                if (file.filename() == figures.name)
                    check_published(figures, surface.map);
        } catch (const std::exception& error) {
            check(false, error.what());
        }
    }
    fmt::print("{} files, {} failures\n", files.size(), failures);
    return files.empty() || failures > 0 ? 1 : 0;
}
