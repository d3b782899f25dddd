// Makes calls of a native library for a process that cannot load it: one under Linux, of a library for Windows.
//
// A call comes on the standard input as the name of a function and an image of all the memory that it uses, goes
// back on the standard output as the same image afterwards, and so on until the input ends. `memory.py` makes the
// images; whatever they hold of addresses is said beside them, for here they lie elsewhere.

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#include <windows.h>
#else
#include <dlfcn.h>
#endif

enum { NAME = 64, ALIGNMENT = 64 };

struct Call {
    char function[NAME];
    uint64_t size;            // of the image
    uint64_t pointer_count;   // places in it that hold an offset in it, to be made addresses
    uint64_t function_count;  // places in it that the address of a function belongs to
    uint64_t first, second, third;  // offsets of the arguments; a function may have two
};

struct FunctionPlace {
    uint64_t offset;
    char function[NAME];
};

static void* library;

static void fail(const char* what, const char* which) {
    fprintf(stderr, "%s %s\n", what, which);
    exit(1);
}

static void open_library(const char* path) {
#ifdef _WIN32
    _setmode(_fileno(stdin), _O_BINARY);
    _setmode(_fileno(stdout), _O_BINARY);
    library = (void*)LoadLibraryA(path);
#else
    library = dlopen(path, RTLD_NOW);
#endif
    if (!library)
        fail("cannot load", path);
}

static void* symbol(const char* name) {
#ifdef _WIN32
    void* found = (void*)GetProcAddress((HMODULE)library, name);
#else
    void* found = dlsym(library, name);
#endif
    if (!found)
        fail("the library has no", name);
    return found;
}

static void read_all(void* into, size_t size) {
    if (size && fread(into, 1, size, stdin) != size)
        fail("a call is cut off", "");
}

// Memory for so many bytes, kept for the next call.
static void* room(void** kept, size_t* capacity, size_t size) {
    if (size > *capacity) {
        free(*kept);
        *capacity = 2 * size;
        *kept = malloc(*capacity + ALIGNMENT);
        if (!*kept)
            fail("out of", "memory");
    }
    return (void*)(((uintptr_t)*kept + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT);
}

static void* image_memory;
static void* place_memory;
static size_t image_capacity, place_capacity;

static void make(const struct Call* call) {
    char* image = room(&image_memory, &image_capacity, call->size);
    const size_t pointer_bytes = call->pointer_count * sizeof(uint64_t);
    const size_t function_bytes = call->function_count * sizeof(struct FunctionPlace);
    char* places = room(&place_memory, &place_capacity, pointer_bytes + function_bytes);
    const uint64_t* pointers = (const uint64_t*)places;
    const struct FunctionPlace* functions = (const struct FunctionPlace*)(places + pointer_bytes);
    read_all(places, pointer_bytes + function_bytes);
    read_all(image, call->size);
    for (uint64_t i = 0; i < call->pointer_count; ++i) {
        uint64_t value;
        memcpy(&value, image + pointers[i], sizeof value);
        value += (uintptr_t)image;
        memcpy(image + pointers[i], &value, sizeof value);
    }
    for (uint64_t i = 0; i < call->function_count; ++i) {
        const uint64_t value = (uintptr_t)symbol(functions[i].function);
        memcpy(image + functions[i].offset, &value, sizeof value);
    }
    void (*function)(void*, void*, void*) = (void (*)(void*, void*, void*))symbol(call->function);
    function(image + call->first, image + call->second, image + call->third);
    if (fwrite(image, 1, call->size, stdout) != call->size || fflush(stdout))
        fail("nobody reads the", "results");
}

int main(int count, char** arguments) {
    struct Call call;
    if (count != 2)
        fail("expected the path of", "a library");
    open_library(arguments[1]);
    // Who starts this learns from it which library it is.
    fputs((const char*)symbol("carom_digest"), stdout);
    fputc('\n', stdout);
    fflush(stdout);
    while (fread(&call, sizeof call, 1, stdin) == 1)
        make(&call);
    return 0;
}
