# The toolchain of the preset `windows`: MinGW-w64 on Debian (g++-mingw-w64-x86-64-posix), whose programs need no other
# DLL than those of Windows.
#
# Debian has no libraries for MinGW, but GLM, fmt and nlohmann-json are headers. Their headers and CMake files are linked into a
# folder of the build tree, because /usr/include has headers of Linux, too.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)

get_property(in_try_compile GLOBAL PROPERTY IN_TRY_COMPILE)
if(NOT in_try_compile)
    set(packages ${CMAKE_BINARY_DIR}/packages)
    foreach(headers glm fmt nlohmann)
        if(NOT EXISTS /usr/include/${headers})
            message(FATAL_ERROR "/usr/include/${headers} is missing: see scripts/dev/install-dependencies")
        endif()
        file(MAKE_DIRECTORY ${packages}/include)
        file(CREATE_LINK /usr/include/${headers} ${packages}/include/${headers} SYMBOLIC)
    endforeach()
    file(COPY /usr/share/cmake/glm DESTINATION ${packages}/share/cmake)
    # Without fmt-targets-none.cmake, which names the library of Linux. Its headers are four folders up.
    file(GLOB fmt /usr/lib/*/cmake/fmt/fmt-config*.cmake /usr/lib/*/cmake/fmt/fmt-targets.cmake)
    file(COPY ${fmt} DESTINATION ${packages}/fmt/lib/cmake/fmt)
endif()
set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32 ${CMAKE_BINARY_DIR}/packages)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
