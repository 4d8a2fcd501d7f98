# Writes text files as a C++ array, sorted by name, so that none is needed at run time.
# Used at build time as a script (no tool but CMake): see the call below for what is given.
#
# relief_embed_files(NAME FOLDER ... FILES *.glsl HEADER "effects/shader_parts.h" ARRAY embedded_shaders
#                    ELEMENT EmbeddedShader [NAMESPACE relief])
# makes an object library of those in FOLDER and below that FILES fits; a changed or new file builds
# again. HEADER declares `const std::vector<ELEMENT>& ARRAY()`, an element being {name, text}.
if(CMAKE_SCRIPT_MODE_FILE)
    string(REPLACE "|" ";" names "${FILES}")
    list(SORT names)
    set(text "// Generated from ${FOLDER_NAME}/ by cmake/embed_files.cmake.\n")
    string(APPEND text "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n\n")
    string(APPEND text "const std::vector<${ELEMENT}>& ${ARRAY}() {\n")
    string(APPEND text "    static const std::vector<${ELEMENT}> all = {\n")
    foreach(name IN LISTS names)
        file(READ "${FOLDER}/${name}" contents)
        string(APPEND text "{\"${name}\", R\"EMBEDDED(${contents})EMBEDDED\"},\n")
    endforeach()
    string(APPEND text "    };\n    return all;\n}\n\n}  // namespace ${NAMESPACE}\n")
    file(WRITE "${OUTPUT}" "${text}")
    return()
endif()

set(RELIEF_EMBED_FILES_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(relief_embed_files name)
    cmake_parse_arguments(ARG "" "FOLDER;HEADER;ARRAY;ELEMENT;NAMESPACE" "FILES" ${ARGN})
    if(NOT ARG_NAMESPACE)
        set(ARG_NAMESPACE relief)
    endif()
    list(TRANSFORM ARG_FILES PREPEND ${ARG_FOLDER}/ OUTPUT_VARIABLE patterns)
    file(GLOB_RECURSE names RELATIVE ${ARG_FOLDER} CONFIGURE_DEPENDS ${patterns})
    set(paths ${names})
    list(TRANSFORM paths PREPEND ${ARG_FOLDER}/)
    list(JOIN names "|" joined)
    cmake_path(GET ARG_FOLDER FILENAME folder_name)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/${ARG_ARRAY}.cpp)
    add_custom_command(
        OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DFOLDER=${ARG_FOLDER} -DFOLDER_NAME=${folder_name}
                "-DFILES=${joined}" -DHEADER=${ARG_HEADER} -DNAMESPACE=${ARG_NAMESPACE}
                -DELEMENT=${ARG_ELEMENT} -DARRAY=${ARG_ARRAY} -P ${RELIEF_EMBED_FILES_SCRIPT}
        DEPENDS ${paths} ${RELIEF_EMBED_FILES_SCRIPT}
        COMMENT "Embedding ${folder_name}/"
        VERBATIM)
    add_library(${name} OBJECT ${output})
endfunction()
