#include "topography/host_focus_planes.hpp"

#include "topography/focus_records.hpp"
#include "topography/focus_windows.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::topography {
namespace {

// Keeps the last few items of a series.
template <class Item>
class Ring {
  public:
    explicit Ring(int kept) : items_(static_cast<std::size_t>(kept)) {}
    Item& operator[](int index) { return items_[static_cast<std::size_t>(index) % items_.size()]; }
    const Item& operator[](int index) const { return items_[static_cast<std::size_t>(index) % items_.size()]; }

  private:
    std::vector<Item> items_;
};

template <class Real>
struct CurveScene {
    const Ring<Grid<float>>& curves;
    const Ring<Grid<float>>& joint;
    const Ring<Grid<float>>& alone;
    std::size_t pixel;
    Real curve_value(int image) const { return curves[image].values[pixel]; }
    Real joint_value(int image) const { return joint[image].values[pixel]; }
    Real alone_value(int image) const { return alone[image].values[pixel]; }
};

template <class Arithmetic>
class HostFocusPlanes final : public FocusPlanes {
    using Real = typename Arithmetic::Real;

  public:
    explicit HostFocusPlanes(const FocusPlanesPlan& plan)
        : plan_(plan_in<Arithmetic>(plan.plan)), weights_(plan.window.weights().begin(), plan.window.weights().end()),
          gathered_pixels_(plan.gathered_pixels), images_(plan.images_kept), curves_(plan.curves_kept),
          averaged_(plan.averaged_curves_kept), images_averaged_(plan.images_averaged), squares_(plan.curves_kept),
          joint_(plan.averaged_curves_kept), alone_(plan.averaged_curves_kept) {
        summary_.brightness = Grid<float>(plan_.columns, plan_.rows);
        records_ = Grid<typename Arithmetic::Curve>(plan_.columns, plan_.rows, Arithmetic::empty());
        singles_ = Grid<typename Arithmetic::Single>(plan_.columns, plan_.rows);
        summary_.all_in_focus.assign(static_cast<std::size_t>(plan_.channels), Grid<float>(plan_.columns, plan_.rows));
    }

    void take(int image, Channels channels) override {
        images_[image] = std::move(channels);
        const auto share = static_cast<float>(Arithmetic::ratio(1, static_cast<Real>(plan_.channels)));
        for (std::size_t channel = 0; channel < images_[image].size(); ++channel)
            pixels([&, channel](std::size_t k) {
                summary_.brightness.values[k] += share * images_[image][channel].values[k];
            });
    }

    void measure(int image, std::span<const Share> shares) override {
        curves_[image] = images_averaged_ ? measure_of(mean_image(shares)) : measure_of(images_[image]);
    }

    void measure_alone(int image) override {
        const Grid<float> values = images_averaged_ ? measure_of(images_[image]) : curves_[image];
        Grid<float>& squares = squares_[image];
        squares = Grid<float>(plan_.columns, plan_.rows);
        pixels([&](std::size_t k) {
            squares.values[k] = values.values[k] * values.values[k];
            singles_.values[k] = follow_single(singles_.values[k], static_cast<Real>(values.values[k]), image);
        });
    }

    void average(int image, std::span<const Share> shares) override {
        averaged_[image] = weighted_mean(shares, [&](int k) -> const Grid<float>& { return curves_[k]; });
    }

    void average_alone(int image, std::span<const Share> shares) override {
        alone_[image] = weighted_mean(shares, [&](int k) -> const Grid<float>& { return squares_[k]; });
    }

    void measure_joint(int image, std::span<const Share> shares) override {
        joint_[image] = measure_of(mean_image(shares));
    }

    void gather(int image) override {
        for (const std::uint32_t pixel : gathered_pixels_)
            summary_.gathered.push_back(averaged_[image].values[pixel]);
    }

    void follow(int image, int images) override {
        pixels([&](std::size_t k) {
            const CurveScene<Real> scene{averaged_, images_averaged_ ? averaged_ : joint_, alone_, k};
            const auto step = follow_curve(scene, plan_, records_.values[k], image, images);
            records_.values[k] = step.curve;
            if (step.place == Arithmetic::no_place()) {
                return;
            }
            const int before = static_cast<int>(std::floor(step.place));
            for (std::size_t channel = 0; channel < summary_.all_in_focus.size(); ++channel) {
                float& value = summary_.all_in_focus[channel].values[k];
                value = 0;
                for (int near = before; near <= std::min(before + 1, images - 1); ++near) {
                    value += static_cast<float>(Arithmetic::share(step.place, near)) * images_[near][channel].values[k];
                }
            }
        });
    }

    StackSummary summary() override { return std::move(summary_); }

    void visit_records(const RecordTask& task) override {
        pixels([&](std::size_t k) { task(k, in_double(records_.values[k]), in_double(singles_.values[k])); });
    }

  private:
    Grid<float> measure_of(const Channels& image) const { return focus_values<Arithmetic>(image, plan_, weights_); }

    Channels mean_image(std::span<const Share> shares) const {
        Channels mean;
        for (std::size_t channel = 0; channel < static_cast<std::size_t>(plan_.channels); ++channel)
            mean.push_back(weighted_mean(shares, [&](int k) -> const Grid<float>& { return images_[k][channel]; }));
        return mean;
    }

    template <class Task>
    void pixels(const Task& task) const {
        parallel_rows(plan_.columns, plan_.rows, [&](int first, int end) {
            const auto columns = static_cast<std::size_t>(plan_.columns);
            for (std::size_t k = columns * static_cast<std::size_t>(first); k < columns * static_cast<std::size_t>(end);
                 ++k)
                task(k);
        });
    }

    template <class Plane>
    Grid<float> weighted_mean(std::span<const Share> shares, const Plane& plane) const {
        Grid<float> mean(plan_.columns, plan_.rows);
        parallel_rows(plan_.columns, plan_.rows, [&](int first, int end) {
            for (const Share& share : shares) {
                const Grid<float>& from = plane(share.image);
                for (std::size_t k = mean.index(0, first); k < mean.index(0, end); ++k)
                    mean.values[k] += share.weight * from.values[k];
            }
        });
        return mean;
    }

    typename Arithmetic::Plan plan_;
    std::vector<Real> weights_;
    std::vector<std::uint32_t> gathered_pixels_;
    Ring<Channels> images_;
    Ring<Grid<float>> curves_;
    Ring<Grid<float>> averaged_;
    bool images_averaged_;
    Ring<Grid<float>> squares_; // squares of single images' curves
    Ring<Grid<float>> joint_;   // empty if images are averaged
    Ring<Grid<float>> alone_;
    StackSummary summary_;
    Grid<typename Arithmetic::Curve> records_;
    Grid<typename Arithmetic::Single> singles_;
};

} // namespace

std::unique_ptr<FocusPlanes> make_host_focus_planes(const FocusPlanesPlan& plan) {
    return std::make_unique<HostFocusPlanes<focus::f32::Arithmetic>>(plan);
}

std::unique_ptr<FocusPlanes> make_reference_focus_planes(const FocusPlanesPlan& plan) {
    return std::make_unique<HostFocusPlanes<focus::f64::Arithmetic>>(plan);
}

} // namespace vkfv::topography
