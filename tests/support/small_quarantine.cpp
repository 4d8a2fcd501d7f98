// SPDX-License-Identifier: Apache-2.0
// AddressSanitizer calls this function for the default options of the program.

extern "C" const char* __asan_default_options();

extern "C" const char* __asan_default_options() {
    return "quarantine_size_mb=1:thread_local_quarantine_size_kb=64";
}
