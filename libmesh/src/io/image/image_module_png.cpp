// SPDX-License-Identifier: Apache-2.0
// Keeps libpng from printing. OpenImageIO 2.4 lets it have its default handlers, which write errors
// and warnings to stderr; libraries of relief print nothing.
// The dynamic linker looks for the functions below in this module before it looks in libpng, so
// that OpenImageIO calls these; they hand on to libpng's own with handlers that stay silent. The
// error itself still reaches OpenImageIO, by the jump that libpng makes in either case. Where a
// program has libpng loaded for itself the linker finds that first, and errors print as ever.
// Tests: tests/mesh/io/image/image_file_real_test.cpp.
#include "io/image/image_module_png.h"

#include <dlfcn.h>

#include <cstdlib>
#include <utility>

namespace {

thread_local std::string complaint;

// The handlers' and functions' types as libpng 1.6 declares them, over opaque pointers.
using Handler = void (*)(void* png, const char* text);
using Create = void* (*)(const char* version, void* receiver, Handler error, Handler warning);
using SetHandlers = void (*)(void* png, void* receiver, Handler error, Handler warning);
using Jump = void (*)(void* png, int value);

template <typename Function>
Function in_libpng(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

[[noreturn]] void leave_by_jump(void* png, const char* text) {
    complaint = text;
    if (const auto jump = in_libpng<Jump>("png_longjmp")) jump(png, 1);
    std::abort();  // An error handler must not return, and without the jump there is no way on.
}

void say_nothing(void*, const char*) {}

}  // namespace

namespace relief {

std::string last_png_complaint() {
    return std::exchange(complaint, {});
}

}  // namespace relief

extern "C" __attribute__((visibility("default"))) void* png_create_read_struct(const char* version,
                                                                               void*, Handler,
                                                                               Handler) {
    const auto create = in_libpng<Create>("png_create_read_struct");
    return create == nullptr ? nullptr : create(version, nullptr, leave_by_jump, say_nothing);
}

extern "C" __attribute__((visibility("default"))) void png_set_error_fn(void* png, void* receiver,
                                                                        Handler, Handler) {
    if (const auto set = in_libpng<SetHandlers>("png_set_error_fn"))
        set(png, receiver, leave_by_jump, say_nothing);
}
