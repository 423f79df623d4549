// The devices of a run; one that fails is opened again, then left out.
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

// A device that is lost or full is opened again, with half the batch; the next time it is left out.
class WorkingDevices {
  public:
    // Those of trace.device: see vulkan::choose_devices(); "host" means the reference in double on the host's cores.
    // They are opened by threads of their own, while the scene is made. Throws DeviceError where a list names none.
    explicit WorkingDevices(const std::string& selector);

    // On all of them; what the options say of devices and batches' divisor does not count. Throws DeviceError, also
    // where a device has not opened.
    std::unique_ptr<trace::Tracer> make_tracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                               const trace::TraceOptions& options) const;

    int size() const { return static_cast<int>(members_.size()); }
    WorkingDevices first() const; // alone

    // With a warning. Throws the failure where no device is left, or where it would not pass.
    void take_note(const vulkan::DeviceFailure& failure);

  private:
    struct Member {
        explicit Member(std::string selector);
        void open(); // again

        std::string selector;
        std::uint64_t batch_divisor = 1;
        vulkan::OpenedDevice device; // none on the host
    };
    explicit WorkingDevices(std::vector<Member> members) : members_(std::move(members)) {}

    std::vector<Member> members_;
};

// The tracer of the configuration's images, at the positions where its stage really stands.
std::unique_ptr<trace::Tracer> make_tracer(const WorkingDevices& devices, const Configuration& configuration,
                                           const optics::Instrument& instrument, const specimen::Specimen& specimen);

// Does the work with the devices, again from its beginning where one of them has failed. What is stored meanwhile is to
// be kept by the work itself.
void work_with_devices(WorkingDevices& devices, const std::function<void(const WorkingDevices&)>& work);

} // namespace vkfv::measurement
