#include "core/mathematics/line_transform.hpp"

#include <Eigen/Core>
#include <unsupported/Eigen/FFT>

namespace vkfv {

struct LineTransform::State {
    Eigen::FFT<double> fft;
};

LineTransform::LineTransform() : state_(std::make_unique<State>()) {
    state_->fft.SetFlag(Eigen::FFT<double>::Unscaled);
}
LineTransform::~LineTransform() = default;

void LineTransform::forward(std::complex<double>* to, const std::complex<double>* from, int length) {
    state_->fft.fwd(to, from, length);
}
void LineTransform::inverse(std::complex<double>* to, const std::complex<double>* from, int length) {
    state_->fft.inv(to, from, length);
}

} // namespace vkfv
