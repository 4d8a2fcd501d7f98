// SPDX-License-Identifier: Apache-2.0
// Contexts from OSMesa, Mesa's rasteriser into memory: OpenGL 3.3 core, on the processor, without
// any display or device. Everything is drawn into relief's own framebuffers; the surface that
// OSMesa asks for is one pixel. Tests: tests/shade/gl/context_test.cpp.
#include <array>

#include "gl/dynamic_library.h"
#include "gl/platform_context.h"
#include "relief/shade/error.h"

namespace relief::gl {

namespace {

// The few entry points and constants needed, declared here rather than by GL/osmesa.h: that header
// is gone from new versions of Mesa, while the library may still be there at run time, and it
// brings GL/gl.h, which contradicts glad's.
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

}  // namespace relief::gl
