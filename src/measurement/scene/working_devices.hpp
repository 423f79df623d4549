// The devices of a run. A device that fails is opened again, then left out.
#pragma once

#include "configuration/configuration.hpp"
#include "optics/instrument/instrument.hpp"
#include "specimen/specimen.hpp"
#include "trace/interface/tracer.hpp"
#include "vulkan/opened_device.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vkfv::vulkan {
class DeviceFailure;
} // namespace vkfv::vulkan

namespace vkfv::measurement {

// A device that is lost or full is opened again, with half the batch. If it fails again, it is left out.
class WorkingDevices {
  public:
    // The devices that trace.device selects: see vulkan::choose_devices(); "host" means the reference in double on the
    // host's cores. Threads of their own open the devices while the scene is made. Throws DeviceError where a list
    // names no device.
    explicit WorkingDevices(const std::string& selector);

    // A tracer on all of these devices. Of the options, `device` and `batch_divisor` are not used: each device has its
    // own. Throws DeviceError, also if a device could not be opened.
    std::unique_ptr<trace::Tracer> make_tracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                               const trace::TraceOptions& options) const;

    int size() const { return static_cast<int>(members_.size()); }
    WorkingDevices first() const; // the first device alone

    // Opens the device again or leaves it out, with a warning in the log. Throws the failure where no device is left,
    // or where it would fail again.
    void take_note(const vulkan::DeviceFailure& failure);

  private:
    struct Member {
        explicit Member(std::string selector);
        void open(); // also opens a lost device again

        std::string selector;
        std::uint64_t batch_divisor = 1;
        vulkan::OpenedDevice device; // empty on the host
    };
    explicit WorkingDevices(std::vector<Member> members) : members_(std::move(members)) {}

    std::vector<Member> members_;
};

// The tracer of the configuration's images, at the positions where its stage really stands.
std::unique_ptr<trace::Tracer> make_tracer(const WorkingDevices& devices, const Configuration& configuration,
                                           const optics::Instrument& instrument, const specimen::Specimen& specimen);

// Does the work with the devices, and again from its beginning if one of them fails. The work itself must keep what it
// has finished.
void work_with_devices(WorkingDevices& devices, const std::function<void(const WorkingDevices&)>& work);

} // namespace vkfv::measurement
