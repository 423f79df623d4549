#include "statistics/nonlinear_least_squares.hpp"

#include <Eigen/Core>
#include <unsupported/Eigen/NonLinearOptimization>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace vkfv::statistics {

namespace {
namespace of_nonlinear_least_squares { // files of a unity build share the unnamed namespace

// The residuals as Eigen's algorithm asks for them; its return values say that they are valid.
class Functor {
  public:
    Functor(const Residuals& residuals, const std::vector<double>& start)
        : residuals_(residuals), first_at_(start), first_(residuals.values(start)) {}

    int inputs() const { return static_cast<int>(first_at_.size()); }
    int values() const { return static_cast<int>(first_.size()); }

    int operator()(const Eigen::VectorXd& unknowns, Eigen::VectorXd& values) const {
        const std::vector<double> at(unknowns.begin(), unknowns.end());
        const std::vector<double> found = at == first_at_ ? first_ : residuals_.values(at);
        values = Eigen::VectorXd::Map(found.data(), static_cast<Eigen::Index>(found.size()));
        return 0;
    }

    int df(const Eigen::VectorXd& unknowns, Eigen::MatrixXd& slopes) const {
        const Matrix found = residuals_.slopes({unknowns.begin(), unknowns.end()});
        for (std::size_t row = 0; row < found.rows; ++row) {
            for (std::size_t column = 0; column < found.columns; ++column) {
                slopes(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) = found(row, column);
            }
        }
        return 0;
    }

  private:
    const Residuals& residuals_;
    std::vector<double> first_at_; // its residuals are evaluated once, to count them
    std::vector<double> first_;
};

} // namespace of_nonlinear_least_squares
} // namespace

LeastSquaresEnd nonlinear_least_squares(const Residuals& residuals, std::vector<double> start, double tolerance,
                                        int most_evaluations) {
    of_nonlinear_least_squares::Functor functor(residuals, start);
    if (functor.values() < functor.inputs() || start.empty()) {
        throw std::invalid_argument("nonlinear_least_squares: fewer residuals than unknowns, or none");
    }
    Eigen::LevenbergMarquardt<of_nonlinear_least_squares::Functor> search(functor);
    search.parameters.ftol = search.parameters.xtol = tolerance;
    search.parameters.maxfev = most_evaluations;
    Eigen::VectorXd unknowns = Eigen::VectorXd::Map(start.data(), static_cast<Eigen::Index>(start.size()));
    const auto status = search.minimize(unknowns);
    using namespace Eigen::LevenbergMarquardtSpace;
    const bool converged = status == RelativeReductionTooSmall || status == RelativeErrorTooSmall ||
                           status == RelativeErrorAndReductionTooSmall || status == CosinusTooSmall;
    return {.unknowns = {unknowns.begin(), unknowns.end()},
            .evaluations = static_cast<int>(search.nfev),
            .converged = converged};
}

} // namespace vkfv::statistics
