// SPDX-License-Identifier: Apache-2.0
// From radiance to the values that the picture stores. shown() limits the radiance, code_of() codes
// the limited radiance, and coded() does both.

//@part limited
// Radiance that every format can hold: NaN and negative values become 0, infinite ones the limit. A
// NaN from a vertex or a texel ends here.

vec3 limited(vec3 radiance, float limit) {
    return mix(vec3(0.0), min(radiance, vec3(limit)), greaterThan(radiance, vec3(0.0)));
}

//@part linear implements output
// Linear floats.

//@include "output.glsl#limited"

vec3 shown(vec3 radiance) { return limited(radiance, 3e38); }
vec3 code_of(vec3 shown_radiance) { return shown_radiance; }
vec3 coded(vec3 radiance) { return shown(radiance); }

//@part half implements output
// Linear half floats, for the finishing pass.

//@include "output.glsl#limited"

vec3 shown(vec3 radiance) { return limited(radiance, 65504.0); }
vec3 code_of(vec3 shown_radiance) { return shown_radiance; }
vec3 coded(vec3 radiance) { return shown(radiance); }

//@part clamped implements output
// Linear values from 0 to 1.

//@include "output.glsl#limited"

vec3 shown(vec3 radiance) { return limited(radiance, 1.0); }
vec3 code_of(vec3 shown_radiance) { return shown_radiance; }
vec3 coded(vec3 radiance) { return shown(radiance); }

//@part srgb_code
// The sRGB codes of values from 0 to 1. Source: [IEC 61966-2-1].

vec3 code_of(vec3 shown_radiance) {
    vec3 curved = 1.055 * pow(max(shown_radiance, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(curved, 12.92 * shown_radiance, lessThanEqual(shown_radiance, vec3(0.0031308)));
}

//@part srgb implements output
// sRGB codes of radiance that is exposed, tone-mapped and limited to 1.

//@include "output.glsl#limited"
//@include "output.glsl#srgb_code"
//@include <exposure>
//@include <tone>

vec3 shown(vec3 radiance) { return limited(toned(exposed(radiance)), 1.0); }
vec3 coded(vec3 radiance) { return code_of(shown(radiance)); }

//@part shown implements output
// For several samples per pixel: each is exposed, tone-mapped and limited; the finishing pass codes
// their mean.

//@include "output.glsl#limited"
//@include <exposure>
//@include <tone>

vec3 shown(vec3 radiance) { return limited(toned(exposed(radiance)), 1.0); }
vec3 code_of(vec3 shown_radiance) { return shown_radiance; }
vec3 coded(vec3 radiance) { return shown(radiance); }

//@part codes implements output
// The sRGB codes of a mean of such samples.

//@include "output.glsl#limited"
//@include "output.glsl#srgb_code"

vec3 shown(vec3 shown_radiance) { return limited(shown_radiance, 1.0); }
vec3 coded(vec3 shown_radiance) { return code_of(shown(shown_radiance)); }
