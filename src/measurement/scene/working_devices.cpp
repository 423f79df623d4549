#include "measurement/scene/working_devices.hpp"

#include "measurement/scene/assembly.hpp"
#include "measurement/scene/wave_devices.hpp"
#include "scan/staged_tracer.hpp"
#include "trace/device/device_tracer.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/interface/tracer_pool.hpp"
#include "vulkan/device.hpp"
#include "vulkan/failure.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstddef>
#include <future>

namespace vkfv::measurement {

WorkingDevices::Member::Member(std::string its_selector) : selector(std::move(its_selector)) {
    open();
}

void WorkingDevices::Member::open() {
    device = {}; // a lost device closes before it is opened again
    if (selector != "host") {
        device = vulkan::begin_to_open(vulkan::DeviceOptions{selector});
    }
}

WorkingDevices::WorkingDevices(const std::string& selector) {
    const bool is_list = selector == "all" || selector.find(',') != std::string::npos;
    if (!is_list) {
        members_.emplace_back(selector);
        return;
    }
    const auto reports = vulkan::list_devices();
    const auto chosen = vulkan::choose_devices(reports, selector);
    for (const std::size_t device : chosen) {
        // A single device keeps the words of its selector, so that a message repeats them.
        members_.emplace_back(chosen.size() == 1 && selector != "all" ? selector
                                                                      : fmt::format("{}", reports[device].index));
    }
}

std::unique_ptr<trace::Tracer> WorkingDevices::make_tracer(const optics::Instrument& instrument,
                                                           const specimen::Specimen& specimen,
                                                           const trace::TraceOptions& options) const {
    const auto make = [&](std::size_t place) -> std::unique_ptr<trace::Tracer> {
        auto of_member = options;
        of_member.device = members_[place].selector;
        of_member.batch_divisor = members_[place].batch_divisor;
        if (of_member.device == "host") {
            refuse_beyond_host(of_member, instrument);
            return trace::make_host_tracer(instrument, specimen, of_member);
        }
        try {
            of_member.opened = members_[place].device;
            return trace::make_device_tracer(instrument, specimen, of_member);
        } catch (const std::exception&) {
            trace::rethrow_as_failure_of(static_cast<int>(place));
        }
    };
    std::vector<std::future<std::unique_ptr<trace::Tracer>>> futures;
    for (std::size_t place = 1; place < members_.size(); ++place) {
        futures.push_back(std::async(std::launch::async, make, place));
    }
    std::vector<std::unique_ptr<trace::Tracer>> tracers;
    tracers.push_back(make(0));
    for (auto& future : futures) {
        tracers.push_back(future.get());
    }
    auto tracer = tracers.size() == 1 ? std::move(tracers.front()) : trace::make_tracer_pool(std::move(tracers));
    spdlog::info("{}", tracer->description());
    return tracer;
}

std::unique_ptr<trace::Tracer> make_tracer(const WorkingDevices& devices, const Configuration& configuration,
                                           const optics::Instrument& instrument, const specimen::Specimen& specimen) {
    auto motion = stage_motion(configuration);
    if (!motion) {
        return devices.make_tracer(instrument, specimen, configuration.trace);
    }
    auto options = configuration.trace;
    options.rays = std::max<std::uint64_t>(1, options.rays / static_cast<std::uint64_t>(motion->moments()));
    return scan::make_staged_tracer(devices.make_tracer(instrument, specimen, options), std::move(*motion));
}

WorkingDevices WorkingDevices::first() const {
    return WorkingDevices({members_.front()});
}

void WorkingDevices::take_note(const vulkan::DeviceFailure& failure) {
    Member& member = members_.at(static_cast<std::size_t>(failure.place));
    if (!failure.may_pass() || (member.batch_divisor > 1 && members_.size() == 1)) {
        throw failure;
    }
    if (member.batch_divisor == 1) {
        member.batch_divisor = 2;
        spdlog::warn("{}. It is opened again, with half the batch", failure.cause());
        member.open();
        return;
    }
    members_.erase(members_.begin() + failure.place);
    spdlog::warn("{}. It is left out; {} {} on", failure.cause(), members_.size(),
                 members_.size() == 1 ? "device goes" : "devices go");
}

void work_with_devices(WorkingDevices& devices, const std::function<void(const WorkingDevices&)>& work) {
    for (;;) {
        try {
            work(devices);
            return;
        } catch (const vulkan::DeviceFailure& failure) {
            devices.take_note(failure);
        } catch (const vk::SystemError& error) {
            devices.take_note(vulkan::run_error_of(error));
        }
    }
}

} // namespace vkfv::measurement
