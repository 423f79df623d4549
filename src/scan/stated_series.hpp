// The statement that a file of several images makes of them: how its pages are counted, and lengths.
#pragma once

#include "images/image_file.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::scan {

// Lengths in mm. By ImageJ's description (ij.io.TiffDecoder and FileInfo), by OME-XML (schema 2016-06), else by the
// resolution tags of TIFF 6.0. The date is OME-XML's AcquisitionDate, else that of TIFF or Exif.
struct StatedSeries {
    static constexpr int uncounted = 0; // pages of a file whose others are not asked for

    std::string z_by{};                         // what states the heights, if it is another
    std::string by{};                           // "ImageJ's description", ...; empty: nothing is stated
    std::optional<double> pitch_x{}, pitch_y{}; // of the pixels on the specimen
    std::optional<double> z_step{};             // from one height to the next; negative: they descend
    std::optional<double> z_start{};            // of the first
    int channels = 1;                           // pages of each height, of other light
    int frames = 1;                             // repetitions of all of it, at other times
    int heights = 0;                            // pages of one channel and frame
    std::vector<int> pages{};                   // of (height * channels + channel) * frames + frame, in the file
    std::vector<std::string> doubts{};          // sentences: what is stated and not used, and why
    std::string date{};                         // when the images were taken, xsd:dateTime; empty: it is not stated

    int page(int height, int channel, int frame) const {
        return pages.at(static_cast<std::size_t>((height * channels + channel) * frames + frame));
    }
};

// Of a file with so many pages; uncounted: lengths alone. Throws InputError where the pages are not those that it
// states.
StatedSeries stated_series(const images::ImageStatement& statement, int pages, const std::filesystem::path& file);

} // namespace vkfv::scan
