// The identity of a tracer: all that the bits of an image depend on besides the configuration, which is the device and
// the build of the program.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "optics/waves/pupil_filter.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vkfv {
class TomlTable;
}
namespace vkfv::vulkan {
struct DeviceReport;
}

namespace vkfv::trace {

// The numbers that define the sorting and filtering of light for waves; 0: images of rays.
struct LightSorting {
    int pupil_cells = 0;     // across the pupil
    int parts_per_pixel = 0; // along a pixel's side
    int field_tiles = 1;     // filters across the field

    // options: with known cells, parts and tiles.
    static LightSorting of(const optics::WaveOptions& options);
    static LightSorting of(const std::optional<optics::PupilFilter>& filter);
};

// The identity holds facts alone: not why a device was chosen, nor which others there are.
struct TracerIdentity {
    std::string device;          // name; "host": the reference in double
    std::uint32_t vendor_id = 0; // PCI vendor; 0: the host
    std::uint32_t device_id = 0;
    std::string driver;    // name and version
    std::string traversal; // "quadtree", "bvh", "ray-query"; empty: the host
    std::string fourier;   // library that transforms wave images; empty: the host, or images of rays
    LightSorting sorting;
    std::vector<LightSorting>
        further_sortings{}; // sortings of further sources' light; empty: images of rays, or one source
    std::string kernels;    // digest of the SPIR-V, whose source is also that of the host's physics
    std::string instrument; // digest of the instrument's records; for several sources, of their digests

    std::string toml() const; // lines `key = value`
    // Parses such lines. Throws InputError.
    static TracerIdentity parse(const TomlTable& table);
    std::string text() const; // "NVIDIA H100 (NVIDIA 580.159), traversal quadtree"
};

// The digest of the instrument's records as rays meet it, surface by surface, rounded to float; for a reversed
// instrument it includes the disc and the lattices of backward paths, which may differ in other programs.
std::string instrument_digest(const optics::Instrument& instrument);

// The digest of the program's trace kernels.
std::string kernels_digest();

// The identity of the reference in double.
TracerIdentity host_identity(const optics::Instrument& instrument, LightSorting sorting);
// The identity of a device by its report. `instrument`: in the direction of the paths.
TracerIdentity device_identity(const vulkan::DeviceReport& device, const std::string& traversal,
                               const optics::Instrument& instrument, LightSorting sorting);

} // namespace vkfv::trace
