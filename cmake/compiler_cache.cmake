# Compiles through ccache where it is installed, so that a second clone or a second CI run compiles only
# what changed. -DRELIEF_CCACHE=OFF compiles without it.
#
# CCACHE_BASEDIR and CCACHE_NOHASHDIR let a clone in another folder hit the same entries, and so does a __FILE__ that is
# relative to the sources: every assertion of a test contains one. The sloppiness is what ccache requires for
# precompiled headers: it cannot see macros that a precompiled header hides. A script hashes their headers instead of
# their bytes. GCC must name precompiled headers in the preprocessed text (-fpch-preprocess) for ccache to notice them,
# and Clang must leave the times of headers out of its own.
option(RELIEF_CCACHE "Compile through ccache where it is installed" ON)
find_program(RELIEF_CCACHE_PROGRAM ccache)
if(RELIEF_CCACHE AND RELIEF_CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    foreach(language C CXX)
        set(CMAKE_${language}_COMPILER_LAUNCHER
            ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
            CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime)
    endforeach()
    if(CMAKE_HOST_UNIX)
        list(APPEND CMAKE_CXX_COMPILER_LAUNCHER CCACHE_PCH_EXTSUM=1
             ${CMAKE_CURRENT_LIST_DIR}/ccache-with-pch.sh)
    endif()
    if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
        add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang -fno-pch-timestamp>")
    else()
        add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fpch-preprocess>)
    endif()
    list(APPEND CMAKE_C_COMPILER_LAUNCHER ${RELIEF_CCACHE_PROGRAM})
    list(APPEND CMAKE_CXX_COMPILER_LAUNCHER ${RELIEF_CCACHE_PROGRAM})
    add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=>)
endif()
