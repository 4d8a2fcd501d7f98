// SPDX-License-Identifier: Apache-2.0
// The lights' numbers in a uniform block. libshade/src/effects/light_rows.h says what each row is.

layout(std140) uniform Lights {
    vec4 light_rows[light_row_count];
};

vec4 light_row(int index) { return light_rows[index]; }
