#include "fields/interferometer.hpp"

#include "core/mathematics/fourier.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "core/threads/parallel_rows.hpp"
#include "fields/exposure_image.hpp"
#include "fields/facet.hpp"
#include "optics/instrument/image_quality.hpp"
#include "optics/media/spectrum.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

namespace vkfv::fields {

namespace {

constexpr double share_of_arm = 0.25; // light of either arm passes an ideal splitter of a half twice

[[noreturn]] void refuse(std::string key, std::string found, std::string expected, std::string remedy) {
    throw InputError({.where = {},
                      .key = std::move(key),
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

// Radius of the source's image over that of the pupil.
double source_fill_of(const optics::Instrument& instrument, const optics::InstrumentDescription& description) {
    const auto& source = description.source;
    if (source.ring || source.rectangle || !description.further_sources.empty()) {
        refuse("source.kind", "a ring light or a rectangle", "one disc with a [reference_arm]",
               "Give one source of kind \"disc\".");
    }
    const double radius = std::min(source.radius, description.illumination_aperture_radius.value_or(source.radius));
    return radius / instrument.first_order.pupil_radius_in_source;
}

std::vector<optics::Wavefront> wavefronts_of(const optics::Instrument& instrument, const optics::Spectrum& spectrum,
                                             double half_range) {
    const int wanted =
        spectrum.monochromatic() ? 1 : wavelengths_for(spectrum.shortest_um, spectrum.longest_um, half_range);
    auto wavefronts = optics::wavefronts_of(
        instrument, optics::spectral_nodes(spectrum.bins, spectrum.centre(), spectrum.half_width(), wanted));
    for (const auto& wavefront : wavefronts) {
        if (!wavefront.round()) {
            refuse("objective", "a displaced part",
                   "an instrument that is symmetric about its axis with a "
                   "[reference_arm]",
                   "Take the displacement out.");
        }
    }
    return wavefronts;
}

// The mean over each pixel of values on the grid, which are means over its cells.
template <class Value, class Result>
void bin(const Grid<Value>& values, const FieldGrid& grid, Grid<Result>& pixels) {
    parallel_rows(pixels.columns, pixels.rows, [&](int first, int end) {
        for (int row = first; row < end; ++row) {
            for (int column = 0; column < pixels.columns; ++column) {
                Value sum{};
                for (int j = 0; j < grid.parts; ++j) {
                    for (int i = 0; i < grid.parts; ++i) {
                        sum += values(grid.margin_x + column * grid.parts + i, grid.margin_y + row * grid.parts + j);
                    }
                }
                pixels(column, row) = static_cast<Result>(sum / static_cast<double>(grid.parts * grid.parts));
            }
        }
    });
}

double disc_overlap(double first, double second, double apart) { // area
    if (first <= 0 || second <= 0 || apart >= first + second) {
        return 0;
    }
    if (apart <= std::abs(first - second)) {
        return pi * std::min(first, second) * std::min(first, second);
    }
    const auto angle = [&](double one, double other) {
        return std::acos(std::clamp((apart * apart + one * one - other * other) / (2 * apart * one), -1.0, 1.0));
    };
    const double a = angle(first, second), b = angle(second, first);
    return first * first * (a - std::sin(2 * a) / 2) + second * second * (b - std::sin(2 * b) / 2);
}

// The image by the object's arm alone, 1 of a level surface without loss: the share of the light that a surface's slope
// reflects into the pupil, with the contrast that incoherent waves leave.
Grid<double> object_image(const SampledSurface& surface, const FacetLight& facets, double cutoff) {
    const FieldGrid& grid = surface.grid;
    Grid<std::complex<double>> image(grid.columns, grid.rows);
    parallel_rows(grid.columns, grid.rows, [&](int first, int end) {
        for (int row = first; row < end; ++row) {
            for (int column = 0; column < grid.columns; ++column) {
                image(column, row) = surface.amplitude(column, row) * surface.amplitude(column, row) *
                                     facets.share(glm::length(surface.slopes(column, row)));
            }
        }
    });
    fourier_transform(image);
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const double f =
                std::hypot(fourier_frequency(column, grid.columns), fourier_frequency(row, grid.rows)) / grid.pitch;
            image(column, row) *= disc_overlap(1, 1, 2 * f / cutoff) / pi;
        }
    }
    inverse_fourier_transform(image);
    Grid<double> result(grid.columns, grid.rows);
    std::ranges::transform(image.values, result.values.begin(),
                           [](const std::complex<double>& value) { return value.real(); });
    return result;
}

} // namespace

void require_in_range(FocalRange range, trace::FocalPosition position) {
    if (position.height < range.lowest || position.height > range.highest) {
        throw RunError(fmt::format("the focal height {:.6g} um lies beyond the fields' range, {:.6g} to {:.6g} um",
                                   position.height * um_per_mm, range.lowest * um_per_mm, range.highest * um_per_mm));
    }
    if (position.beside != glm::dvec2(0)) {
        throw RunError("fields of an interferometer hold for a specimen that stands still sideways");
    }
}

trace::Image exposure_image(const FringeFields& fields, Grid<double> flux) {
    using Status = trace::Ledger::Status;
    trace::Image image;
    image.standard_error = Grid<double>(flux.columns, flux.rows);
    const double detected = std::accumulate(flux.values.begin(), flux.values.end(), 0.0);
    image.flux = std::move(flux);
    image.ledger.emitted = fields.emitted;
    image.ledger.entries = {
        {.name = "detected", .power = detected, .status = Status::detected},
        {.name = "not in the image", .power = fields.emitted - detected, .status = Status::beside_detector}};
    return image;
}

namespace {

class HostInterferometer final : public trace::Tracer {
  public:
    HostInterferometer(FringeFields fields, FocalRange range, trace::TracerIdentity identity)
        : fields_(std::move(fields)), range_(range), identity_(std::move(identity)) {}

