# An overlay port, which builds the checkout that contains it:
#
#   vcpkg install relief --overlay-ports=packaging/vcpkg
get_filename_component(SOURCE_PATH "${CURRENT_PORT_DIR}/../../.." ABSOLUTE)
if(VCPKG_TARGET_IS_WINDOWS)
    vcpkg_check_linkage(ONLY_STATIC_LIBRARY)
endif()

set(components mesh atlas)
foreach(feature IN ITEMS bake c files topology)
    if(feature IN_LIST FEATURES)
        list(APPEND components ${feature})
    endif()
endforeach()
set(c_bake OFF)
if("bake" IN_LIST FEATURES)
    set(c_bake ON)
endif()
vcpkg_cmake_configure(
    SOURCE_PATH "${SOURCE_PATH}"
    OPTIONS "-DRELIEF_COMPONENTS=${components}" -DRELIEF_C_BAKE=${c_bake} -DRELIEF_TOOLS=OFF -DRELIEF_TESTS=OFF -DRELIEF_PYTHON=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/relief)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share"
     "${CURRENT_PACKAGES_DIR}/share/doc")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
