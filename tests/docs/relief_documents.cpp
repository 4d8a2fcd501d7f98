// SPDX-License-Identifier: Apache-2.0
// `relief-documents [--check] [PAGE...]` writes or checks the generated documents of this source
// tree, and `relief-documents --accuracy REPORT_FOLDER...` writes docs/accuracy.md.
#include "docs/generated_documents.h"

int main(int argc, char** argv) {
    return relief::test::run_documents({argv + 1, argv + argc}, RELIEF_SOURCE_DIR "/docs");
}
