// Maths functions for the host, whose own are others on each platform: `carom.native.trigonometry`.

#include "export.h"

// By names of our own, as `flags.py` says: those of the kernels.
extern "C" double sin(double);
extern "C" double cos(double);
extern "C" double tan(double);

extern "C" CAROM_EXPORT void carom_sin_of(double* x) { *x = sin(*x); }
extern "C" CAROM_EXPORT void carom_cos_of(double* x) { *x = cos(*x); }
extern "C" CAROM_EXPORT void carom_tan_of(double* x) { *x = tan(*x); }
