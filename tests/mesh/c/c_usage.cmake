# The target c_usage: a program of the C interface in strict C99, for the tests of this folder and of tests/portable. It
# is a target of its own, because the tests' precompiled header is for C++ only.
add_library(c_usage OBJECT ${CMAKE_CURRENT_LIST_DIR}/c_usage.c)
set_target_properties(c_usage PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
target_compile_options(c_usage PRIVATE -Wall -Wextra -pedantic -Werror)
target_include_directories(c_usage PRIVATE ${PROJECT_SOURCE_DIR}/tests)
# Without relief_flags, whose options are those of the C++ compiler.
target_link_libraries(c_usage PRIVATE relief::c)