    trace::Image expose(trace::FocalPosition position, std::uint32_t /*image*/) const override {
        const auto begun = std::chrono::steady_clock::now();
        require_in_range(range_, position);
        Grid<double> flux(fields_.pixels.columns, fields_.pixels.rows);
        add_fringes(position.height, flux);
        trace::Image image = exposure_image(fields_, std::move(flux));
        image.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
        return image;
    }
    std::string description() const override {
        return fmt::format("host, fields of {} wave numbers", fields_.wave_numbers.size());
    }
    trace::TracerIdentity identity() const override { return identity_; }

  private:
    // Sums over the nodes in a fixed order, in blocks of pixels that stay in the cache.
    void add_fringes(double height, Grid<double>& flux) const {
        constexpr std::size_t block = 64;
        std::vector<std::pair<float, float>> phases;
        for (const double q : fields_.wave_numbers) {
            const double phase = q * (height - fields_.height_offset);
            phases.emplace_back(std::cos(phase), std::sin(phase));
        }
        const std::size_t count = flux.values.size();
        const int blocks = static_cast<int>((count + block - 1) / block);
        parallel_bands(blocks, 16, [&](int first, int end) {
            for (int number = first; number < end; ++number) {
                const std::size_t from = static_cast<std::size_t>(number) * block, to = std::min(count, from + block);
                std::array<float, block> sums{};
                for (std::size_t node = 0; node < phases.size(); ++node) {
                    const std::complex<float>* const values = fields_.nodes[node].values.data() + from;
                    const auto [cosine, sine] = phases[node];
                    for (std::size_t k = 0; k < to - from; ++k) {
                        sums[k] += cosine * values[k].real() - sine * values[k].imag();
                    }
                }
                for (std::size_t k = from; k < to; ++k) {
                    // Rounding, and the object's image by rays, may leave less than nothing in a dark fringe.
                    flux.values[k] = std::max(0.0, static_cast<double>(fields_.background.values[k]) +
                                                       fields_.signal * static_cast<double>(sums[k - from]));
                }
            }
        });
    }

