/* SPDX-License-Identifier: Apache-2.0 */
#include "mesh/c/c_usage.h"

#include <string.h>

#include "relief/relief.h"

#define EXPECT(condition) \
    if (!(condition)) return #condition

const char* problem_of_c_usage(void) {
    const float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}};
    const int32_t indices[3] = {0, 1, 2};
    float normals[4][3];
    relief_mesh mesh;
    relief_normal_options options;
    relief_finding finding;
    relief_report* report = relief_report_create();
    EXPECT(report != NULL);
    EXPECT(strcmp(relief_version(), RELIEF_VERSION) == 0);
    EXPECT(relief_mesh_init(&mesh, sizeof mesh) == RELIEF_OK);
    EXPECT(relief_normal_options_init(&options, sizeof options) == RELIEF_OK);
    EXPECT(relief_finding_init(&finding, sizeof finding) == RELIEF_OK);
    EXPECT(options.weight == RELIEF_WEIGHT_ANGLE && options.crease_angle == RELIEF_ABSENT);
    mesh.vertex_count = 4;
    mesh.triangle_count = 1;
    mesh.positions = positions[0];
    mesh.indices = indices;
    mesh.index_type = RELIEF_INDEX_INT32;
    EXPECT(relief_vertex_normals(&mesh, &options, NULL, normals[0], 0, report) == RELIEF_OK);
    EXPECT(normals[0][0] == 0 && normals[0][1] == 0 && normals[0][2] == 1);
    EXPECT(relief_report_count(report) == 1);
    EXPECT(relief_report_finding(report, 0, &finding) == RELIEF_OK);
    EXPECT(strcmp(finding.kind, "isolated vertex") == 0);
    EXPECT(finding.count == 1 && finding.first_count == 1 && finding.first[0] == 3);
    EXPECT(relief_report_finding(report, 1, &finding) == RELIEF_INVALID_INPUT);
    EXPECT(strcmp(relief_last_error(), "there is no finding 1, but only 1") == 0);
    relief_report_clear(report);
    EXPECT(relief_report_count(report) == 0);
    relief_report_destroy(report);
    return NULL;
}
