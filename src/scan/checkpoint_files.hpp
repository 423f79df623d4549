// Checkpoints of unfinished exposures, in a file each.
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

    // digest: of all that the images' bits depend on; files with another digest are not used. interval: s, above 0.
    CheckpointFiles(Name name, std::string digest, double interval);

    double interval() const override { return interval_; }
    // A file that belongs to another exposure or is damaged is logged and not used.
    std::optional<trace::Checkpoint> load(std::uint32_t image) const override;
    void save(std::uint32_t image, const trace::Checkpoint& checkpoint) const override;
    // Removes the checkpoint when the image is stored.
    void drop(std::uint32_t image) const;

  private:
    Name name_;
    std::string digest_;
    double interval_;
};

} // namespace vkfv::scan
