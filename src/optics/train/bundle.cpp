#include "optics/train/bundle.hpp"

#include "optics/train/train.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vkfv::optics {

namespace {

using physics::f64::Dispersion;
using physics::f64::Surface;

// Apertures are enlarged by this share and this length (mm), so that rounding excludes no light. The device traces in
// float, whose rounding at the lengths of an illuminator (100 mm) is 1e-5 mm; the rounding of the bounds themselves in
// double, 1e-13 mm, is far less.
constexpr double aperture_share = 1e-5;
constexpr double aperture_rounding = 1e-5;
// The tolerance for the rounding of products of direction cosines.
constexpr double rounding = 1e-6;

struct Vector {
    Affine x;
    Affine y;
    Affine z;
};

Vector operator+(const Vector& a, const Vector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

Vector operator*(const Affine& factor, const Vector& a) {
    return {factor * a.x, factor * a.y, factor * a.z};
}

// The lines of the bundle's rays: `position` is any point of each line, `direction` has the length `index`.
struct Bundle {
    Vector position;
    Vector direction;
    Affine index;
};

// Collects the conditions that a ray must meet to continue, each a number that must not be positive, and keeps the one
// that comes closest to excluding the whole box.
class Conditions {
  public:
    // False if the number is positive in the whole box, so that none of its rays continues.
    bool require_not_positive(const Affine& number) {
        const double radius = number.radius();
        const double nearness = radius > 0 ? number.centre / radius : -std::numeric_limits<double>::infinity();
        // The first condition that stops the middle ray decides, because that ray reaches no later surface.
        if (nearness_ <= 0 && nearness > nearness_) {
            nearness_ = nearness;
            nearest_ = number;
            spread_at_nearest_ = spread_;
        }
        return !(number.low() > rounding);
    }
    bool require_within(const Affine& x, const Affine& y, const Affine& radius) {
        note_place(x, y);
        // A point inside a circle lies below all of its tangents. The test uses the tangent that the box exceeds most.
        const double length = std::hypot(x.centre, y.centre);
        const bool central = !(length > 0);
        return require_not_positive((central ? 1.0 : x.centre / length) * x + (central ? 0.0 : y.centre / length) * y -
                                    radius);
    }
    // Records how the bundle's place (in any unit) depends on the coordinates of the box.
    void note_place(const Affine& x, const Affine& y) {
        for (std::size_t i = 0; i < spread_.size(); ++i) {
            spread_[i] = std::abs(x.slopes[i]) + std::abs(y.slopes[i]);
        }
    }
    // The influence of each coordinate of the box on the box being undecided: on the bundle's place if that could not
    // be bounded, else on the nearest condition, whose rest grows with the square of the place's slopes.
    std::array<double, Affine::coordinates> influences(bool bounded) const {
        const auto& spread = bounded ? spread_at_nearest_ : spread_;
        double squares = 0;
        for (const double part : spread) {
            squares += part * part;
        }
        std::array<double, Affine::coordinates> shares{};
        for (std::size_t i = 0; i < shares.size(); ++i) {
            const double share = squares > 0 ? spread[i] * spread[i] / squares : 0;
            shares[i] = bounded ? std::abs(nearest_.slopes[i]) + nearest_.rest * share : share;
        }
        return shares;
    }
    bool middle_is_excluded() const { return nearness_ > 0; }

  private:
    double nearness_ = -std::numeric_limits<double>::infinity();
    Affine nearest_{};
    std::array<double, Affine::coordinates> spread_{};
    std::array<double, Affine::coordinates> spread_at_nearest_{};
};

enum class Passage { excluded, bounded, unbounded };

struct Meeting {
    Vector point;
    Affine curvature; // the unit normal is (-curvature x, -curvature y, normal_z)
    Affine cosine;    // dot product of direction and normal
};

struct Met {
    Passage passage = Passage::bounded;
    Meeting meeting{};
};

bool is_aspheric(const Surface& surface) {
    return (surface.flags & physics::f64::SURFACE_ASPHERIC) != 0;
}

bool is_lens(const Surface& surface) {
    return (surface.flags & physics::f64::SURFACE_IDEAL_LENS) != 0;
}

std::array<double, 6> coefficients_of(const Dispersion& dispersion) {
    return {dispersion.c1, dispersion.c2, dispersion.c3, dispersion.c4, dispersion.c5, dispersion.c6};
}

std::array<double, 7> coefficients_of(const Surface& surface) {
    return {surface.a4, surface.a6, surface.a8, surface.a10, surface.a12, surface.a14, surface.a16};
}

bool deflects(const Surface& surface) {
    return is_lens(surface) || surface.index_before != surface.index_after ||
           coefficients_of(surface.dispersion_before) != coefficients_of(surface.dispersion_after);
}

// The polynomial c_0 x + c_1 x^2 + ..., by Horner's rule.
template <std::size_t size>
Affine powers(const std::array<double, size>& coefficients, const Affine& x) {
    Affine sum;
    for (std::size_t i = size; i > 0; --i) { // clang 14 cannot compile libstdc++'s views
        sum = x * (sum + constant(coefficients[i - 1]));
    }
    return sum;
}

Affine index_of(double centre, const Dispersion& dispersion, const Affine& x) {
    return powers(coefficients_of(dispersion), x) + constant(centre);
}

Vector rotated(const Surface& surface, const Vector& v) {
    return {surface.rotation_xx * v.x + surface.rotation_xy * v.y + surface.rotation_xz * v.z,
            surface.rotation_yx * v.x + surface.rotation_yy * v.y + surface.rotation_yz * v.z,
            surface.rotation_zx * v.x + surface.rotation_zy * v.y + surface.rotation_zz * v.z};
}

void enter_frame(const Surface& surface, Bundle& bundle) {
    const Vector shift = {constant(-surface.decentre_x), constant(-surface.decentre_y), constant(-surface.distance)};
    bundle.position = rotated(surface, bundle.position + shift);
    bundle.direction = rotated(surface, bundle.direction);
}

Vector turned(const Vector& v, const Affine& angle) {
    const Affine c = cosine(angle);
    const Affine s = sine(angle);
    return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

// The polynomial part of an even asphere's sag (mm), and the (1/r) d/dr of this part (1/mm), at q = r^2.
Affine aspheric_sag(const Surface& surface, const Affine& q) {
    return q * powers(coefficients_of(surface), q);
}
Affine aspheric_slope(const Surface& surface, const Affine& q) {
    const auto coefficients = coefficients_of(surface);
    Affine sum;
    for (std::size_t i = coefficients.size(); i > 0; --i) {
        sum = q * (sum + constant(2.0 * static_cast<double>(i + 1) * coefficients[i - 1]));
    }
    return sum;
}

// (1/r) d sag / d r of the whole asphere; none if part of q lies outside its conic.
std::optional<Affine> slope_over_r(const Surface& surface, const Affine& q) {
    const double c = surface.curvature;
    const Affine under_root = constant(1) - ((1 + surface.conic) * c * c) * q;
    if (!(under_root.low() > 0)) {
        return std::nullopt;
    }
    return c * reciprocal(square_root(under_root)) + aspheric_slope(surface, q);
}

ApertureBounds bounds_of(const Surface& surface, double radius) {
    const double c = surface.curvature;
    const double bulge = 1 + surface.conic;
    double q = radius * radius;
    if (bulge * c * c * q > 1) {
        q = 1 / (bulge * c * c);
    }
    const double root = std::sqrt(1 - bulge * c * c * q);
    const auto [low, high] = std::minmax({0.0, c * q / (1 + root)});
    double aspheric = 0;
    double power = radius * radius;
    for (const double coefficient : coefficients_of(surface)) {
        power *= radius * radius;
        aspheric += std::abs(coefficient) * power;
    }
    ApertureBounds bounds{.radius = radius, .heights = {low - aspheric, high + aspheric}, .far_heights = {}};
    if (c != 0 && bulge != 0 && !is_aspheric(surface)) {
        const auto [near, far] = std::minmax({(1 + root) / (bulge * c), 2 / (bulge * c)});
        bounds.far_heights = Range{near, far};
    }
    return bounds;
}

// The search starts at the point on the conic, from which the asphere differs by its polynomial only. By the mean value
// theorem the remaining distance is that height divided by the rate of approach at some point in between. This bounds
// the point to which Newton's method (physics/asphere.glsl) converges.
Met meet_asphere(const Surface& surface, const Vector& direction, Vector point, const ApertureBounds& aperture) {
    const auto& [radius, heights, far_heights] = aperture;
    const double most_q = std::max(square(point.x).high() + square(point.y).high(), radius * radius);
    const Affine height = aspheric_sag(surface, square(point.x) + square(point.y));
    const Affine outward = direction.x * point.x + direction.y * point.y;
    const double across_squared = square(direction.x).high() + square(direction.y).high();
    // The two points lie between these heights, which bounds the distance between them.
    double way = (std::max(heights.high, point.z.high()) - std::min(heights.low, point.z.low())) / direction.z.low();
    Affine rate;
    constexpr int rounds = 2; // the second round uses the distance found by the first
    for (int round = 0; round < rounds; ++round) {
        // `spread` bounds |r'^2 - r^2| between the two points.
        const double spread = way * (2 * outward.range().magnitude() + way * across_squared);
        const Affine q = square(point.x) + square(point.y);
        const auto slope =
            slope_over_r(surface, anything_in({std::max(0.0, q.low() - spread), std::min(most_q, q.high() + spread)}));
        if (!slope) {
            return {.passage = Passage::unbounded};
        }
        Affine between = outward;
        between.rest += way * across_squared;
        rate = direction.z - *slope * between;
        if (!(rate.low() > 0)) {
            return {.passage = Passage::unbounded};
        }
        way = height.range().magnitude() / rate.low();
    }
    point = point + (height * reciprocal(rate)) * direction;
    const Affine q = square(point.x) + square(point.y);
    const auto slope = slope_over_r(surface, q);
    if (!slope) {
        return {.passage = Passage::unbounded};
    }
    const Affine scale = reciprocal(square_root(constant(1) + square(*slope) * q));
    return {.meeting = {.point = point,
                        .curvature = scale * *slope,
                        .cosine = scale * (direction.z - *slope * (direction.x * point.x + direction.y * point.y))}};
}

// Bounds of physics::meet_surface.
Met meet(const Surface& surface, const Bundle& bundle, const std::optional<ApertureBounds>& aperture,
         Conditions& conditions) {
    const Vector& direction = bundle.direction;
    if (!(direction.z.low() > 0)) {
        return {.passage = Passage::unbounded};
    }
    const Affine to_plane = -1.0 * (bundle.position.z * reciprocal(direction.z));
    Vector point = {bundle.position.x + to_plane * direction.x, bundle.position.y + to_plane * direction.y, {}};
    conditions.note_place(point.x, point.y);
    const double c = surface.curvature;
    if (c == 0 && !is_aspheric(surface)) {
        return {.meeting = {.point = point, .curvature = {}, .cosine = direction.z}};
    }
    const Affine f = c * (square(point.x) + square(point.y));
    const Affine g = direction.z - c * (point.x * direction.x + point.y * direction.y);
    const Affine a = c * (square(bundle.index) + surface.conic * square(direction.z));
    const Affine discriminant = square(g) - a * f;
    if (!conditions.require_not_positive(-1.0 * discriminant) || !conditions.require_not_positive(-1.0 * g)) {
        return {.passage = Passage::excluded};
    }
    if (!(discriminant.high() > 0)) {
        return {.passage = Passage::unbounded};
    }
    const Affine root = square_root(discriminant);
    if (!((g + root).low() > 0)) {
        return {.passage = Passage::unbounded};
    }
    const Affine further = f * reciprocal(g + root);
    point = {point.x + further * direction.x, point.y + further * direction.y, further * direction.z};
    const Affine normal_z = constant(1) - (c * (1 + surface.conic)) * point.z;
    if (is_aspheric(surface)) {
        return aperture && normal_z.low() > 0 ? meet_asphere(surface, direction, point, *aperture)
                                              : Met{.passage = Passage::unbounded};
    }
    if (surface.conic == 0) {
        return {.meeting = {.point = point, .curvature = constant(c), .cosine = root}};
    }
    const Affine length_squared = (c * c) * (square(point.x) + square(point.y)) + square(normal_z);
    if (!(length_squared.low() > 0)) {
        return {.passage = Passage::unbounded};
    }
    const Affine scale = reciprocal(square_root(length_squared));
    return {.meeting = {.point = point, .curvature = c * scale, .cosine = scale * root}};
}

// Computes the direction's axial part from the other two; as in the trace it is the positive root, whatever the sign of
// the ray's own.
Passage set_axial(Bundle& bundle, Conditions& conditions) {
    const Affine axial = square(bundle.index) - square(bundle.direction.x) - square(bundle.direction.y);
    if (!conditions.require_not_positive(-1.0 * axial)) {
        return Passage::excluded;
    }
    if (!(axial.high() > 0)) {
        return Passage::unbounded;
    }
    bundle.direction.z = square_root(axial);
    return Passage::bounded;
}

// Bounds of physics::refract_scaled.
Passage refract(Bundle& bundle, const Meeting& meeting, const Affine& index_after, Conditions& conditions) {
    const Affine under_root = square(meeting.cosine) + square(index_after) - square(bundle.index);
    if (!conditions.require_not_positive(-1.0 * under_root)) {
        return Passage::excluded;
    }
    if (!(under_root.high() > 0)) {
        return Passage::unbounded;
    }
    const Affine bend = meeting.curvature * (square_root(under_root) - meeting.cosine);
    bundle.position = meeting.point;
    bundle.direction.x = bundle.direction.x - bend * meeting.point.x;
    bundle.direction.y = bundle.direction.y - bend * meeting.point.y;
    bundle.index = index_after;
    return set_axial(bundle, conditions);
}

// Bounds of physics::pass_ideal_lens.
Passage pass_lens(Bundle& bundle, double power, const Affine& index_after, Conditions& conditions) {
    const double focal_length = 1 / power;
    const Affine way = -focal_length * bundle.index - bundle.position.z;
    const Vector before = bundle.direction;
    if (!conditions.require_within(bundle.position.x * before.z + way * before.x,
                                   bundle.position.y * before.z + way * before.y,
                                   std::abs(focal_length) * (index_after * before.z))) {
        return Passage::excluded;
    }
    if (!(before.z.low() > 0)) {
        return Passage::unbounded;
    }
    const Affine to_focal_plane = way * reciprocal(before.z);
    bundle.direction.x = -power * (bundle.position.x + to_focal_plane * before.x);
    bundle.direction.y = -power * (bundle.position.y + to_focal_plane * before.y);
    bundle.position = {focal_length * before.x, focal_length * before.y, focal_length * index_after};
    bundle.index = index_after;
    return set_axial(bundle, conditions);
}

// False if none of the lines comes within a radius of the axis between two heights. Everything is multiplied by the
// direction's z, which may be 0.
bool may_meet_within(const Bundle& bundle, double radius, const Range& heights, Conditions& conditions) {
    const Vector& direction = bundle.direction;
    const Affine way = anything_in(heights) - bundle.position.z;
    return conditions.require_within(bundle.position.x * direction.z + way * direction.x,
                                     bundle.position.y * direction.z + way * direction.y, radius * direction.z);
}

// Tests both sides of a conic. A condition that excludes the near side does not count while the far side remains.
bool may_meet(const Bundle& bundle, const ApertureBounds& aperture, Conditions& conditions) {
    const Conditions before = conditions;
    if (may_meet_within(bundle, aperture.radius, aperture.heights, conditions)) {
        return true;
    }
    if (!aperture.far_heights) {
        return false;
    }
    conditions = before;
    return may_meet_within(bundle, aperture.radius, *aperture.far_heights, conditions);
}

EmissionCoordinate best_cut(const EmissionBox& box, const Conditions& conditions, bool bounded, bool is_turned) {
    // A linear bound over such a wide angle is useless, so the angle is halved first.
    for (const EmissionCoordinate angle : {azimuth, turn}) {
        if (box[angle].radius() >= 1 && (angle != turn || is_turned)) {
            return angle;
        }
    }
    const auto influences = conditions.influences(bounded || conditions.middle_is_excluded());
    const auto most = std::ranges::max_element(influences);
    return *most > 0 ? static_cast<EmissionCoordinate>(most - influences.begin()) : from_middle;
}

double at(const Range& range, double place) {
    return range.middle() + place * range.radius();
}

} // namespace

std::optional<EmittedRay> ray_in(const EmissionBox& box, const EmissionMiddle& middle,
                                 const std::array<double, Affine::coordinates>& place) {
    const auto value = [&](EmissionCoordinate which) { return at(box[which], place[which]); };
    const double angle = value(turn);
    const glm::dvec2 start = value(from_axis) * glm::dvec2(std::cos(angle), std::sin(angle));
    const double direction = angle + value(azimuth);
    const glm::dvec2 across =
        middle.shift * start + value(from_middle) * glm::dvec2(std::cos(direction), std::sin(direction));
    const double sine_squared = glm::dot(across, across);
    if (!(sine_squared <= middle.reach * middle.reach && sine_squared < 1)) {
        return std::nullopt;
    }
    EmittedRay result;
    result.ray = {};
    result.ray.position = glm::dvec3(start, 0);
    result.ray.direction = glm::dvec3(across, std::sqrt(1 - sine_squared));
    result.spectral = value(spectral);
    return result;
}

BundleTracer::BundleTracer(std::span<const Surface> train, double source_distance, const EmissionMiddle& middle)
    : train_(train), source_distance_(source_distance), middle_(middle),
      first_displaced_(static_cast<std::size_t>(std::ranges::find_if(train, is_displaced) - train.begin())) {
    for (const Surface& surface : train) {
        apertures_.emplace_back();
        if ((surface.flags & physics::f64::SURFACE_CLIPPED) != 0) {
            const double radius = (1 + aperture_share) * std::sqrt(surface.semi_diameter_squared) + aperture_rounding;
            apertures_.back() = bounds_of(surface, radius);
        }
    }
}

std::optional<EmissionCoordinate> BundleTracer::may_pass(const EmissionBox& box) const {
    const auto of = [&](EmissionCoordinate which) { return coordinate(which, box[which]); };
    Conditions conditions;
    Bundle bundle;
    bundle.position = {of(from_axis), {}, constant(-source_distance_)};
    const Affine middle = middle_.shift * of(from_axis);
    const Affine along = of(from_middle) * cosine(of(azimuth));
    bundle.direction.x = middle + along;
    bundle.direction.y = of(from_middle) * sine(of(azimuth));
    const Affine sine_squared = square(of(from_middle)) + middle * (middle + 2.0 * along);
    if (sine_squared.low() > middle_.reach * middle_.reach + rounding || !(sine_squared.low() < 1)) {
        return std::nullopt;
    }
    bundle.direction.z = square_root(constant(1) - sine_squared);
    const Affine x = of(spectral);
    bundle.index =
        train_.empty() ? constant(1) : index_of(train_.front().index_before, train_.front().dispersion_before, x);
    bundle.direction = bundle.index * bundle.direction;
    bool is_turned = false;
    Passage passage = Passage::bounded;
    for (std::size_t i = 0; i < train_.size() && passage == Passage::bounded; ++i) {
        const Surface& surface = train_[i];
        if (i == first_displaced_) {
            bundle.position = turned(bundle.position, of(turn));
            bundle.direction = turned(bundle.direction, of(turn));
            is_turned = true;
        }
        enter_frame(surface, bundle);
        const auto& aperture = apertures_[i];
        if (!conditions.require_not_positive(-1.0 * bundle.direction.z)) {
            return std::nullopt;
        }
        if (aperture && !may_meet(bundle, *aperture, conditions)) {
            return std::nullopt;
        }
        if (!deflects(surface)) {
            continue; // an undisplaced surface leaves the rays on their lines
        }
        const Affine index_after = index_of(surface.index_after, surface.dispersion_after, x);
        if (is_lens(surface)) {
            passage = pass_lens(bundle, surface.power, index_after, conditions);
        } else {
            const Met met = meet(surface, bundle, aperture, conditions);
            passage = met.passage;
            if (passage == Passage::bounded && aperture &&
                !conditions.require_within(met.meeting.point.x, met.meeting.point.y, constant(aperture->radius))) {
                return std::nullopt;
            }
            if (passage == Passage::bounded) {
                passage = refract(bundle, met.meeting, index_after, conditions);
            }
        }
        if (passage == Passage::excluded) {
            return std::nullopt;
        }
    }
    return best_cut(box, conditions, passage == Passage::bounded, is_turned);
}

} // namespace vkfv::optics
