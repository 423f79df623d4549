#include "optics/train/first_order.hpp"

#include <cmath>

namespace vkfv::optics {

RayTransfer RayTransfer::then(const RayTransfer& next) const {
    return {.a = next.a * a + next.b * c,
            .b = next.a * b + next.b * d,
            .c = next.c * a + next.d * c,
            .d = next.c * b + next.d * d};
}

namespace {

RayTransfer refraction(const physics::f64::Surface& surface) {
    return {.c = -(surface.index_after - surface.index_before) * surface.curvature - surface.power};
}

} // namespace

RayTransfer free_space(double distance, double index) {
    return {.b = distance / index};
}

namespace {

// The axial distance (mm) from the previous vertex. Where the frame is rotated between them, as behind a fold mirror,
// the distance along the axis counts.
double way_to(const physics::f64::Surface& surface) {
    return surface.rotation_zz == 1
               ? surface.distance
               : std::copysign(std::hypot(surface.decentre_x, surface.decentre_y, surface.distance), surface.distance);
}

} // namespace

RayTransfer transfer_to_surface(std::span<const physics::f64::Surface> train, std::size_t index) {
    RayTransfer transfer;
    for (std::size_t i = 0; i <= index; ++i) {
        const auto& surface = train[i];
        if (i > 0) {
            transfer = transfer.then(free_space(way_to(surface), surface.index_before));
        }
        if (i < index) {
            transfer = transfer.then(refraction(surface));
        }
    }
    return transfer;
}

RayTransfer transfer_of_train(std::span<const physics::f64::Surface> train) {
    if (train.empty()) {
        return {};
    }
    return transfer_to_surface(train, train.size() - 1).then(refraction(train.back()));
}

double focal_length(const RayTransfer& train) {
    return -1 / train.c;
}

double back_focal_distance(const RayTransfer& train) {
    return -train.a / train.c;
}

double front_focal_distance(const RayTransfer& train) {
    return -train.d / train.c;
}

PrincipalPlanes principal_planes(const RayTransfer& train, double index_before, double index_after) {
    return {.front = index_before * (train.d - 1) / train.c, .back = index_after * (1 - train.a) / train.c};
}

ParaxialImage image_of(const RayTransfer& train, double object_distance) {
    const double distance = -(train.b + object_distance * train.a) / (train.d + object_distance * train.c);
    return {.distance = distance, .magnification = train.a + distance * train.c};
}

EntrancePupil entrance_pupil(const RayTransfer& before) {
    return {.scale = before.b, .curvature = before.a / before.b};
}

StopImage stop_seen_from_front(const RayTransfer& before, double index_before) {
    return {.distance = index_before * before.b / before.a, .magnification = 1 / before.a};
}

StopImage stop_seen_from_behind(const RayTransfer& after, double index_after) {
    return {.distance = -index_after * after.b / after.d, .magnification = 1 / after.d};
}

} // namespace vkfv::optics
