// Numbers of several worlds at once, with the operations of kernels, in place of `wp::float64`.
//
// Each lane has the bits that a single world has: the same operations in the same order, and functions of the libm one
// lane after the other.
#pragma once

namespace lanes {

constexpr int LANES = 4;

// The alignment of a single number: rows of arrays have other fields as well.
typedef double Numbers __attribute__((ext_vector_type(LANES), aligned(8)));
typedef decltype(Numbers() < Numbers()) Flags;

// The outcome of a comparison in each lane.
struct Mask {
    Flags flags;

    // Whether it is true in some lane.
    explicit operator bool() const { return __builtin_reduce_or(flags) != 0; }
};

struct Lane {
    Numbers numbers;

    Lane() : numbers(0.0) {}
    Lane(double number) : numbers(number) {}
    explicit Lane(Numbers numbers) : numbers(numbers) {}

    Lane& operator+=(Lane other) { return numbers += other.numbers, *this; }
    Lane& operator-=(Lane other) { return numbers -= other.numbers, *this; }
    Lane& operator*=(Lane other) { return numbers *= other.numbers, *this; }
    Lane& operator/=(Lane other) { return numbers /= other.numbers, *this; }
};

inline Lane operator+(Lane a, Lane b) { return Lane(a.numbers + b.numbers); }
inline Lane operator-(Lane a, Lane b) { return Lane(a.numbers - b.numbers); }
inline Lane operator*(Lane a, Lane b) { return Lane(a.numbers * b.numbers); }
inline Lane operator/(Lane a, Lane b) { return Lane(a.numbers / b.numbers); }
inline Lane operator-(Lane a) { return Lane(-a.numbers); }
inline Mask operator<(Lane a, Lane b) { return {a.numbers < b.numbers}; }
inline Mask operator>(Lane a, Lane b) { return {a.numbers > b.numbers}; }
inline Mask operator<=(Lane a, Lane b) { return {a.numbers <= b.numbers}; }
inline Mask operator>=(Lane a, Lane b) { return {a.numbers >= b.numbers}; }
inline Mask operator==(Lane a, Lane b) { return {a.numbers == b.numbers}; }
inline Mask operator!=(Lane a, Lane b) { return {a.numbers != b.numbers}; }
inline Mask operator!(Mask a) { return {~a.flags}; }
inline Mask operator||(Mask a, Mask b) { return {a.flags | b.flags}; }
inline Mask operator&&(Mask a, Mask b) { return {a.flags & b.flags}; }

inline Lane chosen(Mask mask, Lane a, Lane b) { return Lane(mask.flags ? a.numbers : b.numbers); }

template <typename F>
inline Lane each(F function, Lane a) {
    for (int lane = 0; lane < LANES; ++lane)
        a.numbers[lane] = function(a.numbers[lane]);
    return a;
}

inline Lane add(Lane a, Lane b) { return a + b; }
inline Lane sub(Lane a, Lane b) { return a - b; }
inline Lane mul(Lane a, Lane b) { return a * b; }
inline Lane div(Lane a, Lane b) { return a / b; }
inline Lane neg(Lane a) { return -a; }
inline Lane abs(Lane a) { return Lane(__builtin_elementwise_abs(a.numbers)); }
inline Lane sqrt(Lane a) { return Lane(__builtin_elementwise_sqrt(a.numbers)); }
inline Lane sin(Lane a) {
    return each([](double x) { return wp::sin(x); }, a);
}
inline Lane cos(Lane a) {
    return each([](double x) { return wp::cos(x); }, a);
}
inline Mask unot(Mask a) { return !a; }

inline Lane atan2(Lane y, Lane x) {
    for (int lane = 0; lane < LANES; ++lane)
        y.numbers[lane] = wp::atan2(y.numbers[lane], x.numbers[lane]);
    return y;
}

}  // namespace lanes

namespace wp {

using lanes::abs;
using lanes::add;
using lanes::atan2;
using lanes::cos;
using lanes::div;
using lanes::mul;
using lanes::neg;
using lanes::sin;
using lanes::sqrt;
using lanes::sub;
using lanes::unot;

inline lanes::Lane where(lanes::Mask mask, lanes::Lane a, lanes::Lane b) { return lanes::chosen(mask, a, b); }

template <unsigned N>
inline vec_t<N, lanes::Lane> where(lanes::Mask mask, vec_t<N, lanes::Lane> a, const vec_t<N, lanes::Lane>& b) {
    for (unsigned i = 0; i < N; ++i)
        a.c[i] = lanes::chosen(mask, a.c[i], b.c[i]);
    return a;
}

inline quat_t<lanes::Lane> where(lanes::Mask mask, const quat_t<lanes::Lane>& a, const quat_t<lanes::Lane>& b) {
    return {
        lanes::chosen(mask, a.x, b.x), lanes::chosen(mask, a.y, b.y), lanes::chosen(mask, a.z, b.z),
        lanes::chosen(mask, a.w, b.w)
    };
}

}  // namespace wp
