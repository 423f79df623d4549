#include "topography/device_focus_planes.hpp"

#include "core/threads/parallel_rows.hpp"
#include "spirv/focus_brightness.h"
#include "spirv/focus_columns.h"
#include "spirv/focus_follow.h"
#include "spirv/focus_gather.h"
#include "spirv/focus_mean.h"
#include "spirv/focus_response.h"
#include "spirv/focus_rows.h"
#include "spirv/focus_select.h"
#include "spirv/focus_single.h"
#include "topography/focus_records.hpp"
#include "vulkan/kernel.hpp"

#include <algorithm>
#include <deque>
#include <memory>
#include <utility>

namespace vkfv::topography {

namespace {

constexpr std::uint32_t workgroup = 128;
constexpr std::size_t images_a_gathered_buffer = 64;
constexpr std::size_t least_carrier_bytes = 1 << 16; // records are copied by the carriers too
constexpr int records_a_thread = 1 << 12;

using namespace focus::f32; // bindings and push constants: shaders/focus/interface.glsl

static_assert(alignof(FollowedImage) == 4 && alignof(CurveRecord) == 4 && alignof(SingleRecord) == 4 &&
              alignof(WindowSums) == 4); // nothing is padded

std::vector<vulkan::BindingDeclaration> storage_buffers(std::initializer_list<std::uint32_t> slots) {
    std::vector<vulkan::BindingDeclaration> all;
    for (const std::uint32_t slot : slots) {
        all.push_back({slot, vulkan::BindingKind::storage_buffer});
    }
    return all;
}

// Bindings of the given slots and of the planes of planes.glsl.
std::vector<vulkan::BindingDeclaration> with_planes(std::initializer_list<std::uint32_t> slots) {
    auto all = storage_buffers(slots);
    for (std::uint32_t plane = 0; plane < MOST_PLANES; ++plane) {
        all.push_back({BINDING_PLANE + plane, vulkan::BindingKind::storage_buffer});
    }
    return all;
}

// The given bindings with those of planes, MOST_PLANES at most; slots without a plane are bound to the first one.
std::vector<vulkan::Binding> with_planes(std::vector<vulkan::Binding> others,
                                         std::span<const vulkan::Buffer* const> planes) {
    for (std::uint32_t plane = 0; plane < MOST_PLANES; ++plane) {
        others.push_back({BINDING_PLANE + plane, planes[plane < planes.size() ? plane : 0]});
    }
    return others;
}

class DeviceFocusPlanes final : public FocusPlanes {
  public:
    DeviceFocusPlanes(std::shared_ptr<const vulkan::Device> device, const FocusPlanesPlan& stack)
        : plan_(plan_in<focus::f32::Arithmetic>(stack.plan)), images_averaged_(stack.images_averaged),
          averaged_curves_(stack.averaged_curves_kept),
          pixels_(static_cast<std::size_t>(plan_.columns) * static_cast<std::size_t>(plan_.rows)),
          channels_(static_cast<std::size_t>(plan_.channels)), shared_(std::move(device)), device_(*shared_),
          mean_(device_, "focus_mean", ::focus_mean, with_planes({BINDING_TO}), sizeof(MeanTerms)),
          add_brightness_(device_, "focus_brightness", ::focus_brightness,
                          storage_buffers({BINDING_IMAGE, BINDING_BRIGHTNESS}), sizeof(ImageSize)),
          response_(device_, "focus_response", ::focus_response, storage_buffers({BINDING_IMAGE, BINDING_RESPONSES}),
                    sizeof(FocusPlan)),
          rows_(device_, "focus_rows", ::focus_rows,
                storage_buffers({BINDING_IMAGE, BINDING_RESPONSES, BINDING_WEIGHTS, BINDING_ROW_SUMS}),
                sizeof(FocusPlan)),
          columns_(device_, "focus_columns", ::focus_columns,
                   storage_buffers({BINDING_ROW_SUMS, BINDING_WEIGHTS, BINDING_CURVE}), sizeof(FocusPlan)),
          single_(device_, "focus_single", ::focus_single,
                  storage_buffers({BINDING_CURVE, BINDING_SQUARES, BINDING_SINGLES}), sizeof(SingleImage)),
          follow_(device_, "focus_follow", ::focus_follow,
                  storage_buffers({BINDING_CURVES, BINDING_JOINT, BINDING_ALONE, BINDING_RECORDS, BINDING_PLACES}),
                  sizeof(FollowedImage)),
          gather_(device_, "focus_gather", ::focus_gather,
                  storage_buffers({BINDING_CURVES, BINDING_PIXELS, BINDING_GATHERED}), sizeof(GatheredImage)),
          select_(device_, "focus_select", ::focus_select, with_planes({BINDING_PLACES, BINDING_ALL_IN_FOCUS}),
                  sizeof(SelectedImages)),
          mean_image_(device_, channels_ * pixels_ * sizeof(float)), responses_(device_, pixels_ * sizeof(WindowSums)),
          row_sums_(device_, static_cast<std::size_t>(focus_fields(plan_)) * pixels_ * sizeof(WindowSums)),
          weights_(device_, stack.window.weights().size() * sizeof(float)),
          averaged_(device_, static_cast<std::size_t>(averaged_curves_) * pixels_ * sizeof(float)),
          joint_(device_, images_averaged_ ? sizeof(float) : averaged_.bytes()),
          joint_curve_(device_, images_averaged_ ? sizeof(float) : pixels_ * sizeof(float)),
          single_curve_(device_, images_averaged_ ? pixels_ * sizeof(float) : sizeof(float)),
          alone_(device_, averaged_.bytes()), records_(device_, pixels_ * sizeof(CurveRecord)),
          singles_(device_, pixels_ * sizeof(SingleRecord)), places_(device_, pixels_ * sizeof(float)),
          brightness_(device_, pixels_ * sizeof(float)), all_in_focus_(device_, channels_ * pixels_ * sizeof(float)),
          gathered_count_(stack.gathered_pixels.size()),
          gathered_pixels_(device_, std::max<std::size_t>(1, gathered_count_) * sizeof(std::uint32_t)) {
        gathered_pixels_.write_values(std::span<const std::uint32_t>(stack.gathered_pixels));
        const std::vector<float> weights(stack.window.weights().begin(), stack.window.weights().end());
        weights_.write_values(std::span<const float>(weights));
        brightness_.fill_zero();
        all_in_focus_.fill_zero();
        for (int k = 0; k < 2; ++k) {
            carriers_.emplace_back(device_, std::max(channels_ * pixels_ * sizeof(float), least_carrier_bytes),
                                   vulkan::Buffer::Memory::host);
        }
        for (int k = 0; k < stack.images_kept; ++k) {
            images_.emplace_back(device_, channels_ * pixels_ * sizeof(float));
        }
        for (int k = 0; k < stack.curves_kept; ++k) {
            curves_.emplace_back(device_, pixels_ * sizeof(float));
            squares_.emplace_back(device_, pixels_ * sizeof(float));
        }
    }

