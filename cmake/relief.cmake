# What every target of relief shares: language level, warnings, sanitizers, and how tests are made.

# GCC contracts a*b+c into fused instructions by default, Clang does so differently: off, so that
# the same input gives the same bits from both. GCC 12's vectoriser of straight-line code takes two
# neighboring double -> float -> double for nothing to do, and the rounding is gone; that of loops, which
# hot code lives by, does not.
add_library(relief_flags INTERFACE)
target_compile_features(relief_flags INTERFACE cxx_std_20)
target_compile_options(
    relief_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wconversion -Wshadow>
                           $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>
                           $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion> # GCC's -Wconversion has none.
                           $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)
if(RELIEF_WERROR)
    target_compile_options(relief_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Werror>)
endif()
# The libraries have the full optimization of the build type. The tools have -O2, which compiles in a tenth less time:
# if a tool and a library both hold an inline function that was not inlined, the linker takes the tool's. Only tests,
# whose code is in no program that users run, have -Og: they compile in 60 % of the time.
set(is_test $<PATH:IS_PREFIX,${PROJECT_SOURCE_DIR}/tests,$<TARGET_PROPERTY:SOURCE_DIR>>)
set(is_tool $<PATH:IS_PREFIX,${PROJECT_SOURCE_DIR}/tools,$<TARGET_PROPERTY:SOURCE_DIR>>)
target_compile_options(relief_flags INTERFACE $<$<CONFIG:Release>:$<${is_test}:-Og>$<${is_tool}:-O2>>)
if(RELIEF_SANITIZE)
    # Instrumented code is slow to compile, and two thirds of it was the tests' own. Tests are therefore
    # compiled with AddressSanitizer only, without optimization and line numbers, and the tools, which are thin,
    # without optimization. Failed checks of UndefinedBehaviorSanitizer are illegal instructions, whose stack
    # AddressSanitizer prints (handle_sigill below); calls with descriptions of the values take a fifth of the time
    # of compiling more. Only the types of called functions are compared by the sanitizer's library: functions of
    # loaded modules have equal types at other addresses, which a trap would take for an error. Some checks of
    # UndefinedBehaviorSanitizer are off, because AddressSanitizer reports the accesses that they predict (null
    # pointers, sizes of objects, overflow of pointers) and there is hardly a class hierarchy (dynamic types):
    # compiling takes a quarter less time. The libraries keep their optimization: without it, they compile in 40 % of
    # the time, but the tests take more than that saves. GCC 12 warns of uninitialized parts of std::regex in
    # instrumented code; other builds keep the warning.
    set(undefined -fsanitize=undefined -fsanitize-undefined-trap-on-error
                  $<$<CXX_COMPILER_ID:Clang>:-fno-sanitize-trap=function>)
    foreach(check null object-size pointer-overflow vptr)
        list(APPEND undefined -fno-sanitize=${check})
    endforeach()
    # Functions of tests and tools with more than 100 accesses call a check instead of containing it, which saves a
    # seventh of the time of compiling them.
    set(calls $<$<CXX_COMPILER_ID:Clang>:-mllvm -asan-instrumentation-with-call-threshold=100>)
    target_compile_options(relief_flags INTERFACE "$<$<OR:${is_test},${is_tool}>:SHELL:${calls}>")
    target_compile_options(
        relief_flags INTERFACE -fsanitize=address "$<IF:${is_test},-O0;-g0,${undefined}>"
                               "$<${is_tool}:-O0>" -fno-sanitize-recover=all -fno-omit-frame-pointer
                               $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
                               $<$<CXX_COMPILER_ID:Clang>:-D__SANITIZE_ADDRESS__=1>)  # As GCC defines it.
    target_link_options(relief_flags INTERFACE -fsanitize=address,undefined)
    # lld links the large programs of this build in a fifth of the time.
    include(CheckLinkerFlag)
    check_linker_flag(CXX -fuse-ld=lld RELIEF_HAS_LLD)
    if(RELIEF_HAS_LLD)
        target_link_options(relief_flags INTERFACE -fuse-ld=lld)
    endif()
endif()

