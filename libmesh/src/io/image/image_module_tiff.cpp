// SPDX-License-Identifier: Apache-2.0
// Keeps the clock out of TIFF files. Where writing one has taken more than five seconds,
// OpenImageIO 2.4 has libtiff write the directory so far, for readers of files that are never
// finished; the strips that follow lie behind it, and the same image gives another file on a slow
// day. relief's files are written beside and renamed when they are whole, so nobody reads one
// before.
// The dynamic linker looks for the function below in this module before it looks in libtiff, as for
// those of image_module_png.cpp. The directory is written once, when the file is closed.
// Tests: tests/mesh/io/image/image_rows_clock_test.cpp.

extern "C" __attribute__((visibility("default"))) int TIFFCheckpointDirectory(void*) {
    return 1;  // What libtiff says when it went well.
}
