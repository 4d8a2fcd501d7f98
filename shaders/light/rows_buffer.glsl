// SPDX-License-Identifier: Apache-2.0
// The lights' numbers in a buffer texture, for more lights than a uniform block holds.
// libshade/src/effects/light_rows.h says what each row is.

uniform samplerBuffer light_buffer;

vec4 light_row(int index) { return texelFetch(light_buffer, index); }
