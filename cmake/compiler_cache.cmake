# Compiles through ccache where it is installed, so that a second clone or a second CI run compiles only
# what changed. -DRELIEF_CCACHE=OFF compiles without it.
#
# CCACHE_BASEDIR and CCACHE_NOHASHDIR let a clone in another folder hit the same entries. The sloppiness is
# what ccache requires for precompiled headers: it cannot see macros that a precompiled header hides. GCC must
# write its precompiled headers into the preprocessed text (-fpch-preprocess) for ccache to hash them. Clang must
# leave the times of headers out of its own; they hold absolute paths, so with Clang only a clone in the same folder
# hits the cache.
option(RELIEF_CCACHE "Compile through ccache where it is installed" ON)
find_program(RELIEF_CCACHE_PROGRAM ccache)
if(RELIEF_CCACHE AND RELIEF_CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    foreach(language C CXX)
        set(CMAKE_${language}_COMPILER_LAUNCHER
            ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
            CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
            ${RELIEF_CCACHE_PROGRAM})
    endforeach()
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
        add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)
    elseif(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
        add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang -fno-pch-timestamp>")
    endif()
endif()
