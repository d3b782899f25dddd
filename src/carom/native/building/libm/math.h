// The part of <math.h> that musl's maths sources need, for any target: no platform's own header is used.
#pragma once

#include <features.h>

#define NAN __builtin_nanf("")
#define INFINITY __builtin_inff()
#define isnan(x) __builtin_isnan(x)
#define isinf(x) __builtin_isinf(x)
#define isfinite(x) __builtin_isfinite(x)
#define signbit(x) __builtin_signbit(x)

// One instruction each.
#define floor(x) __builtin_floor(x)
#define fabs(x) __builtin_fabs(x)
#define fabsf(x) __builtin_fabsf(x)
#define sqrt(x) __builtin_sqrt(x)

typedef float float_t;
typedef double double_t;

double sin(double);
double cos(double);
double tan(double);
double asin(double);
double acos(double);
double atan(double);
double atan2(double, double);
double exp(double);
double log(double);
double pow(double, double);
double fmod(double, double);
double cbrt(double);
double hypot(double, double);
double scalbn(double, int);
