# Third parties without CMake files, or with files that cannot be used everywhere: Debian 12's libdeflate has none,
# and those of libjpeg-turbo, OpenImageIO and Draco name files that Debian's packages lack. The build reads this file,
# and so does find_package(relief), which finds the libraries of the computer that it runs on: installed files name no
# paths.

# A header, and the library by its names in order of preference. Draco is linked statically: a shared library would add
# 1 ms to every start of every tool, even if nothing is compressed.
set(relief_third_party_deflate libdeflate.h deflate)
set(relief_third_party_isal isa-l/igzip_lib.h isal)
set(relief_third_party_turbojpeg turbojpeg.h turbojpeg)
set(relief_third_party_zstd zstd.h zstd)
set(relief_third_party_draco draco/compression/decode.h libdraco.a draco)
set(relief_third_party_openimageio OpenImageIO/imageio.h OpenImageIO)
set(relief_third_party_openimageio_util OpenImageIO/imageio.h OpenImageIO_Util)
set(relief_third_party_imgui imgui.h imgui)
set(relief_third_party_stb "" stb libstb.so.0)

# relief_find_third_party(NAME RESULT): the target relief_third_party::NAME. RESULT becomes empty, or else states what
# is missing.
function(relief_find_third_party name result)
    set(${result} "" PARENT_SCOPE)
    if(TARGET relief_third_party::${name})
        return()
    endif()
    list(GET relief_third_party_${name} 0 header)
    list(SUBLIST relief_third_party_${name} 1 -1 names)
    string(TOUPPER RELIEF_${name} variable)
    find_library(${variable}_LIBRARY NAMES ${names})
    mark_as_advanced(${variable}_LIBRARY)
    set(missing "")
    if(NOT ${variable}_LIBRARY)
        list(JOIN names " or " missing)
        set(missing "the library ${missing}")
    endif()
    if(header)
        find_path(${variable}_INCLUDE ${header} PATH_SUFFIXES ${name})
        mark_as_advanced(${variable}_INCLUDE)
        if(NOT ${variable}_INCLUDE)
            set(missing "the header ${header}")
        endif()
    endif()
    if(missing)
        set(${result} "relief needs ${missing}" PARENT_SCOPE)
        return()
    endif()
    add_library(relief_third_party::${name} UNKNOWN IMPORTED)
    set_target_properties(relief_third_party::${name} PROPERTIES IMPORTED_LOCATION "${${variable}_LIBRARY}")
    if(header)
        set_target_properties(relief_third_party::${name} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES
                                                                     "${${variable}_INCLUDE}")
    endif()
endfunction()
