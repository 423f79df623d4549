// Converts records of the evaluation between float and double, in which a stack is judged.
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

} // namespace vkfv::topography
