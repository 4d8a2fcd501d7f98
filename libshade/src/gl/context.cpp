// SPDX-License-Identifier: Apache-2.0
// Contexts: the libraries that provide them, the choice among these, and the reasons if none works.
//
// OpenGL 3.3 core contexts without a window, from libraries that are loaded at run time.
//
// OSMesa is Mesa's rasterizer into memory: no display or device is needed. relief draws into its
// own framebuffers only; the surface that OSMesa requires has one pixel. EGL provides contexts on a
// device (a GPU, or Mesa's rasterizer, which EGL lists as a device too), or on Mesa's surfaceless
// platform; they are current without a surface. Sources: the specifications EGL 1.5,
// EGL_EXT_device_enumeration, EGL_EXT_device_query, EGL_EXT_platform_device,
// EGL_MESA_device_software, EGL_MESA_platform_surfaceless, EGL_KHR_no_config_context,
// EGL_KHR_surfaceless_context, EGL_KHR_create_context.
#include "relief/shade/renderer.h"

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cassert>
#include <cstdlib>
#include <span>
#include <string_view>
#include <thread>

#include "gl/api.h"

namespace relief::shade::gl {

// Libraries

namespace {

std::string loader_message() {
    const char* message = dlerror();
    return message == nullptr ? "unknown reason" : message;
}

/// A library loaded at run time. It stays loaded until the process ends, since drivers leave
/// threads and exit handlers behind that need their code.
class DynamicLibrary {
  public:
    /// Loads the first of `names` that exists.
    ///
    /// \param variable  an environment variable; if set and not empty, the only name tried
    /// \throws GpuError with the loader's message for every name tried
    DynamicLibrary(const char* variable, std::span<const char* const> names);

    /// Returns a function of the library. \throws GpuError if it has none of this name
    template <typename Function>
    Function function(const char* name) const {
        return reinterpret_cast<Function>(symbol(name));
    }

  private:
    void* symbol(const char* name) const;

    void* library_ = nullptr;
    std::string name_;
};

DynamicLibrary::DynamicLibrary(const char* variable, std::span<const char* const> names) {
    const char* chosen = std::getenv(variable);
    const bool is_chosen = chosen != nullptr && *chosen != '\0';
    if (is_chosen) names = std::span(&chosen, 1);
    std::string reasons;
    for (const char* name : names) {
        // RTLD_LOCAL: OSMesa has a second set of gl... symbols, which must not replace others.
        library_ = dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        if (library_ != nullptr) {
            name_ = name;
            return;
        }
        reasons += (reasons.empty() ? "" : "; ") + loader_message();
    }
    throw GpuError(is_chosen ? fmt::format("{} ({} is set)", reasons, variable) : reasons);
}

void* DynamicLibrary::symbol(const char* name) const {
    void* function = dlsym(library_, name);
    if (function == nullptr) throw GpuError(fmt::format("{} has no function {}", name_, name));
    return function;
}

}  // namespace

// OSMesa

namespace {

// The necessary entry points and constants are declared here, because GL/osmesa.h is missing from
// new versions of Mesa, whose library may still exist at run time, and because it includes GL/gl.h,
// which contradicts glad's header.
using OsmesaContext = struct osmesa_context*;
using CreateContextAttribs = OsmesaContext (*)(const int* attributes, OsmesaContext shared);
using DestroyContext = void (*)(OsmesaContext);
using MakeCurrent = GLboolean (*)(OsmesaContext, void* pixels, GLenum type, GLsizei width,
                                  GLsizei height);

constexpr int osmesa_format = 0x22;
constexpr int osmesa_depth_bits = 0x30;
constexpr int osmesa_profile = 0x33;
constexpr int osmesa_core_profile = 0x34;
constexpr int osmesa_context_major_version = 0x36;
constexpr int osmesa_context_minor_version = 0x37;

class Osmesa final : public PlatformContext {
  public:
    Osmesa() {
        const std::array<int, 11> attributes{osmesa_format,
                                             GL_RGBA,
                                             osmesa_depth_bits,
                                             0,
                                             osmesa_profile,
                                             osmesa_core_profile,
                                             osmesa_context_major_version,
                                             3,
                                             osmesa_context_minor_version,
                                             3,
                                             0};
        context_ = create_(attributes.data(), nullptr);
        if (context_ == nullptr) throw GpuError("it gives no OpenGL 3.3 core context");
        if (make_current_(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) == GL_FALSE) {
            destroy_(context_);
            throw GpuError("it cannot make its context current");
        }
    }