    void take(int image, Channels channels) override {
        submit();
        // The carrier that is written now held the image before the last, which the device has read.
        vulkan::Buffer& carrier = carriers_[static_cast<std::size_t>(image) % carriers_.size()];
        for (std::size_t channel = 0; channel < channels.size(); ++channel) {
            carrier.write_values(std::span<const float>(channels[channel].values), channel * pixels_);
        }
        commands().copy(carrier, image_at(image), channels_ * pixels_ * sizeof(float));
        commands().barrier();
        dispatch(add_brightness_, {{BINDING_IMAGE, &image_at(image)}, {BINDING_BRIGHTNESS, &brightness_}},
                 ImageSize{static_cast<std::uint32_t>(pixels_), static_cast<std::uint32_t>(channels_)}, pixels_);
    }

    void measure(int image, std::span<const Share> shares) override {
        if (images_averaged_) {
            measure_mean(shares, curve_at(image));
        } else {
            measure(image_at(image), curve_at(image));
        }
    }

    void measure_alone(int image) override {
        if (images_averaged_) {
            measure(image_at(image), single_curve_);
        }
        dispatch(single_,
                 {{BINDING_CURVE, images_averaged_ ? &single_curve_ : &curve_at(image)},
                  {BINDING_SQUARES, &squares_at(image)},
                  {BINDING_SINGLES, &singles_}},
                 SingleImage{static_cast<std::uint32_t>(pixels_), image}, pixels_);
    }

    void average(int image, std::span<const Share> shares) override {
        weighted_mean(
            shares, [&](int k) -> const vulkan::Buffer& { return curve_at(k); }, averaged_, place_of(image), pixels_);
    }

    void average_alone(int image, std::span<const Share> shares) override {
        weighted_mean(
            shares, [&](int k) -> const vulkan::Buffer& { return squares_at(k); }, alone_, place_of(image), pixels_);
    }

