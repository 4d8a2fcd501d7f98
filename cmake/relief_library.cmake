# The components of the library: which are built, how, and how they are installed and found.
include(CMakePackageConfigHelpers)
include(relief-third-parties)

# Parallel loops run on oneTBB's threads, or on those of the standard library in systems without it.
set(RELIEF_TBB AUTO CACHE STRING "Use oneTBB: ON, OFF, or AUTO: where it is installed")
if(RELIEF_TBB STREQUAL AUTO)
    find_package(TBB QUIET)
elseif(RELIEF_TBB)
    find_package(TBB REQUIRED)
endif()
if(RELIEF_TBB AND TBB_FOUND)
    set(RELIEF_HAS_TBB 1)
else()
    set(RELIEF_HAS_TBB 0)
    find_package(Threads REQUIRED)
    message(STATUS "relief: parallel loops use threads of the standard library, not oneTBB")
endif()

# Each component stands after those that it needs. The packages of CMake (NAME or NAME=VERSION), third parties of
# relief-third-parties.cmake, packages of pkg-config, and the libraries that it does not know, are for programs that
# link an installed static component.
set(RELIEF_ALL mesh topology atlas files bake c shade reference accuracy make)
if(NOT RELIEF_FMT_HEADERS)
    list(APPEND RELIEF_PACKAGES_mesh fmt)
    list(APPEND RELIEF_PKG_CONFIG_mesh fmt)
endif()
if(RELIEF_HAS_TBB)
    list(APPEND RELIEF_PACKAGES_mesh TBB)
    list(APPEND RELIEF_PKG_CONFIG_mesh tbb)
else()
    list(APPEND RELIEF_PACKAGES_mesh Threads)
    list(APPEND RELIEF_LIBRARIES_mesh ${CMAKE_THREAD_LIBS_INIT})
endif()
set(RELIEF_NEEDED_BY_topology mesh)
set(RELIEF_NEEDED_BY_atlas mesh)
set(RELIEF_NEEDED_BY_files mesh)
set(RELIEF_PACKAGES_files tinyobjloader meshoptimizer)
set(RELIEF_THIRD_PARTIES_files deflate isal turbojpeg zstd draco)
set(RELIEF_PKG_CONFIG_files tinyobjloader libdeflate libisal libturbojpeg libzstd draco)
set(RELIEF_LIBRARIES_files -lmeshoptimizer -Wl,-rpath,\${libdir}/relief)
set(RELIEF_NEEDED_BY_bake mesh)
set(RELIEF_NEEDED_BY_c mesh atlas)
option(RELIEF_C_BAKE "Build relief_bake() of the C interface, which needs the component bake" ON)
if(RELIEF_C_BAKE)
    list(APPEND RELIEF_NEEDED_BY_c bake)
endif()
# See libmesh/src/c/CMakeLists.txt.
set(RELIEF_LIBRARIES_c -lstdc++ -lm)
set(RELIEF_NEEDED_BY_shade files)
set(RELIEF_NEEDED_BY_reference shade bake)
set(RELIEF_NEEDED_BY_accuracy reference topology atlas)
set(RELIEF_NEEDED_BY_make topology atlas files bake)

# The default names no components, so that an existing build folder gets those that are added later. Folders of versions
# without `make` have the list of that time, which was the default, in their cache.
if("${RELIEF_COMPONENTS}" STREQUAL "mesh;topology;atlas;files;bake;c;shade;reference;accuracy")
    unset(RELIEF_COMPONENTS CACHE)
endif()
set(RELIEF_COMPONENTS "all" CACHE STRING "Components to build, to which those that they need are added; or all")
if(RELIEF_COMPONENTS STREQUAL "all")
    set(RELIEF_BUILT ${RELIEF_ALL})
else()
    set(RELIEF_BUILT ${RELIEF_COMPONENTS})
endif()
foreach(component IN LISTS RELIEF_BUILT)
    if(NOT component IN_LIST RELIEF_ALL)
        message(FATAL_ERROR "RELIEF_COMPONENTS: '${component}' is not one of ${RELIEF_ALL}")
    endif()
endforeach()
set(RELIEF_BACKWARDS ${RELIEF_ALL})
list(REVERSE RELIEF_BACKWARDS)
foreach(component IN LISTS RELIEF_BACKWARDS)
    if(component IN_LIST RELIEF_BUILT)
        list(APPEND RELIEF_BUILT ${RELIEF_NEEDED_BY_${component}})
    endif()
endforeach()
list(REMOVE_DUPLICATES RELIEF_BUILT)

# relief_require_third_parties(NAMES...): the targets relief_third_party::NAME.
function(relief_require_third_parties)
    foreach(name IN LISTS ARGN)
        relief_find_third_party(${name} missing)
        if(missing)
            message(FATAL_ERROR "${missing}")
        endif()
    endforeach()
endfunction()
if("files" IN_LIST RELIEF_BUILT)
    relief_require_third_parties(${RELIEF_THIRD_PARTIES_files})
endif()

# Rays are cast with Embree 4 or 3, which libmesh/src/bake/embree_scene.cpp both supports. The functions of both have
# the same names, so programs that link the component must use the same version.
if("bake" IN_LIST RELIEF_BUILT)
    find_package(embree 4 QUIET)
    if(NOT embree_FOUND)
        find_package(embree 3 REQUIRED)
    endif()
    set(RELIEF_PACKAGES_bake embree=${embree_VERSION_MAJOR})
    set(RELIEF_LIBRARIES_bake -lembree${embree_VERSION_MAJOR})
