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
// The same for exposures of a specimen at these heights of the focal plane (mm), with its warnings in the
// log.
optics::Instrument assemble_instrument(const Configuration& configuration, const specimen::Specimen& specimen,
                                       std::span<const double> focal_heights);
// The same, silently: its warnings are in it.
optics::Instrument assemble_silently(const Configuration& configuration, const specimen::Specimen& specimen,
                                     std::span<const double> focal_heights);
// The instrument for its figures alone, not for tracing: its source lights the hemisphere, since the proof of an
// aim that holds all useful light takes time, and no figure depends on it.
optics::Instrument assemble_for_figures(const Configuration& configuration);

// Where the configuration's images are really taken; none: at their nominal positions.
std::optional<scan::StageMotion> stage_motion(const Configuration& configuration);

// The configured specimen. Throws InputError at the place of the key that does not fit.
specimen::Specimen make_specimen(const Configuration& configuration);

// Everything that decides the bits of an image except its height: a part of the configuration, the surface as made,
// the instrument, the program, and the device (another device rounds differently). TOML lines.
std::string image_identity(const Configuration& configuration, const std::string& surface_digest,
                           const trace::TracerIdentity& tracer);

// What keys the random numbers of an exposure: at a position of the scan, that image of the stack is what comes out,
// bit by bit; anywhere else the index counts on after the scan's. focal_height: mm.
std::uint32_t image_index(const Configuration& configuration, double focal_height);

// The instrument of the configuration's stack, also where the focal height is none of its scan's.
optics::Instrument instrument_for(const Configuration& configuration, const specimen::Specimen& specimen,
                                  double focal_height);

// The blur that the configuration asks for, on its detector; none if it asks for none. InputError where the file of a
// point spread function is at fault.
std::optional<optics::Diffraction> make_diffraction(const Configuration& configuration,
                                                    const optics::Instrument& instrument);

// The blur that an evaluation applies: none with a camera, whose images are blurred already.
std::optional<optics::Diffraction> diffraction_of_evaluation(const Configuration& configuration,
                                                             const optics::Instrument& instrument);

// How the configuration asks for its own stack to be evaluated. Where no focus measure is given, it is chosen by
// whether there is a camera, whose noise counts; where no average along z is given, it suits the instrument: a defocus
// that blurs waves of four pixels to half their contrast, with [diffraction] model = "waves" waves of twice the
// resolution limit where these are longer.
topography::TopographyOptions evaluation_options(const Configuration& configuration,
                                                 const optics::Instrument& instrument);

// Standard deviation of a focus curve over the height of the focal plane, mm, as a Gaussian that falls to half where
// waves of four pixels lose half their contrast by defocus; with [diffraction] model = "waves" waves of twice the
// resolution limit where these are longer. Rays: a disc of light of radius r passes half the contrast of frequency f
// where 2 pi f r = 2.215, since 2 J1(x) / x is 1/2 there.
double focus_curve_deviation(const Configuration& configuration, const optics::FirstOrder& first_order);

} // namespace vkfv::measurement
