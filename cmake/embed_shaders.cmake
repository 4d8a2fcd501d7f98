# Writes shaders/**/*.glsl as a C++ array, sorted by name, so that no file is needed at run time.
# Used at build time as a script (no tool but CMake): OUTPUT, FOLDER and FILES (separated by |) are given.
# relief_embed_shaders(NAME FOLDER) makes an object library of it; a changed or new file builds again.
if(CMAKE_SCRIPT_MODE_FILE)
    string(REPLACE "|" ";" names "${FILES}")
    list(SORT names)
    set(text "// Generated from shaders/ by cmake/embed_shaders.cmake.\n")
    string(APPEND text "#include \"effects/shader_source.h\"\n\nnamespace relief {\n\n")
    string(APPEND text "const std::vector<EmbeddedShader>& embedded_shaders() {\n")
    string(APPEND text "    static const std::vector<EmbeddedShader> all = {\n")
    foreach(name IN LISTS names)
        file(READ "${FOLDER}/${name}" shader)
        string(APPEND text "{\"${name}\", R\"GLSL(${shader})GLSL\"},\n")
    endforeach()
    string(APPEND text "    };\n    return all;\n}\n\n}  // namespace relief\n")
    file(WRITE "${OUTPUT}" "${text}")
    return()
endif()

set(RELIEF_EMBED_SHADERS_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(relief_embed_shaders name folder)
    file(GLOB_RECURSE names RELATIVE ${folder} CONFIGURE_DEPENDS ${folder}/*.glsl)
    set(paths ${names})
    list(TRANSFORM paths PREPEND ${folder}/)
    list(JOIN names "|" joined)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded_shaders.cpp)
    add_custom_command(
        OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DFOLDER=${folder} "-DFILES=${joined}" -P
                ${RELIEF_EMBED_SHADERS_SCRIPT}
        DEPENDS ${paths} ${RELIEF_EMBED_SHADERS_SCRIPT}
        COMMENT "Embedding the shaders"
        VERBATIM)
    add_library(${name} OBJECT ${output})
endfunction()
