/* SPDX-License-Identifier: Apache-2.0 */
/* Computes normals, tangents, a normal map and a bake from C99, in the program's own memory. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "relief/relief.h"

enum { side = 33, cells = side - 1, map_size = 64 };

typedef struct vertex {
    float position[3], normal[3], tangent[4], texcoord[2];
} vertex;

/* Ends the program if a function failed. */
static void check(relief_status status) {
    if (status == RELIEF_OK) return;
    fprintf(stderr, "relief: %s\n", relief_last_error());
    exit(EXIT_FAILURE);
}

/* A wave over the unit square: a grid of 33 by 33 vertices. */
static void make_wave(float height, vertex* vertices, uint16_t* indices) {
    const int corners[6] = {0, 1, side + 1, 0, side + 1, side};
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            vertex* v = &vertices[y * side + x];
            memset(v, 0, sizeof *v);
            v->texcoord[0] = (float)x / cells;
            v->texcoord[1] = 1.0f - (float)y / cells; /* v points down. */
            v->position[0] = v->texcoord[0];
            v->position[1] = (float)y / cells;
            v->position[2] = height * sinf(6.2831853f * v->texcoord[0]);
        }
    }
    for (int y = 0; y < cells; ++y) {
        for (int x = 0; x < cells; ++x) {
            for (int corner = 0; corner < 6; ++corner)
                *indices++ = (uint16_t)(y * side + x + corners[corner]);
        }
    }
}

/* The buffers as relief sees them; nothing is copied. */
static relief_mesh mesh_of(vertex* vertices, const uint16_t* indices) {
    relief_mesh mesh;
    check(relief_mesh_init(&mesh, sizeof mesh));
    mesh.vertex_count = side * side;
    mesh.triangle_count = 2 * cells * cells;
    mesh.positions = vertices->position;
    mesh.normals = vertices->normal;
    mesh.texcoords = vertices->texcoord;
    mesh.position_stride = mesh.normal_stride = mesh.texcoord_stride = sizeof(vertex);
    mesh.indices = indices;
    mesh.index_type = RELIEF_INDEX_UINT16;
    return mesh;
}

static void print_findings(relief_report* report) {
    relief_finding finding;
    check(relief_finding_init(&finding, sizeof finding));
    for (size_t i = 0; i < relief_report_count(report); ++i) {
        check(relief_report_finding(report, i, &finding));
        printf("finding: %s\n", finding.text);
    }
    relief_report_clear(report);
}

static void print_frames(relief_report* report) {
    static vertex vertices[side * side];
    static uint16_t indices[6 * cells * cells];
    make_wave(0.1f, vertices, indices);
    const relief_mesh mesh = mesh_of(vertices, indices);
    check(relief_vertex_normals(&mesh, NULL, NULL, vertices->normal, sizeof(vertex), report));
    check(relief_vertex_tangents(&mesh, NULL, vertices->tangent, sizeof(vertex), report));
    print_findings(report);
    const vertex* middle = &vertices[cells / 2 * side + cells / 2]; /* The steepest slope. */
    printf("normal %.4f %.4f %.4f\n", middle->normal[0], middle->normal[1], middle->normal[2]);
    printf("tangent %.4f %.4f %.4f %.0f\n", middle->tangent[0], middle->tangent[1],
           middle->tangent[2], middle->tangent[3]);
}

static void print_normal_map(relief_report* report) {
    static uint8_t heights[map_size * map_size];
    static uint8_t texels[map_size * map_size][4];
    for (int i = 0; i < map_size * map_size; ++i)
        heights[i] = (uint8_t)(i % map_size); /* It rises by 1/255 per texel. */
    const relief_image from = {heights, 0, map_size, map_size, 1, RELIEF_SAMPLE_UINT8};
    const relief_output_image map = {texels, 0, map_size, map_size, 4, RELIEF_SAMPLE_UINT8};
    relief_bump_options options;
    check(relief_bump_options_init(&options, sizeof options));
    options.strength = 127.5; /* A slope of 1/2. */
    options.kernel = RELIEF_KERNEL_SOBEL3;
    options.wrap_x = options.wrap_y = RELIEF_WRAP_CLAMP;
    check(relief_normal_map_from_height(&from, &options, NULL, &map, report));
    print_findings(report);
    const uint8_t* texel = texels[map_size / 2 * map_size + map_size / 2];
    printf("texel %d %d %d %d\n", texel[0], texel[1], texel[2], texel[3]);
}

static void print_bake(relief_report* report) {
    static vertex wave[side * side], plane[side * side];
    static uint16_t indices[6 * cells * cells];
    static float texels[map_size * map_size][3];
    make_wave(0.01f, wave, indices);
    make_wave(0.0f, plane, indices);
    relief_mesh high = mesh_of(wave, indices), low = mesh_of(plane, indices);
    high.normals = low.normals = NULL; /* The baker averages them. */
    const relief_mesh* const high_meshes[1] = {&high};
    relief_bake_maps maps;
    check(relief_bake_maps_init(&maps, sizeof maps));
    const relief_output_image normals = {texels, 0, map_size, map_size, 3, RELIEF_SAMPLE_FLOAT};
    maps.normals = normals;
    relief_bake_result result;
    check(relief_bake_result_init(&result, sizeof result));
    check(relief_bake(high_meshes, 1, &low, NULL, NULL, &maps, &result, report));
    print_findings(report);
    float steepest = 0.0f;
    for (int i = 0; i < map_size * map_size; ++i)
        steepest =
            fmaxf(steepest, fabsf((2.0f * texels[i][0] - 1.0f) / (2.0f * texels[i][2] - 1.0f)));
    printf("baked %d of %d texels\n", (int)result.texels_baked, map_size * map_size);
    printf("steepest slope %.4f, of the wave %.4f\n", steepest, 0.01 * 6.2831853);
}

int main(void) {
    relief_report* report = relief_report_create(); /* Counts degenerate elements; optional. */
    if (report == NULL) return EXIT_FAILURE;
    print_frames(report);
    print_normal_map(report);
    print_bake(report);
    relief_report_destroy(report);
    return EXIT_SUCCESS;
}
