# What every target of relief shares: language level, warnings, sanitizers, and how tests are made.

# GCC contracts a*b+c into fused instructions by default, Clang does so differently: off, so that
# the same input gives the same bits from both. GCC 12's vectoriser of straight-line code takes two
# neighbouring double -> float -> double for nothing to do, and the rounding is gone; that of loops, which
# hot code lives by, does not.
add_library(relief_flags INTERFACE)
target_compile_features(relief_flags INTERFACE cxx_std_20)
target_compile_options(
    relief_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wconversion -Wshadow>
                           $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>
                           $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)
if(RELIEF_WERROR)
    target_compile_options(relief_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Werror>)
endif()
# The libraries and tools are compiled as users run them; the tests' own code only has to be compiled
# soon. (Where both hold an inline function that was not inlined, the linker takes either.)
set(is_test $<PATH:IS_PREFIX,${PROJECT_SOURCE_DIR}/tests,$<TARGET_PROPERTY:SOURCE_DIR>>)
target_compile_options(relief_flags INTERFACE $<$<AND:$<CONFIG:Release>,${is_test}>:-O1>)
set(is_tool $<PATH:IS_PREFIX,${PROJECT_SOURCE_DIR}/tools,$<TARGET_PROPERTY:SOURCE_DIR>>)
if(RELIEF_SANITIZE)
    # Instrumented code is slow to compile, and two thirds of it was the tests' own: there,
    # AddressSanitizer alone is asked for, and neither optimising nor line numbers. Tools, which are thin,
    # are not optimised either. Instrumented, GCC 12 takes parts of std::regex for uninitialised;
    # other builds keep the warning.
    target_compile_options(
        relief_flags INTERFACE -fsanitize=address "$<IF:${is_test},-O0;-g0,-fsanitize=undefined>"
                               "$<${is_tool}:-O0>" -fno-sanitize-recover=all -fno-omit-frame-pointer
                               -Wno-maybe-uninitialized)
    target_link_options(relief_flags INTERFACE -fsanitize=address,undefined)
endif()

if(RELIEF_TSAN)
    if(RELIEF_SANITIZE)
        message(FATAL_ERROR "RELIEF_TSAN and RELIEF_SANITIZE exclude each other")
    endif()
    target_compile_options(relief_flags INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
    target_link_options(relief_flags INTERFACE -fsanitize=thread)
endif()

# Most of the time of compiling a file goes into headers. Headers that never change are precompiled. Without a
# compiler cache the files of a target are also compiled a dozen at a time; with one, a changed file would
# recompile its whole batch.
if(CMAKE_CXX_COMPILER_LAUNCHER)
    set(together OFF)
else()
    set(together ON)
endif()
option(RELIEF_PCH "Precompile the headers that nearly every file includes" ON)
option(RELIEF_UNITY "Compile the files of a target in batches" ${together})
set(RELIEF_PCH_HEADER ${CMAKE_CURRENT_LIST_DIR}/precompiled.h)

# What stands in a target's anonymous namespaces is therefore named apart. Where the batches end moves as
# files come and go: -DCMAKE_UNITY_BUILD_BATCH_SIZE=0, all of a target in one, finds every clash. Files
# with options of their own (relief_vectorise) are compiled by themselves.
set(CMAKE_UNITY_BUILD ${RELIEF_UNITY})
if(NOT DEFINED CMAKE_UNITY_BUILD_BATCH_SIZE)
    set(CMAKE_UNITY_BUILD_BATCH_SIZE 12)
endif()
if(RELIEF_UNITY)
    # GCC takes the files of a batch for headers, whose types should not hold types of anonymous namespaces.
    target_compile_options(relief_flags
                           INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
endif()

# relief_precompile(TARGET [LIKE OTHER] [AND HEADERS...]): with OTHER's, where both are compiled alike; or
# with more headers than all have.
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

# relief_vectorise(TARGET SOURCES...): loops over square roots and selections become vector instructions
# only where neither errno nor floating-point traps are to be kept, which nobody in these files looks
# at. No result changes. (Precompiled headers are for files with their target's own options.)
function(relief_vectorise target)
    set_source_files_properties(
        ${ARGN} TARGET_DIRECTORY ${target}
        PROPERTIES COMPILE_OPTIONS "-fno-math-errno;-fno-trapping-math" SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# Empty, but for the headers that it lends to targets compiled alike.
add_library(relief_precompiled OBJECT ${CMAKE_CURRENT_LIST_DIR}/precompiled.cpp)
target_link_libraries(relief_precompiled PRIVATE relief_flags glm::glm fmt::fmt)
relief_precompile(relief_precompiled)

# What every test runs under, for set_tests_properties too. Half of drawing with software OpenGL is compiling
# shaders, mostly those of the test before: Mesa's cache of compiled ones is on, as it is for users, but in the
# build's own folder, which scripts/test empties first. Mesa's leaks are not ours. With OpenImageIO's 261
# libraries in the process, LeakSanitizer's own tracer can crash ("Tracer caught signal 11") in the
# hook by which it follows thread-local storage: that is off. Two kinds of environment, because
# gtest_discover_tests takes lists apart.
set(leak_options suppressions=${PROJECT_SOURCE_DIR}/tests/support/lsan.supp:print_suppressions=0)
set(test_seconds 300)
if(RELIEF_SANITIZE OR RELIEF_TSAN)
    set(test_seconds 900)
endif()
set(RELIEF_TEST_PROPERTIES
    TIMEOUT ${test_seconds} ENVIRONMENT MESA_SHADER_CACHE_DIR=${PROJECT_BINARY_DIR}/shader-cache ENVIRONMENT_MODIFICATION
    LSAN_OPTIONS=set:intercept_tls_get_addr=0:${leak_options})

if(RELIEF_TSAN)
    set(RELIEF_TEST_PROPERTIES
        TIMEOUT ${test_seconds} ENVIRONMENT
        TSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/support/tsan.supp)
endif()

# relief_add_tests(NAME sources... [LIBRARIES ...]): one GoogleTest program; each test
# is a ctest entry called NAME/Suite.Test. A test that calls GTEST_SKIP shows as "Skipped" there.
function(relief_add_tests name)
    cmake_parse_arguments(ARG "" "" "LIBRARIES" ${ARGN})
    add_executable(${name} ${ARG_UNPARSED_ARGUMENTS})
    set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${RELIEF_TEST_DIRECTORY})
    target_link_libraries(${name} PRIVATE relief_flags relief_test_support ${ARG_LIBRARIES}
                                          GTest::gmock GTest::gtest_main)
    relief_precompile(${name} LIKE relief_test_precompiled)
    gtest_discover_tests(
        ${name}
        TEST_PREFIX ${name}/
        NO_PRETTY_VALUES
        DISCOVERY_MODE PRE_TEST
        PROPERTIES ${RELIEF_TEST_PROPERTIES})
endfunction()
