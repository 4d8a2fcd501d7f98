# Runs before each Debian package is made: adds the copyright and the changelogs, and compresses manual pages.
if(NOT CPACK_GENERATOR STREQUAL DEB)
    return()
endif()
set(suite unstable)
if(EXISTS /etc/os-release)
    file(STRINGS /etc/os-release suite REGEX "^VERSION_CODENAME=")
    string(REGEX REPLACE "^VERSION_CODENAME=" "" suite "${suite}")
endif()
string(TIMESTAMP year %Y UTC)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
    string(TOUPPER ${component} upper)
    set(root ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr/share)
    set(documents ${root}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
    file(MAKE_DIRECTORY ${documents})
    file(WRITE ${documents}/copyright
         "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: relief

Files: *
Copyright: ${year} The relief authors
License: Apache-2.0
 On Debian systems, the text of the Apache License, version 2.0, is in
 /usr/share/common-licenses/Apache-2.0.
")
    configure_file(${CPACK_RELIEF_SOURCE_DIR}/CHANGELOG.md ${documents}/changelog COPYONLY)
    file(WRITE ${documents}/changelog.Debian
         "relief (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) ${suite}; urgency=medium

  * Package version ${CPACK_PACKAGE_VERSION}.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
    file(GLOB pages ${root}/man/man1/*.1)
    execute_process(COMMAND gzip -9nf ${documents}/changelog ${documents}/changelog.Debian ${pages}
                    COMMAND_ERROR_IS_FATAL ANY)
    # CMake creates folders with the permissions of the umask.
    file(GLOB_RECURSE entries LIST_DIRECTORIES true ${CPACK_TEMPORARY_DIRECTORY}/${component}/*)
    foreach(entry IN LISTS entries)
        if(IS_DIRECTORY ${entry})
            file(CHMOD ${entry} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                            WORLD_EXECUTE)
        endif()
    endforeach()
endforeach()
