// Exposures that are kept half done, a file each.
#pragma once

#include "trace/interface/checkpoint.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace vkfv::scan {

class CheckpointFiles final : public trace::Checkpoints {
  public:
    using Name = std::function<std::filesystem::path(std::uint32_t image)>;

    // digest: of all that the images' bits depend on; a file of another one is not taken up. interval: s, above 0.
    CheckpointFiles(Name name, std::string digest, double interval);

    double interval() const override { return interval_; }
    // A file that is there but not this exposure's, or not whole, is told to the log.
    std::optional<trace::Checkpoint> load(std::uint32_t image) const override;
    void save(std::uint32_t image, const trace::Checkpoint& checkpoint) const override;
    // When the image is stored.
    void drop(std::uint32_t image) const;

  private:
    Name name_;
    std::string digest_;
    double interval_;
};

} // namespace vkfv::scan