endif()

# Libraries that are loaded when they are needed.
set(RELIEF_MODULE_DIRECTORY ${CMAKE_INSTALL_LIBDIR}/relief)
# Installed programs and libraries find the libraries of their own tree, wherever it is moved.
if(BUILD_SHARED_LIBS)
    file(RELATIVE_PATH lib_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
    set(CMAKE_INSTALL_RPATH $ORIGIN $ORIGIN/${lib_from_bin})
endif()

# relief_hide_third_parties(TARGET): a shared library exports nothing of its static third parties, such as Draco. This
# is an option of ELF linkers.
function(relief_hide_third_parties target)
    if(BUILD_SHARED_LIBS AND UNIX AND NOT APPLE)
        target_link_options(${target} PRIVATE LINKER:--exclude-libs,ALL)
    endif()
endfunction()

# relief_add_library(COMPONENT FOLDER [PRIVATE TARGETS...]): the target relief::COMPONENT with the public headers in
# FOLDER/include and the private ones in FOLDER/src, linked with the components that it needs.
function(relief_add_library component folder)
    cmake_parse_arguments(ARG "" "" "PRIVATE" ${ARGN})
    set(target relief_${component})
    add_library(${target})
    add_library(relief::${component} ALIAS ${target})
    relief_position_independent(${target})
    # A minor version may add members to structs, which changes the binary interface.
    set_target_properties(
        ${target}
        PROPERTIES EXPORT_NAME ${component}
                   VERSION ${PROJECT_VERSION}
                   SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
                   DEFINE_SYMBOL "")
    set(needed ${RELIEF_NEEDED_BY_${component}})
    list(TRANSFORM needed PREPEND relief::)
    set(interface PUBLIC)
    if(component STREQUAL c)  # Its header needs no other, and programs in C have no standard of C++.
        set(interface PRIVATE)
    endif()
    target_compile_features(${target} ${interface} cxx_std_20)
    target_include_directories(
        ${target}
        PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/${folder}/include>
               $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
        PRIVATE ${PROJECT_SOURCE_DIR}/${folder}/src)
    target_link_libraries(
        ${target}
        ${interface} ${needed}
        PRIVATE $<BUILD_INTERFACE:relief_flags> ${RELIEF_FMT} ${ARG_PRIVATE})
    relief_precompile(${target} LIKE relief_precompiled)
    relief_batch(${target} 5)
    relief_hide_third_parties(${target})
    if(RELIEF_INSTALL)
        install(
            TARGETS ${target}
            EXPORT relief-${component}
            COMPONENT development)
        install(
            EXPORT relief-${component}
            NAMESPACE relief::
            DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/relief
            COMPONENT development)
        install(
            DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}/include/
            TYPE INCLUDE
            COMPONENT development)
    endif()
endfunction()

# Installs what find_package(relief) and pkg-config read. Both find their files relative to their own.
function(relief_install_package)
    if(NOT RELIEF_INSTALL)
        return()
    endif()
    set(tables "")
    foreach(component IN LISTS RELIEF_ALL)
        string(APPEND tables "set(relief_needed_by_${component} ${RELIEF_NEEDED_BY_${component}})\n")
        # Shared libraries name what they need by themselves.
        if(NOT BUILD_SHARED_LIBS)
            string(APPEND tables "set(relief_packages_${component} ${RELIEF_PACKAGES_${component}})\n")
            string(APPEND tables "set(relief_third_parties_${component} ${RELIEF_THIRD_PARTIES_${component}})\n")
        endif()
    endforeach()
    configure_package_config_file(
        ${PROJECT_SOURCE_DIR}/cmake/relief-config.cmake.in ${PROJECT_BINARY_DIR}/relief-config.cmake
        INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/relief)
    write_basic_package_version_file(${PROJECT_BINARY_DIR}/relief-config-version.cmake COMPATIBILITY SameMajorVersion)
    install(FILES ${PROJECT_BINARY_DIR}/relief-config.cmake ${PROJECT_BINARY_DIR}/relief-config-version.cmake
                  ${PROJECT_SOURCE_DIR}/cmake/relief-third-parties.cmake
            DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/relief
            COMPONENT development)

    set(pc_folder ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig)
    foreach(directory LIBDIR INCLUDEDIR)
        file(RELATIVE_PATH ${directory} ${pc_folder} ${CMAKE_INSTALL_FULL_${directory}})
    endforeach()
    foreach(component IN LISTS RELIEF_BUILT)
        set(needed ${RELIEF_NEEDED_BY_${component}})
        list(TRANSFORM needed PREPEND relief-)
        set(libraries -L\${libdir} -lrelief_${component})
        if(NOT BUILD_SHARED_LIBS)
            list(APPEND needed ${RELIEF_PKG_CONFIG_${component}})
            list(APPEND libraries ${RELIEF_LIBRARIES_${component}})
        endif()
        list(JOIN needed " " needed)
        list(JOIN libraries " " libraries)
        configure_file(${PROJECT_SOURCE_DIR}/cmake/relief.pc.in ${PROJECT_BINARY_DIR}/relief-${component}.pc @ONLY)
        install(
            FILES ${PROJECT_BINARY_DIR}/relief-${component}.pc
            DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
            COMPONENT development)
    endforeach()
endfunction()
