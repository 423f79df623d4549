// What the bits of an image depend on beside the configuration: the device as it is, and the program as it was built.
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

// The numbers by which light of waves is sorted and filtered; 0: images of rays.
struct LightSorting {
    int pupil_cells = 0;     // across the pupil
    int parts_per_pixel = 0; // of its side
    int field_tiles = 1;     // filters across the field

    // options: whose cells, parts and tiles are known.
    static LightSorting of(const optics::WaveOptions& options);
    static LightSorting of(const std::optional<optics::PupilFilter>& filter);
};

// Facts alone: nothing of why a device was chosen or what else stands beside it.
struct TracerIdentity {
    std::string device;          // name; "host": the reference in double
    std::uint32_t vendor_id = 0; // PCI's; 0: the host
    std::uint32_t device_id = 0;
    std::string driver;    // with its version
    std::string traversal; // "quadtree", "bvh", "ray-query"; empty: the host
    std::string fourier;   // the library that transforms images for waves; empty: the host, or images of rays
    LightSorting sorting;
    std::vector<LightSorting>
        further_sortings{}; // of the light of further sources; none: images of rays, or one source
    std::string kernels;    // digest of the SPIR-V, whose source is that of the host's physics too
    std::string instrument; // digest of the records that the instrument became; of several sources, of theirs

    std::string toml() const; // lines `key = value`
    // Of such lines. Throws InputError.
    static TracerIdentity parse(const TomlTable& table);
    std::string text() const; // "NVIDIA H100 (NVIDIA 580.159), traversal quadtree"
};

// Of the instrument as rays meet it, surface by surface, rounded to float; turned round, with the disc and the lattices
// of backward paths, which another program may have others of.
std::string instrument_digest(const optics::Instrument& instrument);

// Of the program's kernels of the trace.
std::string kernels_digest();

// Of the reference in double.
TracerIdentity host_identity(const optics::Instrument& instrument, LightSorting sorting);
// Of a device by its report. `instrument`: as the paths run through it.
TracerIdentity device_identity(const vulkan::DeviceReport& device, const std::string& traversal,
                               const optics::Instrument& instrument, LightSorting sorting);

} // namespace vkfv::trace
