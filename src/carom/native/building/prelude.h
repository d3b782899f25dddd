// Definitions that generated kernels need before Warp's headers.
#pragma once

#include "export.h"

// Warp's own functions are not exported.
#define WP_API
#define WP_NO_CRT
// Matrix products use no fused multiply-add: older processors would need many times as long for the same bits.
#define fma carom_multiply_add
#include "crt.h"

extern "C" {
inline double fma(double a, double b, double c) { return a * b + c; }
inline int _wp_isfinite(double x) { return __builtin_isfinite(x); }
inline int _wp_isnan(double x) { return __builtin_isnan(x); }
inline int _wp_isinf(double x) { return __builtin_isinf(x); }
// Warp asserts that slices have no step of 0; kernels have no such slices.
inline void _wp_assert(const char*, const char*, unsigned int) {}
}
