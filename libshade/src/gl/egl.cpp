// SPDX-License-Identifier: Apache-2.0
// Contexts from EGL without any window: on a device (a GPU, or Mesa's rasteriser, which EGL lists
// as a device too), or on Mesa's surfaceless platform. OpenGL 3.3 core, current without a surface.
// Source: the specifications EGL 1.5, EGL_EXT_device_enumeration, EGL_EXT_device_query,
// EGL_EXT_platform_device, EGL_MESA_device_software, EGL_MESA_platform_surfaceless,
// EGL_KHR_no_config_context, EGL_KHR_surfaceless_context, EGL_KHR_create_context.
// Tests: tests/shade/gl/context_test.cpp.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <array>
#include <string_view>

#include "gl/dynamic_library.h"
#include "gl/platform_context.h"
#include "relief/shade/error.h"

namespace relief::gl {

namespace {

/// Whether a list of names separated by blanks holds this one, whole.
bool holds(const char* list, std::string_view name) {
    std::string_view rest = list == nullptr ? "" : list;
    while (!rest.empty()) {
        const std::size_t blank = rest.find(' ');
        if (rest.substr(0, blank) == name) return true;
        rest.remove_prefix(blank == std::string_view::npos ? rest.size() : blank + 1);
    }
    return false;
}

/// EGL's entry points, of the library and of the extensions.
struct Egl {
    static constexpr std::array<const char*, 1> names{"libEGL.so.1"};

    DynamicLibrary library{"RELIEF_EGL_LIBRARY", names};
    PFNEGLGETPROCADDRESSPROC get_proc_address =
        library.function<PFNEGLGETPROCADDRESSPROC>("eglGetProcAddress");
    PFNEGLQUERYSTRINGPROC query_string = library.function<PFNEGLQUERYSTRINGPROC>("eglQueryString");
    PFNEGLGETERRORPROC get_error = library.function<PFNEGLGETERRORPROC>("eglGetError");
    PFNEGLINITIALIZEPROC initialize = library.function<PFNEGLINITIALIZEPROC>("eglInitialize");
    PFNEGLBINDAPIPROC bind_api = library.function<PFNEGLBINDAPIPROC>("eglBindAPI");
    PFNEGLCREATECONTEXTPROC create_context =
        library.function<PFNEGLCREATECONTEXTPROC>("eglCreateContext");
    PFNEGLDESTROYCONTEXTPROC destroy_context =
        library.function<PFNEGLDESTROYCONTEXTPROC>("eglDestroyContext");
    PFNEGLMAKECURRENTPROC make_current = library.function<PFNEGLMAKECURRENTPROC>("eglMakeCurrent");

    /// Of the library, before any display. Null before EGL 1.5 and EGL_EXT_client_extensions.
    const char* client_extensions = query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    // Null where there is none: whoever uses one asks for its extension first.
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display =
        extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    PFNEGLQUERYDEVICESEXTPROC query_devices =
        extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string =
        extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");

    template <typename Function>
    [[nodiscard]] Function extension(const char* name) const {
        return reinterpret_cast<Function>(get_proc_address(name));
    }