    void measure_joint(int image, std::span<const Share> shares) override {
        measure_mean(shares, joint_curve_);
        commands().copy(joint_curve_, joint_, pixels_ * sizeof(float), 0, place_of(image) * sizeof(float));
        commands().barrier();
    }

    void gather(int image) override {
        if (gathered_images_ % images_a_gathered_buffer == 0) {
            gathered_.emplace_back(device_, images_a_gathered_buffer * gathered_count_ * sizeof(float),
                                   vulkan::Buffer::Memory::host);
        }
        dispatch(
            gather_,
            {{BINDING_CURVES, &averaged_}, {BINDING_PIXELS, &gathered_pixels_}, {BINDING_GATHERED, &gathered_.back()}},
            GatheredImage{static_cast<std::uint32_t>(gathered_count_), static_cast<std::uint32_t>(place_of(image)),
                          static_cast<std::uint32_t>((gathered_images_ % images_a_gathered_buffer) * gathered_count_)},
            gathered_count_);
        ++gathered_images_;
    }

    void follow(int image, int images) override {
        dispatch(follow_,
                 {{BINDING_CURVES, &averaged_},
                  {BINDING_JOINT, images_averaged_ ? &averaged_ : &joint_},
                  {BINDING_ALONE, &alone_},
                  {BINDING_RECORDS, &records_},
                  {BINDING_PLACES, &places_}},
                 FollowedImage{plan_, image, images, averaged_curves_}, pixels_);
        const int first = std::max(0, image - plan_.peak_range);
        const int last = std::min(images - 1, image + plan_.peak_range);
        for (int from = first; from <= last; from += MOST_PLANES) {
            std::vector<const vulkan::Buffer*> planes;
            for (int k = from; k <= std::min(last, from + MOST_PLANES - 1); ++k) {
                planes.push_back(&image_at(k));
            }
            dispatch(select_, with_planes({{BINDING_PLACES, &places_}, {BINDING_ALL_IN_FOCUS, &all_in_focus_}}, planes),
                     SelectedImages{static_cast<std::uint32_t>(pixels_), static_cast<std::uint32_t>(channels_), from,
                                    static_cast<int>(planes.size())},
                     pixels_);
        }
    }

    StackSummary summary() override {
        submit();
        if (submitted_) {
            submitted_->wait();
        }
        const auto grid = [&](std::vector<float> values) {
            Grid<float> result;
            result.columns = plan_.columns;
            result.rows = plan_.rows;
            result.values = std::move(values);
            return result;
        };
        StackSummary result;
        result.brightness = grid(brightness_.read_values<float>(pixels_));
        for (std::size_t channel = 0; channel < channels_; ++channel) {
            result.all_in_focus.push_back(grid(all_in_focus_.read_values<float>(pixels_, channel * pixels_)));
        }
        for (std::size_t left = gathered_images_; const vulkan::Buffer& buffer : gathered_) {
            const std::size_t images = std::min(left, images_a_gathered_buffer);
            const auto values = buffer.read_values<float>(images * gathered_count_);
            result.gathered.insert(result.gathered.end(), values.begin(), values.end());
            left -= images;
        }
        return result;
    }

    // Records are copied block by block through the carriers, so that the host needs no memory for all pixels' records.
    void visit_records(const RecordTask& task) override {
        const std::size_t block = carriers_[0].bytes() / std::max(sizeof(CurveRecord), sizeof(SingleRecord));
        for (std::size_t first = 0; first < pixels_; first += block) {
            const std::size_t count = std::min(block, pixels_ - first);
            vulkan::Commands copies(device_, 0, vulkan::Device::Lane::evaluation);
            copies.copy(records_, carriers_[0], count * sizeof(CurveRecord), first * sizeof(CurveRecord), 0);
            copies.copy(singles_, carriers_[1], count * sizeof(SingleRecord), first * sizeof(SingleRecord), 0);
            copies.submit_and_wait();
            const auto curves = carriers_[0].values<CurveRecord>(count);
            const auto singles = carriers_[1].values<SingleRecord>(count);
            parallel_bands(static_cast<int>(count), records_a_thread, [&](int begin, int end) {
                for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
                    task(first + k, in_double(curves[k]), in_double(singles[k]));
                }
            });
        }
    }

  private:
    vulkan::Buffer& image_at(int k) { return images_[static_cast<std::size_t>(k) % images_.size()]; }
    vulkan::Buffer& curve_at(int k) { return curves_[static_cast<std::size_t>(k) % curves_.size()]; }
    vulkan::Buffer& squares_at(int k) { return squares_[static_cast<std::size_t>(k) % squares_.size()]; }
    // Index at which an averaged curve's values at the image begin.
    std::size_t place_of(int image) const { return static_cast<std::size_t>(image % averaged_curves_) * pixels_; }

