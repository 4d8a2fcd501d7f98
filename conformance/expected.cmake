# relief-make-conformance-expected, from the sources of the reference in RELIEF_MIKKTSPACE: once as
# they are, and once with a correction of their known defect (README.md): both loops over sorted
# edges in BuildNeighborsFast end before they have sorted the last run.
file(READ ${RELIEF_MIKKTSPACE}/mikktspace.c reference)
set(corrected "${reference}")
foreach(condition "pEdges[iCurStartIndex].i0 != pEdges[i].i0 || pEdges[iCurStartIndex].i1 != pEdges[i].i1"
                  "pEdges[iCurStartIndex].i0 != pEdges[i].i0")
    set(loop "for (i=1; i<iEntries; i++)\n\t{\n\t\tif (${condition})")
    string(FIND "${corrected}" "${loop}" place)
    if(place EQUAL -1)
        message(FATAL_ERROR "mikktspace.c is not the version that expected.cmake knows")
    endif()
    string(REPLACE "${loop}"
                   "for (i=1; i<=iEntries; i++)\n\t{\n\t\tif (i == iEntries || ${condition})"
                   corrected "${corrected}")
endforeach()
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/corrected.c "${corrected}")

add_executable(relief-make-conformance-expected make_expected.cpp ${RELIEF_MIKKTSPACE}/mikktspace.c
                                                ${CMAKE_CURRENT_BINARY_DIR}/corrected.c)
set_source_files_properties(
    ${CMAKE_CURRENT_BINARY_DIR}/corrected.c
    PROPERTIES COMPILE_DEFINITIONS
               "genTangSpace=corrected_genTangSpace;genTangSpaceDefault=corrected_genTangSpaceDefault")
target_include_directories(relief-make-conformance-expected PRIVATE ${RELIEF_MIKKTSPACE})
target_compile_features(relief-make-conformance-expected PRIVATE cxx_std_20)
target_compile_options(relief-make-conformance-expected PRIVATE -O2 -ffp-contract=off)
target_link_libraries(relief-make-conformance-expected PRIVATE relief_conformance_kit fmt::fmt)
