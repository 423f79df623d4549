#include "optics/waves/pupil_filter.hpp"

#include "core/mathematics/units.hpp"
#include "core/threads/parallel_list.hpp"
#include "optics/instrument/image_quality.hpp"
#include "optics/waves/filter_error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::optics {

namespace {

using Complex = std::complex<double>;

double shortest_wavelength(std::span<const SpectralNode> nodes) {
    const auto least = std::ranges::min_element(nodes, {}, &SpectralNode::wavelength_um);
    return least->wavelength_um / um_per_mm;
}

} // namespace

int parts_for_waves(const Instrument& instrument) {
    const double pitch =
        shortest_wavelength(spectral_nodes(instrument)) / (4 * instrument.first_order.numerical_aperture);
    return std::max(1, static_cast<int>(std::ceil(instrument.first_order.pixel_pitch / pitch * (1 - 1e-9))));
}

int parts_of(const WaveOptions& options, const Instrument& instrument) {
    return options.parts > 0 ? options.parts : parts_for_waves(instrument);
}

WaveOptions resolved(const WaveOptions& options, const Instrument& instrument) {
    WaveOptions all = options;
    all.parts = parts_of(options, instrument);
    if (options.cells == 0 || options.tiles == 0) {
        const PupilFilter filter = filter_for_waves(instrument, options);
        all.cells = static_cast<int>(filter.cells().side);
        all.tiles = filter.tiles().across();
    }
    return all;
}

PupilFilter::PupilFilter(const Instrument& instrument, const WaveOptions& options)
    : PupilFilter(filter_for_waves(instrument, options)) {
    set_parts(instrument, parts_of(options, instrument));
}

void PupilFilter::set_parts(const Instrument& instrument, int parts) {
    cells_.parts = static_cast<std::uint32_t>(parts);
    part_pitch_ = instrument.first_order.pixel_pitch / cells_.parts;
    parted_ = true;
}

PupilFilter::PupilFilter(CellTransfer transfer, const Instrument& instrument)
    : cells_(transfer.cells()), part_pitch_(instrument.first_order.pixel_pitch),
      magnification_(instrument.first_order.magnification),
      made_(new Made{.axis = std::make_shared<const CellTransfer>(std::move(transfer))}) {}

PupilFilter PupilFilter::tiled(const Instrument& instrument, int tiles) const {
    PupilFilter filter = *this;
    filter.tiles_ = FieldTiles(instrument, tiles);
    filter.known_errors_ = {};
    filter.made_.reset(new Made{.axis = made_->axis});
    if (tiles > 1) {
        filter.made_->field = std::make_unique<const FieldTransfer>(instrument, *made_->axis, filter.tiles_);
    }
    return filter;
}

PupilFilter PupilFilter::unparted(const Instrument& instrument, std::vector<Wavefront> wavefronts, int cells) {
    return {CellTransfer(instrument, std::move(wavefronts), cells), instrument};
}

PupilFilter PupilFilter::unparted(const Instrument& instrument, int cells) {
    return unparted(instrument, wavefronts_for_cells(instrument), cells);
}

const std::vector<std::complex<float>>& PupilFilter::table() const {
    std::call_once(made_->table_once,
                   [&] { made_->table = made_->field ? made_->field->table() : made_->axis->table(); });
    return made_->table;
}

double PupilFilter::noise() const {
    if (parted_) {
        std::call_once(made_->noise_once, [&] { made_->noise = noise_of_pixels(); });
    }
    return made_->noise;
}

int PupilFilter::mirrored(int cell) const {
    const int side = static_cast<int>(cells_.side);
    return cell / side * side + side - 1 - cell % side;
}

int PupilFilter::mirrored_upright(int cell) const {
    const int side = static_cast<int>(cells_.side);
    return (side - 1 - cell / side) * side + cell % side;
}

TileTransfers PupilFilter::tile_transfers(int tile) const {
    const auto plane = static_cast<std::size_t>((2 * steps() + 1) * (steps() + 1));
    const std::size_t count = static_cast<std::size_t>(cell_count()) * plane;
    return {std::span(table()).subspan(static_cast<std::size_t>(tile) * count, count), plane, steps(), cutoff()};
}