    FringeFields fields_;
    FocalRange range_;
    trace::TracerIdentity identity_;
};

} // namespace

FringeBand fringe_band(const optics::Spectrum& spectrum, double numerical_aperture, double index) {
    const auto twice_k = [](double um) { return 4 * pi / (um * mm_per_um); };
    return {.least = twice_k(spectrum.longest_um) * std::sqrt(index * index - numerical_aperture * numerical_aperture),
            .most = twice_k(spectrum.shortest_um) * index};
}

SampledSurface surface_of(const optics::Instrument& instrument, const optics::InstrumentDescription& description,
                          const specimen::Specimen& specimen) {
    const auto& spectrum = description.spectrum;
    const double aperture = instrument.first_order.numerical_aperture;
    return sample_surface(specimen,
                          field_grid(description.detector_pixels, instrument.first_order.pixel_pitch,
                                     2 * aperture / (spectrum.shortest_um * mm_per_um)),
                          spectrum.reference_um, std::min(0.999, aperture / instrument.first_order.object_index));
}

FieldParts field_parts(const optics::Instrument& instrument, const optics::InstrumentDescription& description,
                       const specimen::Specimen& specimen, const ReferenceArm& arm, FocalRange range) {
    const double fill = source_fill_of(instrument, description), lit_share = std::min(1.0, fill);
    const auto& spectrum = description.spectrum;
    const double aperture = instrument.first_order.numerical_aperture, pitch = instrument.first_order.pixel_pitch;
    SampledSurface surface = surface_of(instrument, description, specimen);
    const FieldGrid grid = surface.grid;
    log_warnings(warnings_of(surface));
    const double aside = glm::length(arm.tilt) * pitch * std::hypot(grid.pixels.columns, grid.pixels.rows) / 2;
    const double half_range = (range.highest - range.lowest + surface.highest - surface.lowest) / 2 + aside +
                              0.5 * spectrum.reference_um * mm_per_um;
    const double middle_height = (surface.highest + surface.lowest) / 2, middle = (range.highest + range.lowest) / 2;
    const auto wavefronts = wavefronts_of(instrument, spectrum, half_range);
    FringeTransfer transfer(wavefronts, arm, fill, middle - middle_height, half_range, spectrum.reference_um);
    spdlog::debug("fields: {} x {} points, {} wavelengths, {} wave numbers", grid.columns, grid.rows, wavefronts.size(),
                  transfer.nodes());

    FringeFields fields{.pixels = grid.pixels, .wave_numbers = {}, .nodes = {}, .background = {}};
    fields.height_offset = middle;
    fields.emitted = description.source.flux;
    // The flux of a pixel by the etendue of the lit pupil and the source's radiance, with no loss but the splitter's.
    const double rim = wavefronts.front().rim(0), dark = rim * arm.obscuration, lit = rim * lit_share;
    const double radiance = description.source.flux / (pi * pi * description.source.radius * description.source.radius);
    const double of_pixel = radiance * pitch * pitch * pi * (lit * lit - dark * dark) *
                            instrument.splitter_reflectance * instrument.splitter_transmittance * share_of_arm;
    fields.signal = 2 * of_pixel * std::sqrt(arm.reflectance);
    const FacetLight facets(rim, lit, dark, instrument.first_order.object_index);
    const Grid<double> object = object_image(surface, facets, 2 * aperture / (spectrum.reference_um * mm_per_um));
    fields.background = Grid<float>(grid.pixels.columns, grid.pixels.rows);
    bin(object, grid, fields.background);
    for (float& value : fields.background.values) {
        value = static_cast<float>(of_pixel * (arm.reflectance + static_cast<double>(value)));
    }

    for (std::size_t k = 0; k < surface.slopes.values.size(); ++k) {
        surface.amplitude.values[k] *= facets.amplitude(glm::length(surface.slopes.values[k]));
    }
    for (int node = 0; node < transfer.nodes(); ++node) {
        fields.wave_numbers.push_back(transfer.wave_number(node));
    }
    return {.surface = std::move(surface),
            .transfer = std::move(transfer),
            .fields = std::move(fields),
            .middle_height = middle_height,
            .tilt = arm.tilt};
}

void add_nodes(FieldParts& parts) {
    const SampledSurface& surface = parts.surface;
    const FringeTransfer& transfer = parts.transfer;
    const double middle_height = parts.middle_height;
    const glm::dvec2 tilt = parts.tilt;
    const FieldGrid& grid = surface.grid;
    Grid<std::complex<double>> waves(grid.columns, grid.rows);
    for (int node = 0; node < transfer.nodes(); ++node) {
        const double q = transfer.wave_number(node);
        reflect(surface, q, middle_height, waves);
        fourier_transform(waves);
        parallel_rows(grid.columns, grid.rows, [&](int first, int end) {
            for (int row = first; row < end; ++row) {
                for (int column = 0; column < grid.columns; ++column) {
                    const double x = fourier_frequency(column, grid.columns), y = fourier_frequency(row, grid.rows);
                    const std::complex<double> of_frequency = transfer.at(node, std::hypot(x, y) / grid.pitch);
                    waves(column, row) *= of_frequency;
                }
            }
        });
        inverse_fourier_transform(waves);
        if (tilt != glm::dvec2(0)) {
            const double x0 = -(grid.margin_x + 0.5 * (grid.pixels.columns * grid.parts - 1));
            const double y0 = -(grid.margin_y + 0.5 * (grid.pixels.rows * grid.parts - 1));
            for (int row = 0; row < grid.rows; ++row) {
                for (int column = 0; column < grid.columns; ++column) {
                    const glm::dvec2 place = grid.pitch * glm::dvec2(x0 + column, y0 + row);
                    waves(column, row) *= std::polar(1.0, q * glm::dot(tilt, place));
                }
            }
        }
        bin(waves, grid, parts.fields.nodes.emplace_back(grid.pixels.columns, grid.pixels.rows));
    }
}

FringeFields fringe_fields(const optics::Instrument& instrument, const optics::InstrumentDescription& description,
                           const specimen::Specimen& specimen, const ReferenceArm& arm, FocalRange range) {
    FieldParts parts = field_parts(instrument, description, specimen, arm, range);
    add_nodes(parts);
    return std::move(parts.fields);
}

std::unique_ptr<trace::Tracer> make_host_interferometer(const optics::Instrument& instrument,
                                                        const optics::InstrumentDescription& description,
                                                        const specimen::Specimen& specimen, const ReferenceArm& arm,
                                                        FocalRange range) {
    return std::make_unique<HostInterferometer>(fringe_fields(instrument, description, specimen, arm, range), range,
                                                trace::host_identity(instrument, {}));
}

} // namespace vkfv::fields
