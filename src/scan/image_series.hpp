// A stack of images by another instrument or program: the pages of one file, or the files of a folder.
#pragma once

#include "core/mathematics/grid.hpp"
#include "scan/stated_series.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::scan {

// The channel and the frame to take, from 1, of a file that has several. A file of one needs no choice.
struct SeriesChoice {
    std::optional<int> channel{};
    std::optional<int> frame{};
};

class ImageSeries {
  public:
    // path: a multi-page image file, whose pages are counted as it states; or a folder, whose image files (by their
    // extension, without hidden ones) are taken one page each at the heights of image_order.hpp, with a warning where
    // these are in doubt. Files that are unlike the others are left out, and missing images are replaced by the mean of
    // their neighbours, all with a warning. Throws InputError for a path without images, and for a file with several
    // channels or frames if none is chosen.
    explicit ImageSeries(const std::filesystem::path& path, const SeriesChoice& choice = {});

    // The statement of the file, or of the first file in a folder.
    const StatedSeries& stated() const { return stated_; }

    int size() const { return static_cast<int>(images_.size()); }
    // Name for messages: "z_0007.tif", "stack.tif, page 7"; pages count from 0.
    std::string name(int image) const;
    // The channels of an image; integers keep their stored values. Throws InputError.
    std::vector<Grid<float>> read(int image) const;

  private:
    struct Place {
        std::filesystem::path file{}; // empty: missing, between two existing images
        int page = 0;
        int before = 0;
        int after = 0;
    };
    void take_folder(const std::filesystem::path& path);

    std::vector<Place> images_;
    StatedSeries stated_;
};

} // namespace vkfv::scan