if(RELIEF_FUZZ)
    target_compile_options(relief_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

if(RELIEF_TSAN)
    if(RELIEF_SANITIZE)
        message(FATAL_ERROR "RELIEF_TSAN and RELIEF_SANITIZE exclude each other")
    endif()
    target_compile_options(relief_flags INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
    target_link_options(relief_flags INTERFACE -fsanitize=thread)
endif()

# Most of the time of compiling a file is spent on headers and their templates. Headers that never change are
# precompiled. Libraries and tools compile each file alone, so that a change compiles little. Test files are compiled
# in batches, which takes half of the time. The sanitized build, whose instrumented templates cost most, compiles all
# files in batches, and so does CI (RELIEF_UNITY=ALL), which starts from nothing. With RELIEF_UNITY=OFF each file is
# compiled alone, as in the debug preset. A batch that does not compile is halved (compile-batch). CONTRIBUTING.md has
# the one rule for names.
option(RELIEF_PCH "Precompile the headers that nearly every file includes" ON)
set(RELIEF_UNITY ON CACHE STRING "Compile in batches: ON: tests, and all files under sanitizers; ALL: all files; OFF")
set(RELIEF_PCH_HEADER ${CMAKE_CURRENT_LIST_DIR}/precompiled.h)

# relief_batch(TARGET SIZE): compiles the files of a target in batches of so many, as RELIEF_UNITY says.
# A batch should not take so long that one processor waits for it at the end.
function(relief_batch target size)
    set(tests ${PROJECT_SOURCE_DIR}/tests)
    cmake_path(IS_PREFIX tests ${CMAKE_CURRENT_SOURCE_DIR} in_tests)
    if(RELIEF_UNITY AND (RELIEF_UNITY STREQUAL ALL OR RELIEF_SANITIZE OR in_tests))
        set(launcher ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/compile-batch ${CMAKE_CXX_COMPILER_LAUNCHER})
        set_target_properties(
            ${target}
            PROPERTIES UNITY_BUILD ON
                       UNITY_BUILD_BATCH_SIZE ${size}
                       CXX_COMPILER_LAUNCHER "${launcher}")
        # GCC warns of types with members from anonymous namespaces unless they stand in the main file.
        target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
    endif()
endfunction()

# relief_precompile(TARGET [LIKE OTHER] [AND HEADERS...]): precompiles the headers, with further HEADERS, or reuses those
# of OTHER, whose compile options must be equal.
function(relief_precompile target)
    if(NOT RELIEF_PCH)
        return()
    endif()
    cmake_parse_arguments(ARG "" "LIKE" "AND" ${ARGN})
    if(ARG_LIKE)
        target_precompile_headers(${target} REUSE_FROM ${ARG_LIKE})
    else()
        target_precompile_headers(${target} PRIVATE ${RELIEF_PCH_HEADER} ${ARG_AND})
    endif()
endfunction()

# relief_vectorise(TARGET SOURCES...): lets the compiler vectorize loops over square roots and selections. It may do so
# only if errno and floating-point traps need not be preserved; these files use neither. No result changes. The files
# use no precompiled header, because that requires the same options.
function(relief_vectorise target)
    set_source_files_properties(
        ${ARGN} TARGET_DIRECTORY ${target}
        PROPERTIES COMPILE_OPTIONS "-fno-math-errno;-fno-trapping-math" SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# relief_count_edges(TARGET): lets libFuzzer see which code an input reaches, also in the sanitized build, which CI
# fuzzes. It is for readers only, because counters that threads share make parallel loops up to 70 % slower. The fuzz
# preset instruments everything, and more.
function(relief_count_edges target)
    if(RELIEF_SANITIZE AND NOT RELIEF_FUZZ AND CMAKE_CXX_COMPILER_ID STREQUAL Clang)
        target_compile_options(${target} PRIVATE -fsanitize-coverage=inline-8bit-counters,pc-table)
    endif()
endfunction()

# relief_position_independent(TARGET): code for libraries, which programs link statically, into a shared library of
# theirs, or as a shared library. Only the namespaces marked RELIEF_API are exported (relief/export.h).
function(relief_position_independent target)
    set_target_properties(
        ${target}
        PROPERTIES POSITION_INDEPENDENT_CODE ON
                   C_VISIBILITY_PRESET hidden
                   CXX_VISIBILITY_PRESET hidden
                   VISIBILITY_INLINES_HIDDEN ON)
    # Functions may be inlined although another library could replace them.
    target_compile_options(${target} PRIVATE -fno-semantic-interposition)
endfunction()

set(RELIEF_FMT fmt::fmt)
if(RELIEF_FMT_HEADERS)
    set(RELIEF_FMT $<BUILD_INTERFACE:fmt::fmt-header-only>)
endif()

# Empty, but for the headers that it lends to libraries.
add_library(relief_precompiled OBJECT ${CMAKE_CURRENT_LIST_DIR}/precompiled.cpp)
relief_position_independent(relief_precompiled)
target_link_libraries(relief_precompiled PRIVATE relief_flags glm::glm ${RELIEF_FMT})
relief_precompile(relief_precompiled)

# What every test runs under. Half of drawing with software OpenGL is compiling shaders, mostly those of the
# test before: Mesa's cache of compiled ones is on, as it is for users, but in the build's own folder, which
# scripts/test empties first. Mesa's leaks are not ours. With OpenImageIO's 261 libraries in the process,
# LeakSanitizer's own tracer can crash ("Tracer caught signal 11") in the hook by which it follows thread-local
# storage: that is off.
set(RELIEF_TEST_ENVIRONMENT
    MESA_SHADER_CACHE_DIR=${PROJECT_BINARY_DIR}/shader-cache
    LSAN_OPTIONS=intercept_tls_get_addr=0:suppressions=${PROJECT_SOURCE_DIR}/tests/support/lsan.supp:print_suppressions=0)
# The time limit of one test case.
set(RELIEF_TEST_CASE_SECONDS 300)
if(RELIEF_SANITIZE OR RELIEF_TSAN)
    set(RELIEF_TEST_CASE_SECONDS 900)
endif()
set(RELIEF_TEST_LABELS unit gl cli window docs)

if(RELIEF_SANITIZE)
    # Stacks of allocations have 8 frames instead of 30, because recording them slows code down that allocates much,
    # such as that of JSON.
    list(APPEND RELIEF_TEST_ENVIRONMENT ASAN_OPTIONS=handle_sigill=1:malloc_context_size=8)
endif()
if(RELIEF_TSAN)
    # Suppressions name functions of either stack: the longest history restores most stacks of earlier accesses.
    list(APPEND RELIEF_TEST_ENVIRONMENT
         TSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/support/tsan.supp:history_size=7)
endif()

# relief_add_tests(NAME sources... [LIBRARIES ...]): a group of test cases, compiled as an object library.
# relief_add_test_program() links groups to programs. The sources state the labels of cases (tests/support/labels.h).
function(relief_add_tests name)
    cmake_parse_arguments(ARG "" "" "LIBRARIES" ${ARGN})
    add_library(${name} OBJECT ${ARG_UNPARSED_ARGUMENTS})
    target_link_libraries(${name} PRIVATE relief_flags relief_test_support ${ARG_LIBRARIES} GTest::gmock
                                          GTest::gtest)
    relief_precompile(${name} LIKE relief_test_precompiled)
    relief_batch(${name} 12)
endfunction()

# relief_add_test_program(NAME LABEL label GROUPS groups... [OBJECTS libraries...] [NOT_SANITIZED]): one GoogleTest
# program. Its cases have the label `label` unless the sources state another one. Object libraries that the groups need
# are named again, because CMake does not pass on their object files. A program that is NOT_SANITIZED is not built for
# sanitizers.
#
# scripts/dev/run-tests runs the programs. ctest has one entry for each program, which calls it.
function(relief_add_test_program name)
    cmake_parse_arguments(ARG "NOT_SANITIZED" "LABEL" "GROUPS;OBJECTS" ${ARGN})
    if(NOT ARG_LABEL IN_LIST RELIEF_TEST_LABELS)
        message(FATAL_ERROR "${name}: the label '${ARG_LABEL}' is not one of ${RELIEF_TEST_LABELS}")
    endif()
    add_executable(${name})
    set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${RELIEF_TEST_DIRECTORY})
    target_link_libraries(${name} PRIVATE ${ARG_GROUPS} ${ARG_OBJECTS} relief_test_main)
    if(ARG_NOT_SANITIZED AND (RELIEF_SANITIZE OR RELIEF_TSAN))
        return()
    endif()
    set_property(GLOBAL APPEND PROPERTY RELIEF_TEST_TARGETS ${name})
    foreach(group ${ARG_GROUPS})
        # What a group runs must be built with the program, too; linking does not pass that on.
        get_target_property(needed ${group} MANUALLY_ADDED_DEPENDENCIES)
        if(needed)
            add_dependencies(${name} ${needed})
        endif()
    endforeach()
    relief_run_test_program(${name} ${ARG_LABEL} $<TARGET_FILE:${name}>)
endfunction()

# relief_run_test_program(NAME LABEL PATH): lists a program for scripts/dev/run-tests, and as an entry of ctest.
function(relief_run_test_program name label path)
    set_property(
        GLOBAL APPEND
        PROPERTY RELIEF_TEST_PROGRAMS "{\"name\": \"${name}\", \"path\": \"${path}\", \"label\": \"${label}\"}")
    add_test(NAME ${name} COMMAND ${PROJECT_SOURCE_DIR}/scripts/dev/run-tests ${PROJECT_BINARY_DIR}
                                  --program ${name} --jobs 1)
    set_tests_properties(${name} PROPERTIES LABELS ${label} SKIP_RETURN_CODE 77 TIMEOUT 7200)
endfunction()

# Writes tests/test-programs.json in the build folder, which scripts/dev/run-tests reads. The target relief_tests is all
# test programs and what they run; the preset `sanitize` builds nothing else.
function(relief_write_test_programs)
    get_property(targets GLOBAL PROPERTY RELIEF_TEST_TARGETS)
    add_custom_target(relief_tests DEPENDS ${targets})
    get_property(programs GLOBAL PROPERTY RELIEF_TEST_PROGRAMS)
    list(JOIN programs ",\n    " programs)
    set(variables "")
    foreach(variable ${RELIEF_TEST_ENVIRONMENT})
        string(REGEX REPLACE "^([^=]+)=(.*)$" "\"\\1\": \"\\2\"" entry "${variable}")
        list(APPEND variables "${entry}")
    endforeach()
    list(JOIN variables ",\n    " variables)
    set(sanitized false)
    if(RELIEF_SANITIZE OR RELIEF_TSAN)
        set(sanitized true)
    endif()
    file(GENERATE OUTPUT ${RELIEF_TEST_DIRECTORY}/test-programs.json
         CONTENT "{\"sources\": \"${PROJECT_SOURCE_DIR}\", \"sanitized\": ${sanitized}, \"case_seconds\": ${RELIEF_TEST_CASE_SECONDS},\n\"environment\": {\n    ${variables}},\n\"programs\": [\n    ${programs}]}\n")
endfunction()