    ~Osmesa() override {
        make_current_(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
        destroy_(context_);
    }

    [[nodiscard]] Api::Loader loader() const override { return loader_; }

  private:
    static constexpr std::array<const char*, 3> names{"libOSMesa.so.8", "libOSMesa.so.6",
                                                      "libOSMesa.so"};

    DynamicLibrary library_{"RELIEF_OSMESA_LIBRARY", names};
    CreateContextAttribs create_ =
        library_.function<CreateContextAttribs>("OSMesaCreateContextAttribs");
    DestroyContext destroy_ = library_.function<DestroyContext>("OSMesaDestroyContext");
    MakeCurrent make_current_ = library_.function<MakeCurrent>("OSMesaMakeCurrent");
    Api::Loader loader_ = library_.function<Api::Loader>("OSMesaGetProcAddress");
    std::array<unsigned char, 4> pixel_{};
    OsmesaContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<PlatformContext> make_osmesa_context() {
    return std::make_unique<Osmesa>();
}

// EGL

namespace {

/// Tells whether a list of names separated by blanks contains this name.
bool holds(const char* list, std::string_view name) {
    std::string_view rest = list == nullptr ? "" : list;
    while (!rest.empty()) {
        const std::size_t blank = rest.find(' ');
        if (rest.substr(0, blank) == name) return true;
        rest.remove_prefix(blank == std::string_view::npos ? rest.size() : blank + 1);
    }
    return false;
}

/// The entry points of EGL and of its extensions.
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

    /// The extensions that need no display. Null before EGL 1.5 without EGL_EXT_client_extensions.
    const char* client_extensions = query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    // These are null without their extensions, which callers check first.
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

/// Returns the reason for the last failure on this thread, for messages.
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
    std::vector<EGLDeviceEXT> all(static_cast<std::size_t>(count));
    if (egl.query_devices(count, all.data(), &count) == EGL_FALSE) return {};
    all.resize(static_cast<std::size_t>(count));
    return all;
}

/// A context on an initialized display.
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
    /// Displays are shared by all threads and stay initialized, since eglTerminate would destroy
    /// the contexts of other threads.
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
        // The profile attributes are part of EGL 1.5; before, they need this extension.
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
        // If devices are listed, the device of this platform is one of them.
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

}  // namespace relief::shade::gl

namespace relief::shade {

namespace {

/// True if this thread has a Context. OSMesa and EGL would not notice that both are current.
thread_local bool thread_has_context = false;

/// A context that works.
struct Opened {
    std::unique_ptr<gl::PlatformContext> platform;  ///< Empty if the caller owns it.
    std::unique_ptr<gl::Api> api;
    std::string name;
};

/// The failed attempts: "OSMesa: libOSMesa.so.8: cannot open shared object file; ...".
using Failures = std::vector<std::string>;

/// Returns the table of a context that has just been made current.
Opened with_api(std::unique_ptr<gl::PlatformContext> platform, std::string name) {
    auto api = std::make_unique<gl::Api>(platform->loader());
    return {std::move(platform), std::move(api), std::move(name)};
}

Opened open_osmesa(Failures& failures) {
    try {
        return with_api(gl::make_osmesa_context(), "OSMesa");
    } catch (const GpuError& error) {
        failures.push_back(fmt::format("OSMesa: {}", error.what()));
        return {};
    }
}

Opened open_egl(bool hardware, Failures& failures) {
    const char* title = hardware ? "EGL (hardware)" : "EGL (software)";
    std::vector<gl::EglDisplay> displays;
    try {
        displays = gl::egl_displays();
    } catch (const GpuError& error) {
        failures.push_back(fmt::format("{}: {}", title, error.what()));
        return {};
    }
    const gl::EglDisplay::Kind other =
        hardware ? gl::EglDisplay::Kind::software : gl::EglDisplay::Kind::hardware;
    bool tried = false;
    for (const gl::EglDisplay& display : displays) {
        if (display.kind == other) continue;
        tried = true;
        try {
            Opened opened = with_api(gl::make_egl_context(display), title);
            // A display adapter without a driver is rasterized on the processor as well.
            if (opened.api->is_software() != hardware) return opened;
            failures.push_back(fmt::format("{}: {}: it is drawn by {}", title, display.name,
                                           opened.api->renderer()));
        } catch (const GpuError& error) {
            failures.push_back(fmt::format("{}: {}: {}", title, display.name, error.what()));
        }
    }
    if (!tried) failures.push_back(fmt::format("{}: there is no such device", title));
    return {};
}

void require_no_context() {
    if (thread_has_context)
        throw InvalidInput("this thread has an OpenGL context already; destroy it first");
}

Opened open(Backend backend, Failures& failures) {
    Opened opened;
    if (backend != Backend::osmesa) opened = open_egl(true, failures);
    if (!opened.api && backend != Backend::egl) opened = open_osmesa(failures);
    if (!opened.api && backend != Backend::osmesa) opened = open_egl(false, failures);
    return opened;
}

}  // namespace

struct Context::Implementation {
    explicit Implementation(Opened made)
        : opened(std::move(made)),
          renderer_name(fmt::format("{}, {}", opened.api->renderer(), opened.api->version())) {}

    Opened opened;
    std::string renderer_name;
    std::thread::id thread = std::this_thread::get_id();
};

Context::Context(Backend backend) {
    require_no_context();
    Failures failures;
    Opened opened = open(backend, failures);
    if (!opened.api) {
        throw GpuError(
            fmt::format("no OpenGL 3.3 context could be made: {}", fmt::join(failures, "; ")));
    }
    implementation_ = std::make_unique<Implementation>(std::move(opened));
    thread_has_context = true;
}

Context::Context(GlLoader loader, std::string name) {
    require_no_context();
    implementation_ = std::make_unique<Implementation>(
        Opened{nullptr, std::make_unique<gl::Api>(loader), std::move(name)});
    thread_has_context = true;
}

Context::~Context() {
    assert(implementation_->thread == std::this_thread::get_id() &&
           "a context is destroyed on the thread that made it");
    assert(implementation_->opened.api->live_names() == 0 &&
           "whatever lives in a context goes before it");
    implementation_->opened.api.reset();  // The context must outlive it.
    implementation_.reset();
    thread_has_context = false;
}

const std::string& Context::backend_name() const {
    return implementation_->opened.name;
}
const std::string& Context::renderer_name() const {
    return implementation_->renderer_name;
}

bool Context::is_software() const {
    return api().is_software();
}

const gl::Api& Context::api() const {
    return *implementation_->opened.api;
}

}  // namespace relief::shade
