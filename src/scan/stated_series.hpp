// Statements of a file of several images about them: how its pages are counted, and lengths.
#pragma once

#include "images/image_file.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::scan {

// Lengths in mm. Sources are ImageJ's description (ij.io.TiffDecoder and FileInfo), OME-XML (schema 2016-06), or else
// the resolution tags of TIFF 6.0. The date is OME-XML's AcquisitionDate, else that of TIFF or Exif.
struct StatedSeries {
    static constexpr int uncounted = 0; // number of pages that is not to be checked

    std::string z_by{};                         // source of the heights, if it differs from `by`
    std::string by{};                           // "ImageJ's description", ...; empty: nothing is stated
    std::optional<double> pitch_x{}, pitch_y{}; // pixel pitch on the specimen
    std::optional<double> z_step{};             // from one height to the next; negative: they descend
    std::optional<double> z_start{};            // height of the first image
    int channels = 1;                           // pages of each height in different light
    int frames = 1;                             // repetitions of all channels and heights at different times
    int heights = 0;                            // pages of one channel and frame
    std::vector<int> pages{};                   // by (height * channels + channel) * frames + frame: page in the file
    std::vector<std::string> doubts{};          // sentences: statements that are not used, and why
    std::string date{};                         // time of the images, xsd:dateTime; empty: not stated

    int page(int height, int channel, int frame) const {
        return pages.at(static_cast<std::size_t>((height * channels + channel) * frames + frame));
    }
};

// The statements of a file with so many pages; uncounted: lengths alone. Throws InputError if the pages are not those
// that it states.
StatedSeries stated_series(const images::ImageStatement& statement, int pages, const std::filesystem::path& file);

} // namespace vkfv::scan
