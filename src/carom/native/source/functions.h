// Types of functions that records have the addresses of.
#pragma once

#include "python.h"

struct Call;

// A kernel, with the addresses of its bounds and of its arguments.
typedef void (*KernelFunction)(void* bounds, void* arguments);

// Performs a quick call. Numbers are the arguments in order; those left out are NaN if they have no default.
// Returns the number of groups of results; or 0 if Python has to handle the call, and nothing has been done.
typedef int (*Kernel)(const double* numbers, double* results, const Call* call);

// The same for results that are not a fixed number of numbers. Returns null if Python has to handle the call; then no
// error is set, unless memory is short. It reads all it needs of the world before it makes the first object, because
// making an object can start garbage collection, which may run any code.
typedef PyObject* (*Maker)(const double* numbers, const Call* call);
