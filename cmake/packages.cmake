# Packages, made by scripts/package: Debian packages of the tools, the module for further image formats, the library and
# the Python module, and one archive of all of it that runs in any folder.
set(CPACK_PACKAGE_NAME relief)
set(CPACK_PACKAGE_VENDOR "The relief authors")
# Debian requires the address of the person who makes the packages.
set(CPACK_PACKAGE_CONTACT "The relief authors <$ENV{DEBEMAIL}>")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_GENERATOR DEB)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL tools formats development)
# The archive runs on this system and processor only.
string(TOLOWER ${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR} platform)
set(CPACK_PACKAGE_FILE_NAME relief-${PROJECT_VERSION}-${platform})
if(TARGET relief_python)
    list(APPEND CPACK_COMPONENTS_ALL python)
endif()

set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
# Debian sorts "~" before the release.
string(REPLACE - ~ CPACK_PACKAGE_VERSION ${PROJECT_VERSION}${version_suffix})
set(version ${CPACK_PACKAGE_VERSION}-1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
# Copyrights, changelogs and compressed manual pages, as Debian's policy requires them.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package_documents.cmake)
set(CPACK_RELIEF_SOURCE_DIR ${PROJECT_SOURCE_DIR})

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME relief)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
# The drivers of OpenGL are loaded when a picture is drawn: by OSMesa, or, where Mesa has none since 25.1, by EGL.
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS "libosmesa6 | libegl-mesa0, libegl1, libegl-mesa0, libgl1-mesa-dri")
# The font of the window.
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS "relief-image-formats (= ${version}), fonts-dejavu-core")
set(CPACK_DEBIAN_TOOLS_DESCRIPTION
    "surface detail: normals, tangents, normal maps, baking and rendering
relief computes vertex normals and MikkTSpace tangents, converts height maps to
normal maps, checks and converts normal maps, bakes the detail of dense meshes
onto coarse ones, and renders the result with OpenGL, also without a GPU and a
display. It measures the error and the time of each method.
.
This package has the tools relief-mesh, relief-bake, relief-view and
relief-accuracy, which read and write PNG, JPEG, KTX2 and DDS images.")

set(CPACK_DEBIAN_FORMATS_PACKAGE_NAME relief-image-formats)
set(CPACK_DEBIAN_FORMATS_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_FORMATS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_FORMATS_DESCRIPTION
    "surface detail: more image formats
relief computes vertex normals and MikkTSpace tangents, converts height maps to
normal maps, bakes detail onto coarse meshes, and renders the result.
.
This package has the module by which the tools, the library and the Python
module read and write EXR, HDR, TIFF and other images with OpenImageIO.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME librelief-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libglm-dev, libfmt-dev, libtbb-dev, libtinyobjloader-dev, \
libmeshoptimizer-dev, libdraco-dev, libdeflate-dev, libisal-dev, libturbojpeg0-dev, libzstd-dev, libembree-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "relief-image-formats (= ${version})")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
    "surface detail: the C++ libraries
relief computes vertex normals and MikkTSpace tangents, converts height maps to
normal maps, bakes detail onto coarse meshes, and renders the result.
.
This package has the static libraries, their headers, and the files of CMake
and pkg-config that find them.")

if(TARGET relief_python)
    # The module is for the version of Python that it was compiled for.
    find_package(Python 3.11 QUIET COMPONENTS Interpreter)
    set(this_python ${Python_VERSION_MINOR})
    math(EXPR next_python ${this_python}+1)
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-relief)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "relief (= ${version}), python3 (>= 3.${this_python}), python3 (<< 3.${next_python}), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/python3-relief/prerm)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION
    "surface detail: the Python module
relief computes vertex normals and MikkTSpace tangents, converts height maps to
normal maps, bakes detail onto coarse meshes, and renders the result.
.
This package has the Python module relief, which takes and returns arrays of
NumPy.")

include(CPack)
