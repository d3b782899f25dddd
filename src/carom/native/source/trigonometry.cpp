// Maths functions for the host, whose own functions differ between platforms: `carom.native.trigonometry`.

#include "export.h"

// The functions that kernels use; `flags.py` gives them names of their own.
extern "C" double sin(double);
extern "C" double cos(double);
extern "C" double tan(double);
extern "C" double asin(double);
extern "C" double acos(double);
extern "C" double atan2(double, double);

extern "C" CAROM_EXPORT void carom_sin_of(double* x) { *x = sin(*x); }
extern "C" CAROM_EXPORT void carom_cos_of(double* x) { *x = cos(*x); }
extern "C" CAROM_EXPORT void carom_tan_of(double* x) { *x = tan(*x); }
extern "C" CAROM_EXPORT void carom_asin_of(double* x) { *x = asin(*x); }
extern "C" CAROM_EXPORT void carom_acos_of(double* x) { *x = acos(*x); }
extern "C" CAROM_EXPORT void carom_atan2_of(double* yx) { *yx = atan2(yx[0], yx[1]); }