std::complex<double> PupilFilter::transfer(int tile, int cell, double fx, double fy) const {
    const TileTransfers transfers = tile_transfers(tile);
    return transfers.at(cell, transfers.place(fx, fy));
}

std::vector<std::complex<double>> PupilFilter::transfers(glm::dvec2 detector_point, double fx, double fy) const {
    if (!made_->field) {
        return transfers(fx, fy);
    }
    std::vector<Complex> sum(static_cast<std::size_t>(cell_count()));
    for (const auto& [tile, weight] : tiles_.shares(detector_point / magnification_)) {
        const auto own = made_->field->at(tile, fx, fy);
        for (std::size_t cell = 0; cell < sum.size(); ++cell) {
            sum[cell] += weight * own[cell];
        }
    }
    return sum;
}

double PupilFilter::folded_contrast() const {
    constexpr int samples = 48; // from the axis to the cutoff
    const double sampling = 1 / part_pitch_;
    const double pixel_pitch = part_pitch_ * cells_.parts;
    const auto folded = [sampling](double f) { return f - sampling * std::round(f / sampling); };
    const auto sinc = [](double x) { return x == 0 ? 1.0 : std::sin(pi * x) / (pi * x); };
    if (const double highest = cutoff() * (samples - 1) / samples; folded(highest) == highest) {
        return 0; // avoids the table, which takes far longer
    }
    const TileTransfers transfers = tile_transfers(middle_tile());
    double largest = 0;
    for (int j = 0; j < samples; ++j) {
        for (int i = -samples + 1; i < samples; ++i) {
            const double fx = cutoff() * i / samples;
            const double fy = cutoff() * j / samples;
            if (folded(fx) == fx && folded(fy) == fy) {
                continue;
            }
            const TablePlace folded_place = transfers.place(folded(fx), folded(fy));
            const TablePlace place = transfers.place(fx, fy);
            double difference = 0;
            for (int cell = 0; cell < cell_count(); ++cell) {
                difference += share(cell) * std::abs(transfers.at(cell, folded_place) - transfers.at(cell, place));
            }
            largest = std::max(largest, difference * std::abs(sinc(fx * pixel_pitch) * sinc(fy * pixel_pitch)));
        }
    }
    return largest;
}

double PupilFilter::noise_of_pixels() const {
    // Noise is white over the parts of pixels. After the filter it is summed over the sensitive parts; before, over the
    // whole pixel.
    constexpr int samples = 48; // over half the band
    const int parts = static_cast<int>(cells_.parts);
    const auto added_up = [&](double f, bool all) { // f: cycles per part
        Complex sum = 0;
        for (int part = 0; part < parts; ++part) {
            const double share = all ? 1 : physics::f64::sensitive_share(cells_, static_cast<std::uint32_t>(part));
            sum += std::polar(share, 2 * pi * f * part);
        }
        return std::norm(sum);
    };
    struct Power {
        double before = 0;
        double after = 0;
    };
    const TileTransfers transfers = tile_transfers(middle_tile());
    const auto rows = parallel_list(2 * samples, [&](int row) {
        Power power;
        const double fy = 0.5 * (row - samples + 0.5) / samples;
        for (int i = -samples; i < samples; ++i) {
            const double fx = 0.5 * (i + 0.5) / samples;
            power.before += added_up(fx, true) * added_up(fy, true);
            const double pixel = added_up(fx, false) * added_up(fy, false);
            const TablePlace place = transfers.place(fx / part_pitch_, fy / part_pitch_);
            for (int cell = 0; cell < cell_count(); ++cell) {
                if (share(cell) > 0) {
                    power.after += pixel * share(cell) * std::norm(transfers.at(cell, place));
                }
            }
        }
        return power;
    });
    Power all;
    for (const Power& row : rows) {
        all.before += row.before;
        all.after += row.after;
    }
    return std::sqrt(all.after / all.before);
}

} // namespace vkfv::optics
