// A stack of images that another instrument or program wrote: the pages of one file, or the files of a folder.
#pragma once

#include "core/mathematics/grid.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::scan {

class ImageSeries {
  public:
    // A multi-page image file; or a folder, whose image files (by their extension, hidden ones left out) are taken in
    // the order of image_order.hpp, with a warning where that is in doubt, one page each. Throws InputError for a path
    // without images.
    explicit ImageSeries(const std::filesystem::path& path);

    int size() const { return static_cast<int>(images_.size()); }
    // "z_0007.tif", "stack.tif, page 7"; pages count from 0.
    std::string name(int image) const;
    // The channels of an image; integers keep their stored values. Throws InputError.
    std::vector<Grid<float>> read(int image) const;

  private:
    struct Place {
        std::filesystem::path file;
        int page;
    };
    std::vector<Place> images_;
};

} // namespace vkfv::scan
