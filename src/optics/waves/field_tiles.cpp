#include "optics/waves/field_tiles.hpp"

#include "optics/instrument/image_quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <map>
#include <tuple>
#include <utility>

namespace vkfv::optics {

namespace {

using Complex = std::complex<double>;

// The tile before a place along a line, and the place's share of the distance to the next tile.
std::pair<int, double> along(double place, double half, int across) {
    if (across == 1 || half == 0) {
        return {across / 2, 0};
    }
    const double at = std::clamp(0.5 * (place / half + 1), 0.0, 1.0) * (across - 1);
    const int before = std::min(static_cast<int>(at), across - 2);
    return {before, at - before};
}

// The wavefronts at the height where the wavelength with most of the light has the least variance over the pupil.
std::vector<Wavefront> sharpest(std::vector<Wavefront> wavefronts) {
    const auto brightest = std::ranges::max_element(wavefronts, {}, &Wavefront::weight);
    const double height = brightest->sharpest_height();
    for (Wavefront& wavefront : wavefronts) {
        wavefront = wavefront.at_height(height);
    }
    return wavefronts;
}

bool is_dark(const std::vector<Wavefront>& wavefronts) {
    return std::ranges::any_of(wavefronts, [](const Wavefront& each) { return each.largest_rim() == 0; });
}

} // namespace

FieldTiles::FieldTiles(const Instrument& instrument, int across)
    : across_(across), half_field_(instrument.first_order.field_corner) {}

glm::dvec2 FieldTiles::point(int tile) const {
    if (across_ == 1) {
        return glm::dvec2(0);
    }
    return half_field_ * (2.0 * glm::dvec2(tile % across_, tile / across_) / (across_ - 1.0) - 1.0);
}

std::vector<FieldTiles::Share> FieldTiles::shares(glm::dvec2 field) const {
    const auto [column, right] = along(field.x, half_field_.x, across_);
    const auto [row, up] = along(field.y, half_field_.y, across_);
    std::vector<Share> all;
    for (const auto& [dx, dy, weight] : {std::tuple{0, 0, (1 - right) * (1 - up)},
                                         {1, 0, right * (1 - up)},
                                         {0, 1, (1 - right) * up},
                                         {1, 1, right * up}}) {
        if (weight > 0) {
            all.push_back({.tile = (row + dy) * across_ + column + dx, .weight = weight});
        }
    }
    return all;
}

FieldTransfer::FieldTransfer(const Instrument& instrument, const CellTransfer& axis, const FieldTiles& tiles)
    : side_(static_cast<int>(axis.cells().side)), steps_(axis.steps()) {
    const bool symmetric = imaging_of(instrument).symmetric;
    const glm::dvec2 half = instrument.first_order.field_corner;
    std::map<std::array<int, 2>, std::size_t> known; // key: distances from the axis in tiles
    std::vector<int> computed;                       // indices of tiles
    const int middle = tiles.across() / 2;
    for (int tile = 0; tile < tiles.count(); ++tile) {
        std::array<int, 2> place = {tile % tiles.across() - middle, tile / tiles.across() - middle};
        Image image;
        if (symmetric) {
            image.mirrored = place[0] < 0;
            image.upright = place[1] < 0;
            place = {std::abs(place[0]), std::abs(place[1])};
            image.swapped = half.x == half.y && place[1] > place[0];
            if (image.swapped) {
                std::swap(place[0], place[1]);
            }
        }
        const auto [found, is_new] = known.try_emplace(place, computed.size());
        image.of = found->second;
        images_.push_back(image);
        if (is_new) {
            computed.push_back((place[1] + middle) * tiles.across() + place[0] + middle);
        }
    }
    std::vector<std::future<std::unique_ptr<const CellTransfer>>> transfers; // run in parallel
    for (const int tile : computed) {
        transfers.push_back(std::async(std::launch::async, [&, tile] {
            auto wavefronts = wavefronts_for_cells(instrument, tiles.point(tile));
            if (is_dark(wavefronts)) {
                wavefronts = wavefronts_for_cells(instrument);
            }
            return std::make_unique<const CellTransfer>(axis, sharpest(std::move(wavefronts)));
        }));
    }
    for (auto& transfer : transfers) {
        computed_.push_back(transfer.get());
    }
}

// The cell of the computed point whose mirror image is the given cell of this point.
int FieldTransfer::cell_there(const Image& image, int cell) const {
    int column = cell % side_;
    int row = cell / side_;
    column = image.mirrored ? side_ - 1 - column : column;
    row = image.upright ? side_ - 1 - row : row;
    return image.swapped ? column * side_ + row : row * side_ + column;
}

std::vector<Complex> FieldTransfer::at(int tile, double fx, double fy) const {
    const Image& image = images_[static_cast<std::size_t>(tile)];
    const double x = image.mirrored ? -fx : fx;
    const double y = image.upright ? -fy : fy;
    const auto there = computed_[image.of]->at(image.swapped ? y : x, image.swapped ? x : y);
    std::vector<Complex> here(there.size());
    for (int cell = 0; cell < side_ * side_; ++cell) {
        here[static_cast<std::size_t>(cell)] = there[static_cast<std::size_t>(cell_there(image, cell))];
    }
    return here;
}

std::vector<std::complex<float>> FieldTransfer::table() const {
    std::vector<std::vector<std::complex<float>>> computed;
    for (const auto& transfer : computed_) {
        computed.push_back(transfer->table());
    }
    const int columns = 2 * steps_ + 1;
    const auto plane = static_cast<std::size_t>(columns * (steps_ + 1));
    std::vector<std::complex<float>> all;
    all.reserve(images_.size() * computed.front().size());
    for (const Image& image : images_) {
        const auto& there = computed[image.of];
        for (int cell = 0; cell < side_ * side_; ++cell) {
            const std::size_t first = static_cast<std::size_t>(cell_there(image, cell)) * plane;
            for (int dy = 0; dy <= steps_; ++dy) {
                for (int dx = -steps_; dx <= steps_; ++dx) {
                    const int across = image.mirrored ? -dx : dx;
                    const int up = image.upright ? -dy : dy;
                    const int x = image.swapped ? up : across;
                    const int y = image.swapped ? across : up;
                    const bool opposite = y < 0; // the table has no rows below 0
                    const auto place =
                        static_cast<std::size_t>((opposite ? -y : y) * columns + (opposite ? -x : x) + steps_);
                    all.push_back(opposite ? std::conj(there[first + place]) : there[first + place]);
                }
            }
        }
    }
    return all;
}

} // namespace vkfv::optics
