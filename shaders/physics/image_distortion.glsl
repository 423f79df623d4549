// Where a detector records the light that the lenses' design brings to a place, and back. Three deviations of a real
// camera stand here alone, in this order:
//   radial distortion   q = p (1 + image_distortion |p|^2), the third-order form of Seidel's theory,
//   shear               x = q.x + image_shear q.y: columns of pixels that are not at right angles to the rows,
//   magnification       both times 1 + magnification_change, which follows the focal plane's height.
// Places are those of Detection: mm on the detector's plane, about the axis, axes parallel to the specimen's.

// The place at which light is recorded that arrives at `arrived`. Where distances no longer rise with a negative
// distortion (below -1/3), light is far outside, as without it, and not folded back onto the detector.
VKFV_FUNCTION real2 recorded_place(Instrument instrument, Exposure exposure, real2 arrived) {
    real bend = instrument.image_distortion * dot(arrived, arrived);
    real radial = bend > real(-1.0 / 3.0) ? real(1.0) + bend : real(1.0);
    real2 distorted = arrived * radial;
    return real2(distorted.x + instrument.image_shear * distorted.y, distorted.y) *
           (real(1.0) + exposure.magnification_change);
}

// A place on the detector and the area there that belongs to a unit of recorded area.
struct ArrivalPlace {
    real2 place;
    real area;
};

// The place at which light arrives that is recorded at `recorded`: the inverse of recorded_place(), for distortions
// that rise with the distance; lay_out() in optics refuses others.
VKFV_FUNCTION ArrivalPlace arrival_place(Instrument instrument, Exposure exposure, real2 recorded) {
    real scale = real(1.0) + exposure.magnification_change;
    real2 scaled = recorded / scale;
    real2 distorted = real2(scaled.x - instrument.image_shear * scaled.y, scaled.y);
    // share: |p| / |q|, the root of share (1 + bend share^2) = 1 by Newton's method.
    real bend = instrument.image_distortion * dot(distorted, distorted);
    real share = real(1.0);
    for (int step = 0; step < 5; ++step) {
        real square = share * share;
        share = share - (share * (real(1.0) + bend * square) - real(1.0)) / (real(1.0) + real(3.0) * bend * square);
    }
    ArrivalPlace arrival;
    arrival.place = distorted * share;
    real rise = bend * share * share;
    arrival.area = real(1.0) / ((real(1.0) + rise) * (real(1.0) + real(3.0) * rise) * scale * scale);
    return arrival;
}
