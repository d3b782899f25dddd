// What Windows calls when it has loaded a library, which otherwise a C library would bring: there is nothing to do.
extern "C" int _DllMainCRTStartup(void*, unsigned long, void*) { return 1; }