    [[nodiscard]] bool has(std::string_view client_extension) const {
        return holds(client_extensions, client_extension);
    }
    [[nodiscard]] bool lists_devices() const {
        const bool enumerates = has("EGL_EXT_device_base") ||
                                (has("EGL_EXT_device_enumeration") && has("EGL_EXT_device_query"));
        return enumerates && has("EGL_EXT_platform_device") && get_platform_display != nullptr &&
               query_devices != nullptr && query_device_string != nullptr;
    }
    [[nodiscard]] bool is_surfaceless() const {
        return has("EGL_MESA_platform_surfaceless") && get_platform_display != nullptr;
    }
};

/// The reason for the last failure on this thread, for messages.
std::string reason(const Egl& egl) {
    const EGLint error = egl.get_error();
    switch (error) {
        case EGL_NOT_INITIALIZED:
            return "EGL_NOT_INITIALIZED";
        case EGL_BAD_ACCESS:
            return "EGL_BAD_ACCESS";
        case EGL_BAD_ALLOC:
            return "EGL_BAD_ALLOC";
        case EGL_BAD_ATTRIBUTE:
            return "EGL_BAD_ATTRIBUTE";
        case EGL_BAD_CONFIG:
            return "EGL_BAD_CONFIG";
        case EGL_BAD_CONTEXT:
            return "EGL_BAD_CONTEXT";
        case EGL_BAD_DISPLAY:
            return "EGL_BAD_DISPLAY";
        case EGL_BAD_MATCH:
            return "EGL_BAD_MATCH";
        case EGL_BAD_PARAMETER:
            return "EGL_BAD_PARAMETER";
        default:
            return fmt::format("EGL error 0x{:x}", error);
    }
}

EglDisplay display_of_device(const Egl& egl, EGLDeviceEXT device, std::size_t index) {
    const char* extensions = egl.query_device_string(device, EGL_EXTENSIONS);
    EglDisplay result;
    result.kind = holds(extensions, "EGL_MESA_device_software") ? EglDisplay::Kind::software
                                                                : EglDisplay::Kind::hardware;
    result.name = fmt::format("device {}", index);
    if (holds(extensions, "EGL_EXT_device_drm")) {
        const char* file = egl.query_device_string(device, EGL_DRM_DEVICE_FILE_EXT);
        if (file != nullptr) result.name += fmt::format(" ({})", file);
    }
    result.display = egl.get_platform_display(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
    return result;
}

std::vector<EGLDeviceEXT> devices(const Egl& egl) {
    EGLint count = 0;
    if (egl.query_devices(0, nullptr, &count) == EGL_FALSE) return {};
    std::vector<EGLDeviceEXT> found(static_cast<std::size_t>(count));
    if (egl.query_devices(count, found.data(), &count) == EGL_FALSE) return {};
    found.resize(static_cast<std::size_t>(count));
    return found;
}

/// A context on an initialised display.
class EglContext final : public PlatformContext {
  public:
    explicit EglContext(const EglDisplay& display) : display_(display.display) {
        initialize();
        create();
        if (egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
            const std::string why = reason(egl_);
            egl_.destroy_context(display_, context_);
            throw GpuError("eglMakeCurrent: " + why);
        }
    }

    ~EglContext() override {
        egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        egl_.destroy_context(display_, context_);
    }

    [[nodiscard]] Api::Loader loader() const override { return egl_.get_proc_address; }

  private:
    /// Displays are shared by all threads and stay initialised: eglTerminate would take the
    /// contexts of other threads along.
    void initialize() const {
        if (display_ == EGL_NO_DISPLAY) throw GpuError("eglGetPlatformDisplayEXT: no display");
        EGLint major = 0;
        EGLint minor = 0;
        if (egl_.initialize(display_, &major, &minor) == EGL_FALSE) {
            throw GpuError("eglInitialize: " + reason(egl_));
        }
        const char* extensions = egl_.query_string(display_, EGL_EXTENSIONS);
        for (const char* needed : {"EGL_KHR_no_config_context", "EGL_KHR_surfaceless_context"}) {
            if (!holds(extensions, needed)) throw GpuError(fmt::format("it lacks {}", needed));
        }
        // The profile attributes belong to 1.5, and before it to this extension.
        const bool chooses_profile =
            major > 1 || (major == 1 && minor >= 5) || holds(extensions, "EGL_KHR_create_context");
        if (!chooses_profile) throw GpuError("it lacks EGL_KHR_create_context");
    }

    void create() {
        // The choice between OpenGL and OpenGL ES belongs to the thread.
        if (egl_.bind_api(EGL_OPENGL_API) == EGL_FALSE) {
            throw GpuError("it has no OpenGL, only OpenGL ES");
        }
        const std::array<EGLint, 7> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                               3,
                                               EGL_CONTEXT_MINOR_VERSION,
                                               3,
                                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                               EGL_NONE};
        context_ =
            egl_.create_context(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
        if (context_ == EGL_NO_CONTEXT) {
            throw GpuError("it gives no OpenGL 3.3 core context: " + reason(egl_));
        }
    }

    Egl egl_;
    EGLDisplay display_;
    EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::vector<EglDisplay> egl_displays() {
    const Egl egl;
    std::vector<EglDisplay> displays;
    if (egl.lists_devices()) {
        for (EGLDeviceEXT device : devices(egl)) {
            displays.push_back(display_of_device(egl, device, displays.size()));
        }
    }
    if (egl.is_surfaceless()) {
        // With the devices listed, whatever this one leads to has been seen as a device.
        EglDisplay surfaceless;
        surfaceless.kind =
            displays.empty() ? EglDisplay::Kind::unknown : EglDisplay::Kind::software;
        surfaceless.name = "surfaceless";
        surfaceless.display =
            egl.get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        displays.push_back(surfaceless);
    }
    if (displays.empty()) {
        throw GpuError("it has neither EGL_EXT_platform_device nor EGL_MESA_platform_surfaceless");
    }
    return displays;
}

std::unique_ptr<PlatformContext> make_egl_context(const EglDisplay& display) {
    return std::make_unique<EglContext>(display);
}

}  // namespace relief::gl
