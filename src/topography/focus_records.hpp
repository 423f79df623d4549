// Records of the evaluation between double, in which a stack is judged, and float.
#pragma once

#include "focus/focus.hpp"

#include <type_traits>

namespace vkfv::topography {

#define VKFV_CONVERT(type, name) result.name = record.name;

inline focus::f64::CurveRecord in_double(const focus::f32::CurveRecord& record) {
    focus::f64::CurveRecord result{};
    VKFV_CURVE_RECORD_FIELDS(VKFV_CONVERT)
    return result;
}

inline focus::f64::SingleRecord in_double(const focus::f32::SingleRecord& record) {
    focus::f64::SingleRecord result{};
    VKFV_SINGLE_RECORD_FIELDS(VKFV_CONVERT)
    return result;
}

inline const focus::f64::CurveRecord& in_double(const focus::f64::CurveRecord& record) {
    return record;
}

inline const focus::f64::SingleRecord& in_double(const focus::f64::SingleRecord& record) {
    return record;
}

template <class Arithmetic>
typename Arithmetic::Plan plan_in(const focus::f64::FocusPlan& record) {
    if constexpr (std::is_same_v<Arithmetic, focus::f32::Arithmetic>) {
        focus::f32::FocusPlan result{};
        VKFV_FOCUS_PLAN_FIELDS(VKFV_CONVERT)
        return result;
    } else {
        return record;
    }
}

#undef VKFV_CONVERT

// The records of curves whose values are so many times as large.
inline focus::f64::CurveRecord times(focus::f64::CurveRecord record, double factor) {
    for (double* value : {&record.largest, &record.sum, &record.bend, &record.first, &record.latest, &record.variation,
                          &record.highest, &record.valley, &record.rival, &record.peak_1, &record.peak_2,
                          &record.peak_3, &record.peak_4, &record.joint}) {
        *value *= factor;
    }
    for (double* square : {&record.squares, &record.alone, &record.joint_squares, &record.alone_sum}) {
        *square *= factor * factor;
    }
    return record;
}

inline focus::f64::SingleRecord times(focus::f64::SingleRecord record, double factor) {
    for (double* value : {&record.first, &record.sum, &record.before_1, &record.before_2, &record.before_3,
                          &record.highest, &record.valley, &record.rival}) {
        *value *= factor;
    }
    for (double* square : {&record.squares, &record.steps_1, &record.steps_2, &record.steps_3}) {
        *square *= factor * factor;
    }
    return record;
}

} // namespace vkfv::topography
