// The parts of a measurement as the configuration asks for them.
#pragma once

#include "configuration/configuration.hpp"
#include "optics/instrument/instrument.hpp"
#include "optics/waves/diffraction.hpp"
#include "scan/stage.hpp"
#include "specimen/specimen.hpp"
#include "trace/interface/tracer.hpp"
#include "trace/interface/tracer_identity.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace vkfv::measurement {

// The configured instrument. Throws InputError at the place of the key that does not fit.
optics::Instrument assemble_instrument(const Configuration& configuration);
// The configured instrument for exposures of a specimen at these heights of the focal plane (mm). Its warnings go to
// the log.
optics::Instrument assemble_instrument(const Configuration& configuration, const specimen::Specimen& specimen,
                                       std::span<const double> focal_heights);
// The configured instrument for such exposures, whose warnings are only in its member `warnings`.
optics::Instrument assemble_silently(const Configuration& configuration, const specimen::Specimen& specimen,
                                     std::span<const double> focal_heights);
// The instrument for its figures alone, not for tracing. Its source lights the hemisphere, since it takes time to prove
// that an aim holds all useful light, and no figure depends on the aim.
optics::Instrument assemble_for_figures(const Configuration& configuration);

// The motion of the stage, which tells where images are really taken; without one they are taken at their nominal
// positions.
std::optional<scan::StageMotion> stage_motion(const Configuration& configuration);

// The configured specimen. Throws InputError at the place of the key that does not fit.
specimen::Specimen make_specimen(const Configuration& configuration);

// Everything that decides the bits of an image except its height: a part of the configuration, the surface as made, the
// instrument, the program, and the device (another device rounds differently). TOML lines.
std::string image_identity(const Configuration& configuration, const std::string& surface_digest,
                           const trace::TracerIdentity& tracer);

// The index that keys the random numbers of an exposure. At a position of the scan it is that image's place in the
// stack, so that the exposure has the same bits; at any other height it is the index after the scan's last, and 0
// without a scan. focal_height: mm.
std::uint32_t image_index(const Configuration& configuration, double focal_height);

// The instrument of the configuration's stack, also for a focal height (mm) that its scan does not have.
optics::Instrument instrument_for(const Configuration& configuration, const specimen::Specimen& specimen,
                                  double focal_height);

// The blur that the configuration asks for, on its detector; none if it asks for none. Throws InputError where the file
// of a point spread function is wrong.
std::optional<optics::Diffraction> make_diffraction(const Configuration& configuration,
                                                    const optics::Instrument& instrument);

// The blur that an evaluation applies. With a camera there is none, since its images are blurred already.
std::optional<optics::Diffraction> diffraction_of_evaluation(const Configuration& configuration,
                                                             const optics::Instrument& instrument);

// The options by which the configuration's own stack is evaluated. Without a given focus measure, the choice depends on
// whether there is a camera, whose noise counts. Without a given average along z, the average suits the instrument: a
// defocus that blurs waves of four pixels to half their contrast, or with [diffraction] model = "waves" waves of twice
// the resolution limit where these are longer.
topography::TopographyOptions evaluation_options(const Configuration& configuration,
                                                 const optics::Instrument& instrument);

// The standard deviation (mm) of a focus curve over the height of the focal plane. The curve is taken as a Gaussian
// that falls to half where waves of four pixels lose half their contrast by defocus, or with [diffraction] model =
// "waves" waves of twice the resolution limit where these are longer. By rays, a disc of light of radius r passes half
// the contrast of frequency f where 2 pi f r = 2.215, since 2 J1(x) / x is 1/2 there.
double focus_curve_deviation(const Configuration& configuration, const optics::FirstOrder& first_order);

} // namespace vkfv::measurement
