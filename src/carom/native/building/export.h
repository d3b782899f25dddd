// Marks symbols that the library exports: `extern "C" CAROM_EXPORT void f(...) { ... }`.
#pragma once

#if defined(_WIN32)
#define CAROM_EXPORT __declspec(dllexport)
#else
#define CAROM_EXPORT __attribute__((visibility("default")))
#endif