    template <class Push>
    void dispatch(const vulkan::Kernel& kernel, const std::vector<vulkan::Binding>& bindings, const Push& push,
                  std::size_t invocations) {
        const auto groups = vulkan::groups_of(invocations, workgroup);
        commands().dispatch(kernel, bindings, push, groups.x, groups.y);
        commands().barrier();
    }

    void measure(const vulkan::Buffer& image, const vulkan::Buffer& curve) {
        if (focus_responds(plan_)) {
            dispatch(response_, {{BINDING_IMAGE, &image}, {BINDING_RESPONSES, &responses_}}, plan_, pixels_);
        }
        dispatch(rows_,
                 {{BINDING_IMAGE, &image},
                  {BINDING_RESPONSES, &responses_},
                  {BINDING_WEIGHTS, &weights_},
                  {BINDING_ROW_SUMS, &row_sums_}},
                 plan_, pixels_);
        dispatch(columns_, {{BINDING_ROW_SUMS, &row_sums_}, {BINDING_WEIGHTS, &weights_}, {BINDING_CURVE, &curve}},
                 plan_, pixels_);
    }

    void measure_mean(std::span<const Share> shares, const vulkan::Buffer& curve) {
        weighted_mean(
            shares, [&](int k) -> const vulkan::Buffer& { return image_at(k); }, mean_image_, 0, channels_* pixels_);
        measure(mean_image_, curve);
    }

    // Records a weighted mean of planes. first_to: index of its first value in `to`.
    template <class Plane>
    void weighted_mean(std::span<const Share> shares, const Plane& plane, const vulkan::Buffer& to,
                       std::size_t first_to, std::size_t count) {
        for (std::size_t from = 0; from < shares.size(); from += MOST_PLANES) {
            MeanTerms terms{.count = static_cast<std::uint32_t>(count),
                            .first_to = static_cast<std::uint32_t>(first_to),
                            .first = from == 0 ? 1u : 0u,
                            .planes = 0,
                            .weights = {}};
            std::vector<const vulkan::Buffer*> planes;
            for (const Share& share : shares.subspan(from, std::min<std::size_t>(MOST_PLANES, shares.size() - from))) {
                terms.weights[terms.planes++] = share.weight;
                planes.push_back(&plane(share.image));
            }
            dispatch(mean_, with_planes({{BINDING_TO, &to}}, planes), terms, count);
        }
    }

    // The commands recorded since the last image.
    vulkan::Commands& commands() {
        if (!commands_) {
            commands_ = std::make_unique<vulkan::Commands>(device_, 0, vulkan::Device::Lane::evaluation);
        }
        return *commands_;
    }

    // Submits the recorded commands once the commands before have been done.
    void submit() {
        if (submitted_) {
            submitted_->wait();
        }
        submitted_ = std::move(commands_);
        if (submitted_) {
            submitted_->submit();
        }
    }

    FocusPlan plan_;
    bool images_averaged_;
    int averaged_curves_;
    std::size_t pixels_;
    std::size_t channels_;
    std::shared_ptr<const vulkan::Device> shared_;
    const vulkan::Device& device_;
    vulkan::Kernel mean_, add_brightness_, response_, rows_, columns_, single_, follow_, gather_, select_;
    vulkan::Buffer mean_image_, responses_, row_sums_, weights_, averaged_, joint_, joint_curve_, single_curve_, alone_,
        records_, singles_, places_, brightness_, all_in_focus_;
    std::size_t gathered_count_; // number of pixels
    vulkan::Buffer gathered_pixels_;
    std::deque<vulkan::Buffer> gathered_; // in host memory
    std::size_t gathered_images_ = 0;
    std::vector<vulkan::Buffer> images_;   // last few images, in turn
    std::vector<vulkan::Buffer> curves_;   // last few curves' values, in turn
    std::vector<vulkan::Buffer> squares_;  // last few squares of single images' curves, in turn
    std::vector<vulkan::Buffer> carriers_; // in host memory, used in turn
    std::unique_ptr<vulkan::Commands> commands_;
    std::unique_ptr<vulkan::Commands> submitted_;
};

} // namespace

FocusPlanesMaker device_focus_planes(std::shared_ptr<const vulkan::Device> device) {
    return [device](const FocusPlanesPlan& plan) { return std::make_unique<DeviceFocusPlanes>(device, plan); };
}

} // namespace vkfv::topography
