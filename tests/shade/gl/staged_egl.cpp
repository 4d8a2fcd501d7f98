// SPDX-License-Identifier: Apache-2.0
// A libEGL with the devices that STAGED_EGL_DEVICES names. With it, context_test.cpp tests machines
// with other devices. Working devices use the surfaceless platform of the real library. Devices:
//   gpu       works, and its renderer is called "Staged GPU"
//   adapter   reports hardware, but rasterizes on the processor
//   broken    cannot be initialized (no permission, no driver)
//   windowed  can only be made current with a surface
//   old       has no OpenGL 3.3
//   es        has OpenGL ES only
//   software  reports software, like the rasterizer of Mesa
//   alone     is not a device, but removes the surfaceless platform
// If the variable is empty, devices cannot be listed at all.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include <cstdlib>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Device {
    std::string kind;
    EGLDisplay real = EGL_NO_DISPLAY;
};

template <typename Function>
Function real(const char* name) {
    static void* const library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    return reinterpret_cast<Function>(dlsym(library, name));
}

template <typename Function>
Function real_extension(const char* name) {
    return reinterpret_cast<Function>(real<PFNEGLGETPROCADDRESSPROC>("eglGetProcAddress")(name));
}

thread_local EGLint last_error = EGL_SUCCESS;
thread_local const Device* current = nullptr;
thread_local const Device* bound = nullptr;  ///< The device that was initialized last.

EGLBoolean fail(EGLint error) {
    last_error = error;
    return EGL_FALSE;
}

/// The requested devices. They are never destroyed, like those of EGL.
std::vector<Device*> staged_devices() {
    static auto* const known = new std::map<std::string, Device>;
    const char* names = std::getenv("STAGED_EGL_DEVICES");
    std::istringstream stream(names == nullptr ? "" : names);
    std::vector<Device*> devices;
    for (std::string kind; stream >> kind;) {
        if (kind == "alone") continue;
        devices.push_back(&known->try_emplace(kind, Device{kind}).first->second);
    }
    return devices;
}

Device& device_of(EGLDisplay display) {
    return *static_cast<Device*>(display);
}

EGLBoolean query_devices(EGLint most, EGLDeviceEXT* devices, EGLint* count) {
    const std::vector<Device*> staged = staged_devices();
    *count = static_cast<EGLint>(staged.size());
    for (EGLint i = 0; devices != nullptr && i < most && i < *count; ++i) {
        devices[i] = staged[static_cast<std::size_t>(i)];
    }
    return EGL_TRUE;
}

const char* query_device_string(EGLDeviceEXT device, EGLint /*name*/) {
    return static_cast<Device*>(device)->kind == "software"
               ? "EGL_EXT_device_query_name EGL_MESA_device_software"
               : "EGL_EXT_device_query_name";
}

EGLDisplay get_platform_display(EGLenum platform, void* native, const EGLint* /*attributes*/) {
    static Device surfaceless{"software"};
    Device* device =
        platform == EGL_PLATFORM_DEVICE_EXT ? static_cast<Device*>(native) : &surfaceless;
    device->real = real_extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT")(
        EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    return device;
}

const unsigned char* get_string(unsigned name) {
    constexpr unsigned gl_renderer = 0x1F01;
    if (name == gl_renderer && current != nullptr && current->kind == "gpu") {
        return reinterpret_cast<const unsigned char*>("Staged GPU");
    }
    return real_extension<const unsigned char* (*)(unsigned)>("glGetString")(name);
}

}  // namespace

extern "C" {

const char* eglQueryString(EGLDisplay display, EGLint name) {
    if (display != EGL_NO_DISPLAY) {
        return device_of(display).kind == "windowed"
                   ? "EGL_KHR_no_config_context EGL_KHR_create_context"
                   : real<PFNEGLQUERYSTRINGPROC>("eglQueryString")(device_of(display).real, name);
    }
    if (staged_devices().empty()) return "EGL_EXT_platform_base EGL_MESA_platform_surfaceless";
    const bool is_alone = std::strstr(std::getenv("STAGED_EGL_DEVICES"), "alone") != nullptr;
    return is_alone ? "EGL_EXT_device_base EGL_EXT_platform_device"
                    : "EGL_EXT_device_base EGL_EXT_platform_device EGL_MESA_platform_surfaceless";
}

EGLint eglGetError() {
    return last_error;
}

EGLBoolean eglInitialize(EGLDisplay display, EGLint* major, EGLint* minor) {
    bound = &device_of(display);
    if (bound->kind == "broken") return fail(EGL_NOT_INITIALIZED);
    return real<PFNEGLINITIALIZEPROC>("eglInitialize")(bound->real, major, minor);
}

EGLBoolean eglBindAPI(EGLenum api) {
    if (bound->kind == "es") return fail(EGL_BAD_PARAMETER);
    return real<PFNEGLBINDAPIPROC>("eglBindAPI")(api);
}

EGLContext eglCreateContext(EGLDisplay display, EGLConfig config, EGLContext shared,
                            const EGLint* attributes) {
    if (device_of(display).kind == "old") {
        last_error = EGL_BAD_MATCH;
        return EGL_NO_CONTEXT;
    }
    return real<PFNEGLCREATECONTEXTPROC>("eglCreateContext")(device_of(display).real, config,
                                                             shared, attributes);
}

EGLBoolean eglDestroyContext(EGLDisplay display, EGLContext context) {
    return real<PFNEGLDESTROYCONTEXTPROC>("eglDestroyContext")(device_of(display).real, context);
}

EGLBoolean eglMakeCurrent(EGLDisplay display, EGLSurface draw, EGLSurface read,
                          EGLContext context) {
    current = context == EGL_NO_CONTEXT ? nullptr : &device_of(display);
    return real<PFNEGLMAKECURRENTPROC>("eglMakeCurrent")(device_of(display).real, draw, read,
                                                         context);
}

__eglMustCastToProperFunctionPointerType eglGetProcAddress(const char* name) {
    using Any = __eglMustCastToProperFunctionPointerType;
    const std::string wanted = name;
    if (wanted == "eglQueryDevicesEXT") return reinterpret_cast<Any>(query_devices);
    if (wanted == "eglQueryDeviceStringEXT") return reinterpret_cast<Any>(query_device_string);
    if (wanted == "eglGetPlatformDisplayEXT") return reinterpret_cast<Any>(get_platform_display);
    if (wanted == "glGetString") return reinterpret_cast<Any>(get_string);
    return real<PFNEGLGETPROCADDRESSPROC>("eglGetProcAddress")(name);
}
}
