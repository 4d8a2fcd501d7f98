# Documents of the installed tree: the guides that help texts name, examples, the licenses of third parties, and the
# bill of materials. Without the tools, there are examples only.
install(
    DIRECTORY examples
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/librelief-dev
    COMPONENT development)
if(NOT RELIEF_TOOLS)
    return()
endif()

set(notices ${PROJECT_BINARY_DIR}/notices)
set(notice_files ${notices}/third-party-notices.txt ${notices}/relief.spdx.json)
add_custom_command(
    OUTPUT ${notice_files}
    COMMAND ${PROJECT_SOURCE_DIR}/scripts/dev/make-notices ${PROJECT_VERSION} ${notices}
    DEPENDS ${PROJECT_SOURCE_DIR}/scripts/dev/make-notices
    COMMENT "Writing the notices of third parties"
    VERBATIM)
add_custom_target(relief_notices ALL DEPENDS ${notice_files})

set(documents ${CMAKE_INSTALL_DATADIR}/doc/relief)
install(
    DIRECTORY ${notices}/
    DESTINATION ${documents}
    COMPONENT tools)
install(
    FILES README.md CHANGELOG.md REFERENCES.md SECURITY.md LICENSE
    DESTINATION ${documents}
    COMPONENT tools)
install(
    DIRECTORY docs
    DESTINATION ${documents}
    COMPONENT tools
    PATTERN docs/site EXCLUDE
    PATTERN releasing.md EXCLUDE)
