// The entry point that Windows calls after loading a library, usually part of a C library: there is nothing to do.
extern "C" int _DllMainCRTStartup(void*, unsigned long, void*) { return 1; }
