// GLSL of the facets. A facet is five vertices, its corners and its centre, drawn as four triangles; everything a
// hex has (centre, colour) is read from textures by number, so that moving a slider uploads next to nothing.

/** Width of the per-hex textures. */
export const TEXTURE_WIDTH = 2048;

const PLACE = /* glsl */ `
  uniform highp sampler2D centres;
  uniform vec3 middle;
  uniform float shrink;
  uniform float explode;
  vec3 placed(int hex, vec3 at) {
    vec3 c = texelFetch(centres, ivec2(hex % ${TEXTURE_WIDTH}, hex / ${TEXTURE_WIDTH}), 0).xyz;
    return c + shrink * (at - c) + explode * (c - middle);
  }
  vec2 corner(int i) {
    return i == 4 ? vec2(0.5) : vec2(i == 1 || i == 2 ? 1.0 : 0.0, i >= 2 ? 1.0 : 0.0);
  }
`;

const SHADE = /* glsl */ `
  vec3 lit(vec3 colour, vec3 normal) {
    vec3 n = normalize(normal);
    if (!gl_FrontFacing) n = -n;
    float key = max(dot(n, normalize(vec3(-0.35, 0.65, 0.67))), 0.0);
    float fill = max(dot(n, normalize(vec3(0.8, -0.1, 0.5))), 0.0);
    return colour * (0.65 + 0.36 * key + 0.07 * fill);
  }
  // 1 on the sides of the quad, 0 inside; fades where the quads become as small as the lines.
  float sides(vec2 uv, float width) {
    vec2 step = fwidth(uv);
    vec2 away = min(uv, 1.0 - uv) / max(step, 1e-6);
    float line = 1.0 - smoothstep(width - 0.5, width + 0.5, min(away.x, away.y));
    return line * (1.0 - smoothstep(0.12, 0.4, max(step.x, step.y)));
  }
`;

export const HEX_VERTEX = /* glsl */ `
  precision highp float;
  precision highp int;
  in vec4 bent;
  in vec4 tint;
  uniform bool byGroup;
  uniform highp sampler2D paint;
  uniform vec3 surfaceColour;
  uniform vec3 insideColour;
  flat out vec3 colour;
  flat out int facetNumber;
  out vec3 viewNormal;
  out vec2 uv2;
  ${PLACE}
  void main() {
    int facet = gl_VertexID / 5;
    int hex = facet / 6;
    facetNumber = facet;
    uv2 = corner(gl_VertexID % 5);
    viewNormal = normalMatrix * bent.xyz;
    vec4 p = texelFetch(paint, ivec2(hex % ${TEXTURE_WIDTH}, hex / ${TEXTURE_WIDTH}), 0);
    if (byGroup && tint.a > 0.5) colour = tint.rgb;
    else colour = p.a > 0.5 ? p.rgb : bent.w > 0.5 ? surfaceColour : insideColour;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(placed(hex, position), 1.0);
  }
`;

export const HEX_FRAGMENT = /* glsl */ `
  precision highp float;
  precision highp int;
  flat in vec3 colour;
  flat in int facetNumber;
  in vec3 viewNormal;
  in vec2 uv2;
  uniform vec3 lineColour;
  uniform float lineWidth;
  uniform int hovered;
  uniform int picked;
  uniform vec3 accent;
  out vec4 result;
  ${SHADE}
  void main() {
    int hex = facetNumber / 6;
    vec3 base = colour;
    if (hex == picked) base = mix(base, accent, 0.55);
    else if (hex == hovered) base = mix(base, accent, 0.28);
    vec3 c = lit(base, viewNormal);
    result = vec4(mix(c, lineColour, 0.85 * sides(uv2, lineWidth)), 1.0);
  }
`;

/** Writes the number of the facet, plus one, as a colour. */
export const PICK_FRAGMENT = /* glsl */ `
  precision highp float;
  precision highp int;
  flat in int facetNumber;
  out vec4 result;
  void main() {
    int n = facetNumber + 1;
    result = vec4(float(n & 255), float((n >> 8) & 255), float((n >> 16) & 255), float((n >> 24) & 255)) / 255.0;
  }
`;

export const GLASS_FRAGMENT = /* glsl */ `
  precision highp float;
  precision highp int;
  flat in vec3 colour;
  flat in int facetNumber;
  in vec3 viewNormal;
  in vec2 uv2;
  out vec4 result;
  uniform vec3 surfaceColour;
  uniform float opacity;
  ${SHADE}
  void main() {
    float rim = 1.0 - abs(normalize(viewNormal).z);
    result = vec4(lit(surfaceColour, viewNormal), opacity * (0.55 + 1.3 * rim * rim));
  }
`;

export const SHEET_VERTEX = /* glsl */ `
  precision highp float;
  precision highp int;
  in vec4 bent;
  in vec3 tint;
  flat out vec3 colour;
  out vec3 viewNormal;
  out vec2 uv2;
  vec2 corner(int i) {
    return i == 4 ? vec2(0.5) : vec2(i == 1 || i == 2 ? 1.0 : 0.0, i >= 2 ? 1.0 : 0.0);
  }
  void main() {
    uv2 = corner(gl_VertexID % 5);
    viewNormal = normalMatrix * bent.xyz;
    colour = tint;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`;

export const SHEET_FRAGMENT = /* glsl */ `
  precision highp float;
  flat in vec3 colour;
  in vec3 viewNormal;
  in vec2 uv2;
  uniform vec3 lineColour;
  uniform float lineWidth;
  out vec4 result;
  ${SHADE}
  void main() {
    result = vec4(mix(lit(colour, viewNormal), lineColour, 0.6 * sides(uv2, lineWidth)), 1.0);
  }
`;
