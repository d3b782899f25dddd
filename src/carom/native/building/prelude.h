// What generated kernels find before Warp's headers.
#pragma once

#include "export.h"

// Nothing of Warp's is exported.
#define WP_API
#define WP_NO_CRT
// Products of matrices are fused nowhere: old processors would take many times as long for the same bits.
#define fma carom_multiply_add
#include "crt.h"

extern "C" {
inline double fma(double a, double b, double c) { return a * b + c; }
inline int _wp_isfinite(double x) { return __builtin_isfinite(x); }
inline int _wp_isnan(double x) { return __builtin_isnan(x); }
inline int _wp_isinf(double x) { return __builtin_isinf(x); }
// What Warp says it of, steps of 0 in slices, kernels do not have.
inline void _wp_assert(const char*, const char*, unsigned int) { }
}
