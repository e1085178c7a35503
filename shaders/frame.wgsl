// What every pass knows: the eye, the light, the theme. Joined in front of each shader.

struct Frame {
    clip_from_world: mat4x4f,
    // xyz: the eye; w: 1 in perspective, 0 in the orthographic projection.
    eye: vec4f,
    // xyz: unit vector into the picture; w: model units per device pixel, at depth 1 in perspective.
    forward: vec4f,
    // xyz: unit vector toward the key light; w: strength.
    key: vec4f,
    // xyz: unit vector toward the fill light; w: strength.
    fill: vec4f,
    // Linear colours of the light from above and from below; w of sky: what the rim catches of it.
    sky: vec4f,
    ground: vec4f,
    // Linear colours of the two sides of a surface.
    front: vec4f,
    back: vec4f,
    // Display colours, as all below.
    wire: vec4f,
    top: vec4f,
    bottom: vec4f,
    grid: vec4f,
    axis_u: vec4f,
    axis_v: vec4f,
    // The work plane: xyz; w of origin: line distance, of u: share of the fine lines, of v: reach.
    plane_origin: vec4f,
    plane_u: vec4f,
    plane_v: vec4f,
    // xy: centre of the visible part in the plane.
    plane_centre: vec4f,
    // Device pixels and their inverse.
    viewport: vec4f,
    // x: device pixels per CSS pixel; y: near plane; z: 1 with wireframe; w: unused.
    options: vec4f,
    // x: what is asked of surfaces; isophotes, y: bands in half a turn; mean curvature, y: lower end, z: one over the range.
    look: vec4f,
    // Contours: xyz: unit vector across the slices; w: one over their distance.
    slices: vec4f,
}

@group(0) @binding(0) var<uniform> frame: Frame;

fn is_perspective() -> bool {
    return frame.eye.w > 0.5;
}

fn toward_eye(at: vec3f) -> vec3f {
    if is_perspective() {
        return normalize(frame.eye.xyz - at);
    }
    return -frame.forward.xyz;
}

fn depth_of(at: vec3f) -> f32 {
    return dot(frame.forward.xyz, at - frame.eye.xyz);
}

// Model units that a device pixel measures.
fn unit_per_pixel(at: vec3f) -> f32 {
    if is_perspective() {
        return frame.forward.w * max(depth_of(at), frame.options.y);
    }
    return frame.forward.w;
}

// A place moved toward the eye by some device pixels, so that what lies on a surface is not cut by it.
fn lifted(at: vec3f, pixels: f32) -> vec3f {
    return at + toward_eye(at) * (pixels * unit_per_pixel(at));
}

// Device pixels (y down) and depth.
fn pixel_of(at: vec3f) -> vec3f {
    let clip = frame.clip_from_world * vec4f(at, 1.0);
    let ndc = clip.xyz / clip.w;
    return vec3f((ndc.xy * vec2f(0.5, -0.5) + 0.5) * frame.viewport.xy, ndc.z);
}

fn clip_of(pixel: vec2f, depth: f32) -> vec4f {
    return vec4f((pixel * frame.viewport.zw - 0.5) * vec2f(2.0, -2.0), depth, 1.0);
}

// Linear light to display values: the canvas has no sRGB format, so the step is made here.
fn encoded(linear: vec3f) -> vec3f {
    let c = clamp(linear, vec3f(0.0), vec3f(1.0));
    return select(1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3f(0.0031308));
}

// A mark on the picture: a curve or a point.
struct Style {
    fill: vec4f,
    outline: vec4f,
    // CSS pixels, as the next.
    half_width: f32,
    outline_width: f32,
    // Opacity where a surface hides it.
    hidden: f32,
    // Bit 0: places are device pixels already. Bits 8 and 9: a letter (1 X, 2 Y, 3 Z).
    flags: u32,
}

// Colour of a mark at a distance from its middle, edges softened over one pixel; premultiplied.
fn inked(style: Style, distance: f32) -> vec4f {
    let ratio = frame.options.x;
    let inner = clamp(style.half_width * ratio + 0.5 - distance, 0.0, 1.0);
    let outer = clamp((style.half_width + style.outline_width) * ratio + 0.5 - distance, 0.0, 1.0);
    let fill = vec4f(style.fill.rgb * style.fill.a, style.fill.a);
    let outline = vec4f(style.outline.rgb * style.outline.a, style.outline.a);
    return fill * inner + outline * (outer - inner);
}
