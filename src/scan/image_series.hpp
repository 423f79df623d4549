// A stack of images that another instrument or program wrote: the pages of one file, or the files of a folder.
#pragma once

#include "core/mathematics/grid.hpp"
#include "scan/stated_series.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::scan {

// The channel and the frame that are taken of a file of several, counted from 1. A file of one needs no choice.
struct SeriesChoice {
    std::optional<int> channel{};
    std::optional<int> frame{};
};

class ImageSeries {
  public:
    // A multi-page image file, whose pages are counted as it states; or a folder, whose image files (by their
    // extension, hidden ones left out) are taken one page each at the heights of image_order.hpp, with a warning where
    // those are in doubt. Files that are not like the others are left out, and images that are missing between others
    // are means of their neighbours, all with a warning. Throws InputError for a path without images, and for a file of
    // several channels or frames of which none is chosen.
    explicit ImageSeries(const std::filesystem::path& path, const SeriesChoice& choice = {});

    // The statement of the file, or of the first file in a folder.
    const StatedSeries& stated() const { return stated_; }

    int size() const { return static_cast<int>(images_.size()); }
    // "z_0007.tif", "stack.tif, page 7"; pages count from 0.
    std::string name(int image) const;
    // The channels of an image; integers keep their stored values. Throws InputError.
    std::vector<Grid<float>> read(int image) const;

  private:
    struct Place {
        std::filesystem::path file{}; // empty: missing, between two that are there
        int page = 0;
        int before = 0;
        int after = 0;
    };
    void take_folder(const std::filesystem::path& path);

    std::vector<Place> images_;
    StatedSeries stated_;
};

} // namespace vkfv::scan
